"""Which model is enough: speed against accuracy for this mesh on this machine."""

import math
from typing import TYPE_CHECKING

from qtpy.QtCore import Qt, QTimer
from qtpy.QtGui import QColor, QIcon, QPixmap
from qtpy.QtWidgets import (
    QCheckBox,
    QHBoxLayout,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QSizePolicy,
    QSlider,
    QVBoxLayout,
    QWidget,
)

from app.gui.choice import FIRST, LEAST, MOST, Choosing
from app.gui.scatter import Dot, Scatter
from app.session import Method
from app.suffices import Sufficient, colored

if TYPE_CHECKING:
    from app.choosing import Needs
    from app.gui.window import Window
    from lutcore.judging import Rung

TITLE, AREA, ORDER, SHOWN = "Choose", "bottom", 2, False
_TIME = "time for this mesh and its lights, ms"
_ERROR = "error found, line to the predicted, R_d"
_STEPS = 100
_REST = 300  # ms without a change before the ladder is asked again


def build(window: "Window") -> QWidget:
    """Make the dock's content.

    Parameters
    ----------
    window : Window
        What it is about.

    Returns
    -------
    QWidget
        The content.
    """
    return ChoosePanel(window)


class ChoosePanel(QWidget):
    """The ladder as a chart, one recommendation, and where each model is enough.

    Parameters
    ----------
    window : Window
        What it is about.
    """

    def __init__(self, window: "Window") -> None:
        super().__init__(window)
        self._window = window
        self.choosing = Choosing(window.controller)
        self.chart = Scatter(self, _TIME, _ERROR)
        self.chart.setAccessibleName("Speed against accuracy; click a point to use that model")
        self.chart.picked.connect(self._on_picked)
        self.sentence = QLabel("", self)
        self.sentence.setWordWrap(True)
        self.sentence.setAccessibleName("Recommendation")
        self.use = QPushButton("Use it", self)
        self.use.setAccessibleName("Use the recommended model")
        self.use.clicked.connect(self._use)
        self.slider = QSlider(Qt.Orientation.Horizontal, self)
        self.slider.setRange(0, _STEPS)
        self.slider.setAccessibleName("Tolerance")
        self.slider.setToolTip("How wrong 99 % of the vertices may be, as a share of R_d")
        self.slider.setValue(_step(FIRST))
        self.slider.valueChanged.connect(self._on_slid)
        self.value = QLabel("", self)
        self.map = QCheckBox("Show where each model is predicted to be enough", self)
        self.map.toggled.connect(self.choosing.show_map)
        self.legend = QListWidget(self)
        # What it would like to be high would push the chart's axis out of sight.
        self.legend.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Ignored)
        self.legend.setMinimumHeight(4 * self.fontMetrics().height())
        self.legend.setAccessibleName("Models that are enough, with their share of the vertices")
        self._layout()
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(_REST)
        self._rest.timeout.connect(self.choosing.ask)
        self.choosing.found.connect(self._on_found)
        self.choosing.mapped.connect(self._on_mapped)
        window.controller.shown.connect(self._on_shown)
        self._tell_tolerance()
        self._asked: object = None
        self._rest.start()

    def _layout(self) -> None:
        side = QVBoxLayout()
        row = QHBoxLayout()
        row.addWidget(QLabel("Tolerance", self))
        row.addWidget(self.slider, 1)
        row.addWidget(self.value)
        for part in (self.sentence, self.use):
            side.addWidget(part)
        side.addLayout(row)
        side.addWidget(self.map)
        side.addWidget(self.legend, 1)
        whole = QHBoxLayout(self)
        whole.addWidget(self.chart, 3)
        whole.addLayout(side, 2)

    def _on_slid(self) -> None:
        self.choosing.tolerance = _tolerance(self.slider.value())
        self._tell_tolerance()
        self._rest.start()

    def _tell_tolerance(self) -> None:
        self.value.setText(f"{100.0 * _tolerance(self.slider.value()):.2g} %")

    def _on_shown(self, outcome: object) -> None:
        if self.choosing.map is not None:
            self._paint(self.choosing.map)
        session = self._window.controller.session
        # The camera, exposure and the like change nothing of the choice.
        about = (
            session.mesh,
            session.material,
            session.profile,
            session.lights,
            session.mm_per_unit,
            session.scale,
            session.estimator,
            session.casts,
        )
        if about != self._asked and self.isVisible():
            self._asked = about
            self._rest.start()
        elif self.choosing.needs is not None:
            self._on_found(self.choosing.needs)

    def showEvent(self, event: object) -> None:  # noqa: N802
        """Ask when first seen, and after what changed unseen."""
        self._on_shown(None)

    def _on_found(self, needs: "Needs") -> None:
        choice, current = needs.choice, self._window.controller.session.model
        from app.chart.front import pareto_front
        from app.chart.points import Point, Spread

        def point(rung: "Rung") -> Point:
            time, error = rung.milliseconds, rung.best_score
            return Point(rung.candidate.label, "", Spread.of([time]), Spread.of([error]))

        known = [point(rung) for rung in choice.rungs if not math.isnan(rung.score)]
        front = {one.name for one in pareto_front(known)}
        dots = [
            Dot(
                label=rung.candidate.label,
                x=rung.milliseconds,
                y=rung.score if math.isnan(rung.score) else max(rung.best_score, 1e-6),
                middle=rung.median if math.isnan(rung.median) else max(_middle(rung), 1e-6),
                good=rung.adequate,
                chosen=rung is choice.chosen,
                current=Method(rung.candidate.name, dict(rung.candidate.parameters)) == current,
                front=rung.candidate.label in front,
                words=_words(rung),
            )
            for rung in choice.rungs
        ]
        self.chart.show_dots(dots, choice.tolerance.value)
        sentence = choice.sentence
        sentence = f"{sentence[:1].upper()}{sentence[1:]}."
        if needs.shadows is not None and needs.lacks_shadows:
            share = 100.0 * needs.shadows.change
            sentence += f" Cast shadows, which are off, would change {share:.1f} % of the light."
        self.sentence.setText(sentence)

    def _on_picked(self, index: int) -> None:
        if self.choosing.needs is not None:
            self.choosing.take(self.choosing.needs.choice.rungs[index])

    def _use(self) -> None:
        if self.choosing.needs is not None:
            self.choosing.take(self.choosing.needs.choice.chosen)

    def _on_mapped(self, found: Sufficient | None) -> None:
        self.legend.clear()
        if found is None:
            outcome = self._window.controller.outcome
            camera = self._window.canvas.camera
            if outcome is not None and camera is not None:
                self._window.canvas.show_composition(outcome.composition, camera)
            return
        for index in (*range(len(found.labels)), -1):
            name = found.labels[index] if index >= 0 else "no local model"
            item = QListWidgetItem(f"{name}: {100.0 * found.share(index):.1f} %")
            picture = QPixmap(16, 16)
            picture.fill(QColor(*found.color(index)))
            item.setIcon(QIcon(picture))
            self.legend.addItem(item)
        self._paint(found)

    def _paint(self, found: Sufficient) -> None:
        outcome, camera = self._window.controller.outcome, self._window.canvas.camera
        if outcome is None or camera is None:
            return
        if len(found.which) == len(outcome.subject.mesh.vertices):
            made = colored(outcome.composition, found.rgb)
            self._window.canvas.show_composition(made, camera)


def _middle(rung: "Rung") -> float:
    """Return where the line from what is known best ends: the prediction, or its median."""
    return rung.median if rung.checked is None else rung.score


def _words(rung: "Rung") -> str:
    spent = f"{rung.candidate.label}: {rung.milliseconds:.3g} ms"
    if math.isnan(rung.score):
        return f"{spent}, its error is not predicted"
    share = f"enough at {100.0 * rung.best_share:.1f} % of the vertices"
    how = "predicted" if rung.checked is None else f"found; {100.0 * rung.score:.2g} % predicted"
    score = f"99 % of the vertices within {100.0 * rung.best_score:.2g} % of R_d ({how})"
    return f"{spent}, {score}, {share}"


def _tolerance(step: int) -> float:
    return float(LEAST * (MOST / LEAST) ** (step / _STEPS))


def _step(tolerance: float) -> int:
    return round(_STEPS * math.log(tolerance / LEAST) / math.log(MOST / LEAST))
