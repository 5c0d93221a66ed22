"""The length that curvature is averaged over: found by itself, or chosen in millimetres."""

from typing import TYPE_CHECKING

import numpy as np
from qtpy.QtWidgets import QCheckBox, QHBoxLayout, QWidget

from app.gui.slider import Slider
from app.session import Session

if TYPE_CHECKING:
    from app.gui.controller import Controller, Outcome
    from app.pipeline import Pipeline

# From less than any scan's spacing to its size, as shares of its diagonal.
_LEAST, _MOST = 2e-4, 0.25


class ScaleForm(QWidget):
    """A box for automatic beside a slider in millimetres.

    Parameters
    ----------
    controller : Controller
        Of the window.
    """

    def __init__(self, controller: "Controller") -> None:
        super().__init__()
        self._controller = controller
        self._mm_per_unit = 1.0
        self._median = 0.0  # mesh units
        self._measured: tuple[object, ...] = ()
        self.auto = QCheckBox("auto", self)
        self.auto.setAccessibleName("Automatic scale")
        self.auto.setToolTip("Let the estimator choose the length that it averages over")
        self.auto.clicked.connect(self._on_auto)
        self._row = QHBoxLayout(self)
        self._row.setContentsMargins(0, 0, 0, 0)
        self._row.addWidget(self.auto)
        self.slider = self._made(1e-3, 1.0)
        self._diagonal = 0.0

    def _made(self, low: float, high: float) -> Slider:
        doc = "Length that curvature is averaged over, mm: longer is smoother and less exact"
        slider = Slider("Scale", doc, low, high, suffix=" mm", logarithmic=True)
        slider.changed.connect(self._on_changed)
        slider.pressed.connect(self._controller.begin_drag)
        slider.released.connect(self._controller.end_drag)
        self._row.addWidget(slider, 1)
        return slider

    def follow(self, session: Session) -> None:
        """Show what the session says, without telling anybody.

        Parameters
        ----------
        session : Session
            Its scale is used.
        """
        self.auto.setChecked(session.scale is None)
        if session.scale is not None:
            self.slider.follow(session.scale * self._mm_per_unit)
        elif self._median > 0.0:
            self.slider.follow(self._median * self._mm_per_unit)

    def measure(self, outcome: "Outcome") -> None:
        """Take the size of the mesh, and ask for the scale that its curvature has.

        Parameters
        ----------
        outcome : Outcome
            What is shown.
        """
        self._mm_per_unit = outcome.mm_per_unit
        diagonal = outcome.subject.mesh.diagonal * outcome.mm_per_unit
        if diagonal != self._diagonal:
            self._diagonal = diagonal
            self._row.removeWidget(self.slider)
            self.slider.deleteLater()
            self.slider = self._made(_LEAST * diagonal, _MOST * diagonal)
            self._median = 0.0
        self.follow(self._controller.session)
        if outcome.measured != self._measured:
            self._measured = outcome.measured
            pipeline = self._controller.pipeline
            self._controller.run(
                "scale", lambda _: typical_scale(outcome.session, pipeline), self._on_found
            )

    def _on_found(self, median: float) -> None:
        self._median = median
        self.follow(self._controller.session)

    def _on_auto(self, on: bool) -> None:
        given = None if on else self.slider.value / self._mm_per_unit
        self._controller.change("scale", scale=given)

    def _on_changed(self, millimetres: float) -> None:
        self._controller.change("scale", scale=millimetres / self._mm_per_unit)


def typical_scale(session: Session, pipeline: "Pipeline") -> float:
    """Return the length that a session's curvature is averaged over.

    Parameters
    ----------
    session : Session
        Its mesh, estimator and scale are used.
    pipeline : Pipeline
        Where arrays come from.

    Returns
    -------
    float
        Mesh units; the median where it differs from place to place.
    """
    some = np.atleast_1d(np.asarray(pipeline.curvatures(session).scale))[::97]
    return float(np.median(some))
