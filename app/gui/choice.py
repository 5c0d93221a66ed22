"""Which model this mesh and this machine need. Knows no Qt."""

from typing import TYPE_CHECKING

from psygnal import Signal

from app.camera import axes
from app.gui.controller import Controller
from app.session import Method
from app.suffices import Sufficient, sufficient
from lutcore.progress import Progress, part

if TYPE_CHECKING:
    from app.choosing import Needs
    from lutcore.judging import Rung

_LONGEST = 1200.0  # seconds to measure the models, compiling included
_MEMORY = 16 << 30
LEAST, MOST, FIRST = 0.001, 0.3, 0.02
"""Ends and beginning of the tolerance, relative to R_d."""


class Choosing:
    """Asks what the session needs, and where each model is enough.

    Parameters
    ----------
    controller : Controller
        Of the window.
    """

    found = Signal(object)
    """Emitted with the `Needs` of the session."""
    mapped = Signal(object)
    """Emitted with the `Sufficient` of the mesh, None when it shall not be shown."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self.tolerance = FIRST
        self.needs: Needs | None = None
        self.map: Sufficient | None = None
        self.mapping = False

    def ask(self) -> None:
        """Ask for the ladder and, where it is shown, for the map.

        The first time on a machine the models are measured, in a process of its own: that takes
        a minute, while the window goes on.
        """
        if self._controller.outcome is None:
            return

        def measured(progress: Progress) -> None:
            from app.costs import known
            from lutcore.isolated import run_isolated

            if not known():
                run_isolated(
                    "app.costs:in_child",
                    {},
                    label="measuring the models on this machine, once",
                    seconds=_LONGEST,
                    memory=_MEMORY,
                    progress=progress,
                )

        aside = self._controller.aside
        aside.submit("measure", measured, lambda _: self._ask(), self._controller.on_failed)

    def _ask(self) -> None:
        outcome = self._controller.outcome
        if outcome is None:
            return
        from app.session import replaced

        session, pipeline = replaced(outcome.session, view="shade"), self._controller.pipeline
        frame, value, mapping = axes(outcome.composition.camera), self.tolerance, self.mapping

        def job(progress: Progress) -> "tuple[Needs, Sufficient | None]":
            from app.choosing import needs
            from lutcore.tolerance import Tolerance

            found = needs(session, pipeline, frame, Tolerance(value, "relative"))
            if not mapping:
                return found, None
            inputs = pipeline.shadowed(session, frame)
            rungs = found.choice.rungs
            return found, sufficient(inputs, rungs, value, part(progress, 0.5, 1.0))

        self._controller.run("choose", job, self._show, supersede=True)

    def set_tolerance(self, value: float) -> None:
        """Ask again under another tolerance.

        Parameters
        ----------
        value : float
            `LEAST` to `MOST`.
        """
        self.tolerance = min(max(value, LEAST), MOST)
        self.ask()

    def show_map(self, on: bool) -> None:
        """Show on the mesh where each model is enough, or stop it.

        Parameters
        ----------
        on : bool
            Whether to.
        """
        self.mapping = on
        if on:
            self.ask()
        else:
            self.map = None
            self.mapped.emit(None)

    def take(self, rung: "Rung") -> None:
        """Shade with a model of the ladder.

        Parameters
        ----------
        rung : Rung
            Of `needs`.
        """
        method = Method(rung.candidate.name, dict(rung.candidate.parameters))
        session = self._controller.session
        # It was judged in the shadows that auto casts, and keeps them.
        shadows = "auto" if session.casts == "auto" else session.shadows
        self._controller.change(
            f"model {method.label}", model=method, view="shade", shadows=shadows
        )

    def _show(self, answer: "tuple[Needs, Sufficient | None]") -> None:
        self.needs, self.map = answer
        self.found.emit(self.needs)
        if self.mapping:
            self.mapped.emit(self.map)
