"""What a person can do by menu, key or palette: each declared once. Knows no Qt."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

MENUS = ("File", "Edit", "View", "Curvature", "Shading", "Compare", "Tools", "Window", "Help")


@dataclass(frozen=True, eq=False)
class Action:
    """Something to do.

    Parameters
    ----------
    name : str
        For settings and tests: ``"file.open"``; never changed.
    menu : str
        One of `MENUS`; a submenu follows after a slash: ``"View/Camera"``.
    text : str
        What the menu says; it ends with an ellipsis if a dialog follows.
    doc : str
        One sentence for the status bar and the cheat sheet.
    run : callable
        Does it.
    shortcut : str
        Qt's name of the key, empty for none.
    checked : callable, optional
        Tells whether it is on, for what is on or off.
    enabled : callable, optional
        Tells whether it can be done now.
    """

    name: str
    menu: str
    text: str
    doc: str
    run: Callable[[], None]
    shortcut: str = ""
    checked: Callable[[], bool] | None = None
    enabled: Callable[[], bool] | None = None


class Actions:
    """All actions of a window, by name, in the order of the menus."""

    def __init__(self) -> None:
        self._actions: dict[str, Action] = {}

    def add(self, *actions: Action) -> None:
        """Add actions.

        Parameters
        ----------
        *actions : Action
            Their names are new.

        Raises
        ------
        ValueError
            If a name or a shortcut is there already, or there is no such menu.
        """
        for one in actions:
            taken = [
                other.name for other in self if one.shortcut and other.shortcut == one.shortcut
            ]
            if one.name in self._actions or taken or one.menu.split("/")[0] not in MENUS:
                raise ValueError(
                    f"action {one.name!r}: its name, its shortcut or its menu: {taken}"
                )
            self._actions[one.name] = one

    def __iter__(self) -> Iterator[Action]:
        """Go over the actions in the order of the menus."""
        return iter(
            sorted(self._actions.values(), key=lambda one: MENUS.index(one.menu.split("/")[0]))
        )

    def __getitem__(self, name: str) -> Action:
        """Return the action of a name."""
        return self._actions[name]
