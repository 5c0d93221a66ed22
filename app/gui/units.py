"""Which unit a file is in, where it does not say and its size is odd. Knows no Qt."""

from psygnal import Signal

from app.gui.controller import Controller
from app.gui.settings import Settings
from app.steps.subject import Subject
from lutcore.health import MeshHealth

UNITS = {"\N{MICRO SIGN}m": 0.001, "mm": 1.0, "cm": 10.0, "inch": 25.4, "m": 1000.0}
"""Millimetres in each unit that is offered."""
_REMEMBERED = "units"
_MOST_REMEMBERED = 500


class Units:
    """Asks once for each file, and remembers the answer.

    Parameters
    ----------
    controller : Controller
        Of the window.
    settings : Settings
        Where answers are kept, by the file's content.
    """

    asked = Signal(object)
    """Emitted with the diagonal in mesh units when a person has to say, None when no more."""

    def __init__(self, controller: Controller, settings: Settings) -> None:
        self._controller = controller
        self._settings = settings
        self._subject: Subject | None = None
        controller.loaded.connect(self._on_loaded)
        controller.document.changed.connect(lambda *_: self._withdraw())

    def answer(self, mm_per_unit: float | None) -> None:
        """Take an answer, and do not ask for this file again.

        Parameters
        ----------
        mm_per_unit : float or None
            None leaves it open: a unit counts as 1 mm.
        """
        subject = self._subject
        if subject is None:
            return
        known = self._settings.get(_REMEMBERED, {}) | {subject.loaded.digest: mm_per_unit}
        self._settings.set(_REMEMBERED, dict(list(known.items())[-_MOST_REMEMBERED:]))
        self._subject = None
        self.asked.emit(None)
        if mm_per_unit is not None:
            self._controller.complete("unit", mm_per_unit=mm_per_unit)  # it is remembered

    def _on_loaded(self, subject: Subject) -> None:
        self._subject = None
        self.asked.emit(None)
        if self._controller.session.mm_per_unit is not None or subject.mm_per_unit is not None:
            return
        known = self._settings.get(_REMEMBERED, {})
        if subject.loaded.digest in known:
            remembered = known[subject.loaded.digest]
            if isinstance(remembered, float | int) and remembered > 0:
                self._controller.complete("unit", mm_per_unit=float(remembered))
            return

        def found(health: MeshHealth) -> None:
            session = self._controller.session
            if session.mm_per_unit is None and not health.plausible(1.0):
                self._subject = subject
                self.asked.emit(health.diagonal)

        self._controller.run("unit", lambda _: subject.loaded.health, found)

    def _withdraw(self) -> None:
        if self._subject is not None and self._controller.session.mm_per_unit is not None:
            self._subject = None
            self.asked.emit(None)
