"""How the docks lie, from one run to the next."""

from typing import TYPE_CHECKING

from qtpy.QtCore import QByteArray

if TYPE_CHECKING:
    from app.gui.window import Window

_SETTING = "layout"


class Layout:
    """Remembers a window's size and docks.

    Parameters
    ----------
    window : Window
        With all its docks, as they lie at first.
    """

    def __init__(self, window: "Window") -> None:
        self._window = window
        self._first = window.saveState()
        self._read()

    def _read(self) -> None:
        kept = self._window.settings.get(_SETTING, {})
        # What Qt does not take for a layout it leaves alone, and says so.
        size, state = (_decoded(kept.get(name)) for name in ("size", "docks"))
        if not size.isEmpty():
            self._window.restoreGeometry(size)
        if not state.isEmpty() and not self._window.restoreState(state):
            self.reset()

    def keep(self) -> None:
        """Remember how the docks lie now."""
        window = self._window
        kept = {"size": window.saveGeometry(), "docks": window.saveState()}
        window.settings.set(
            _SETTING, {name: bytes(one.toBase64().data()).decode() for name, one in kept.items()}
        )

    def reset(self) -> None:
        """Put the docks where they lay when the program was run first."""
        self._window.restoreState(self._first)


def _decoded(text: object) -> QByteArray:
    if not isinstance(text, str) or not text.isascii():
        return QByteArray()
    return QByteArray.fromBase64(text.encode())
