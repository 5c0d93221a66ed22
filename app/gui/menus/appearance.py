"""View and Window: light or dark, and where the docks lie."""

from functools import partial
from typing import TYPE_CHECKING

from app.gui import theme
from app.gui.actions import Action

if TYPE_CHECKING:
    from app.gui.window import Window

ORDER = 9


def actions(window: "Window") -> list[Action]:
    """Return the actions of these menus.

    Parameters
    ----------
    window : Window
        What they act on.

    Returns
    -------
    list of Action
        In the order of the menus.
    """
    settings = window.settings
    themes = [
        Action(
            f"view.theme_{name}",
            "View/Theme",
            text,
            "Follow the system's light or dark colours" if name == "system" else f"{text} colours",
            partial(theme.choose, settings, name),
            checked=partial(_is_chosen, window, name),
        )
        for name, text in theme.THEMES.items()
    ]
    return [
        *themes,
        Action(
            "window.reset",
            "Window",
            "Reset layout",
            "Put the panels where they lay at first",
            partial(_reset, window),
        ),
    ]


def _reset(window: "Window") -> None:
    window.layout_.reset()


def _is_chosen(window: "Window", name: theme.Theme) -> bool:
    return theme.chosen(window.settings) == name
