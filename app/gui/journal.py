"""What was said since the window opened, for whoever looks later. Knows no Qt."""

import time
from collections import deque

from psygnal import Signal

from app.gui.controller import Controller
from app.steps.subject import Subject

MOST_LINES = 2000


class Journal:
    """Keeps messages and remarks with their time, the newest at the end.

    Parameters
    ----------
    controller : Controller
        Of the window; all that it says from now on is kept.
    """

    added = Signal(str)
    """Emitted with each new line."""

    def __init__(self, controller: Controller) -> None:
        self._lines: deque[str] = deque(maxlen=MOST_LINES)
        controller.failed.connect(self.add)
        controller.noted.connect(self.add)
        controller.loaded.connect(self._on_loaded)

    @property
    def lines(self) -> tuple[str, ...]:
        """What was said, at most the newest `MOST_LINES`."""
        return tuple(self._lines)

    def _on_loaded(self, subject: Subject) -> None:
        mesh, name = subject.mesh, subject.loaded.path.name
        self.add(f"{name}: {len(mesh.vertices)} vertices, {len(mesh.faces)} faces")
        for warning in subject.warnings:
            self.add(f"{name}: {warning}")

    def add(self, text: str) -> None:
        """Keep a line.

        Parameters
        ----------
        text : str
            What was said.
        """
        line = f"{time.strftime('%H:%M:%S')}  {text}"
        self._lines.append(line)
        self.added.emit(line)
