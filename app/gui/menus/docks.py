"""Window: which docks are shown."""

from functools import partial
from typing import TYPE_CHECKING

from app.gui.actions import Action

if TYPE_CHECKING:
    from app.gui.docks import Dock
    from app.gui.window import Window

ORDER = 9


def actions(window: "Window") -> list[Action]:
    """Return the actions of this menu.

    Parameters
    ----------
    window : Window
        What they act on.

    Returns
    -------
    list of Action
        One for each dock.
    """
    return [
        Action(
            f"window.{name}",
            "Window",
            dock.windowTitle(),
            f"Show or hide the panel {dock.windowTitle()}",
            partial(_toggle, dock),
            checked=partial(_is_open, dock),
        )
        for name, dock in window.docks.items()
    ]


def _toggle(dock: "Dock") -> None:
    dock.setVisible(dock.isHidden())
    if not dock.isHidden():
        dock.raise_()


def _is_open(dock: "Dock") -> bool:
    return not dock.isHidden()
