"""Keeps what is unsaved in a window for the case of a crash, and offers what one left."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from app.gui.recovery import Left, Recovery

if TYPE_CHECKING:
    from app.gui.window import Window

_FOLDER = "unfinished"


class Rescue:
    """Follows a window's document.

    Parameters
    ----------
    window : Window
        Has its settings, its controller and its banner.
    """

    def __init__(self, window: "Window") -> None:
        self._window = window
        self._document = window.controller.document
        self.recovery = Recovery(window.settings.path.parent / _FOLDER, self._note_soon)
        self._document.history_changed.connect(self._keep)

    def offer(self) -> None:
        """Offer the newest session that a crash left behind, if there is one."""
        for one in self.recovery.find()[:1]:
            self._window.banner.offer(
                f"{one.kept.session.mesh}: the last window of it was not closed, and had "
                "changes that no file holds",
                "Restore",
                partial(self._restore, one),
            )

    def close(self) -> None:
        """End well: nothing is left for the next start."""
        self.recovery.close()

    def _restore(self, one: Left) -> None:
        self.recovery.adopt(one)
        self._document.path = Path(one.kept.path) if one.kept.path else None
        self._document.put("restore", one.kept.session)

    def _keep(self) -> None:
        if self._document.dirty:
            self.recovery.keep(self._document.session, self._document.path)
        else:
            self.recovery.forget()

    def _note_soon(self, text: str) -> None:
        controller = self._window.controller
        controller.worker.post(lambda: controller.noted.emit(text))
