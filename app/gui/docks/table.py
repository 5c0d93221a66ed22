"""The table of psi: what the light of this mesh looks up, and where."""

from typing import TYPE_CHECKING

import numpy as np
from qtpy.QtWidgets import QComboBox, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from app.camera import axes
from app.gui import orbit
from app.gui.canvas import Place
from app.gui.psi_plot import PsiPlot
from app.suffices import colored
from app.tabulated import table_arguments, within
from lutcore.arrays import FloatArray
from lutcore.progress import Progress

if TYPE_CHECKING:
    from app.gui.controller import Outcome
    from app.gui.window import Window
    from lutcore.lut import PsiTable

TITLE, AREA, ORDER, SHOWN = "Table", "bottom", 3, False
_CHANNELS = ("red", "green", "blue")
_PAINT = (255, 230, 40)


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
    return TablePanel(window)


class TablePanel(QWidget):
    """The plot, and which light and channel it is about.

    Parameters
    ----------
    window : Window
        What it is about.
    """

    def __init__(self, window: "Window") -> None:
        super().__init__(window)
        self._window = window
        self._arguments: FloatArray | None = None
        self.plot = PsiPlot(self)
        self.light = QComboBox(self)
        self.light.setAccessibleName("Light")
        self.channel = QComboBox(self)
        self.channel.addItems(_CHANNELS)
        self.channel.setAccessibleName("Channel")
        self.said = QLabel("Drag over the table to see where on the mesh it is looked up", self)
        self.said.setWordWrap(True)
        self.light.activated.connect(lambda _: self._ask())
        self.channel.currentIndexChanged.connect(self._on_channel)
        row = QHBoxLayout()
        for part in (QLabel("Light", self), self.light, QLabel("Channel", self), self.channel):
            row.addWidget(part)
        row.addWidget(self.said, 1)
        column = QVBoxLayout(self)
        column.addLayout(row)
        column.addWidget(self.plot, 1)
        self.plot.brushed.connect(self._on_brushed)
        window.canvas.hovered.connect(self._on_hover)
        window.controller.shown.connect(self._on_shown)

    def showEvent(self, event: object) -> None:  # noqa: N802
        """Ask for what changed unseen."""
        if self._window.controller.outcome is not None:
            self._on_shown(self._window.controller.outcome)

    def _on_shown(self, outcome: "Outcome") -> None:
        if not self.isVisible():
            return
        count = len(outcome.session.lights)
        if count != self.light.count():
            self.light.clear()
            self.light.addItems([str(index + 1) for index in range(count)])
        self._ask()

    def _ask(self) -> None:
        outcome, light = self._window.controller.outcome, self.light.currentIndex()
        if outcome is None or light < 0:
            return
        session, pipeline = outcome.session, self._window.controller.pipeline
        frame = axes(outcome.composition.camera)

        def job(progress: Progress) -> "tuple[PsiTable, FloatArray]":
            inputs = pipeline.inputs(session, frame)
            return inputs.table, table_arguments(inputs, light)

        self._window.controller.run("table", job, self._show)

    def _show(self, answer: "tuple[PsiTable, FloatArray]") -> None:
        table, self._arguments = answer
        reach = float(table.reach.max())
        knots = [np.linspace(0.0, float(end), table.samples) for end in table.reach]
        curves = list(zip(knots, table.psi, strict=True))
        self.plot.show_table(curves, reach)
        self.plot.show_vertices(self._arguments)
        if self.plot.brush is not None:
            self._on_brushed(self.plot.brush)

    def _on_channel(self, index: int) -> None:
        self.plot.channel = index
        self.plot.update()
        self._on_brushed(self.plot.brush)

    def _on_brushed(self, brush: tuple[float, float] | None) -> None:
        outcome, camera = self._window.controller.outcome, self._window.canvas.camera
        if outcome is None or camera is None or self._arguments is None:
            return
        made = outcome.composition
        if brush is None:
            self.said.setText("")
            self._window.canvas.show_composition(made, camera)
            return
        chosen = within(self._arguments, self.plot.channel, *brush)
        self.said.setText(f"{100.0 * chosen.mean():.1f} % of the vertices")
        rgb = np.full((len(chosen), 3), 90, np.uint8)
        rgb[chosen] = _PAINT
        self._window.canvas.show_composition(colored(made, rgb), camera)

    def _on_hover(self, place: Place | None) -> None:
        outcome, camera = self._window.controller.outcome, self._window.canvas.camera
        arguments = self._arguments
        if not self.isVisible() or outcome is None or camera is None or arguments is None:
            return
        if place is None or place.panel is None:
            self.plot.show_marks(())
            return
        from app.probing import nearest_vertex

        session, pipeline = outcome.session, self._window.controller.pipeline
        start, direction = orbit.ray(camera, place.right, place.up)

        def mark(vertex: int | None) -> None:
            if vertex is None or vertex >= arguments.shape[1]:
                self.plot.show_marks(())
            else:
                self.plot.show_marks(tuple(float(one) for one in arguments[:, vertex]))

        self._window.controller.run(
            "under", lambda _: nearest_vertex(session, pipeline, start, direction), mark
        )
