"""Repairs asked for in the window: tried first, then part of the session. Knows no Qt."""

from msgspec.structs import replace
from psygnal import Signal

from app.gui.controller import Controller, Outcome
from app.session import Repair
from app.steps.subject import Subject
from lutcore.health import MeshHealth


class Repairing:
    """Looks at the mesh that is shown, and repairs it.

    Parameters
    ----------
    controller : Controller
        Of the window.
    """

    found = Signal(object)
    """Emitted with the `MeshHealth` of the mesh that is shown."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._looked: Subject | None = None

    def look(self, outcome: Outcome) -> None:
        """Look for what is odd about a mesh, if it is another one.

        Parameters
        ----------
        outcome : Outcome
            What is shown.
        """
        subject = outcome.subject
        if subject is self._looked:
            return
        self._looked = subject

        def job(_: object) -> MeshHealth:
            return subject.loaded.health

        self._controller.run("health", job, self.found.emit)

    def do(self, kind: str, value: float | None) -> None:
        """Do one more repair; one that fails changes nothing.

        Parameters
        ----------
        kind : str
            A key of `app.repairs.KINDS`.
        value : float or None
            What it is set by.
        """
        try:
            repair = Repair(kind, value)  # type: ignore[arg-type]  # it checks the kind itself
        except ValueError as error:
            self._controller.failed.emit(str(error))
            return
        self._set((*self._controller.session.repairs, repair), repair.words)

    def take_back(self, index: int) -> None:
        """Leave a repair out.

        Parameters
        ----------
        index : int
            Its place among the session's repairs.
        """
        repairs = self._controller.session.repairs
        self._set((*repairs[:index], *repairs[index + 1 :]), f"without {repairs[index].words}")

    def take_all_back(self) -> None:
        """Return to the mesh as it is in the file."""
        self._set((), "without repairs")

    def _set(self, repairs: tuple[Repair, ...], label: str) -> None:
        controller = self._controller
        session = replace(controller.session, repairs=repairs)

        def done(subject: Subject) -> None:
            # Meanwhile another mesh may have been opened.
            if controller.session.mesh == session.mesh:
                controller.change(label, repairs=repairs)
                if repairs:
                    controller.noted.emit(subject.warnings[-1])

        controller.run("repair", lambda _: controller.pipeline.subject(session), done, True)
