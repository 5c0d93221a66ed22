"""Edit: undo and redo."""

from typing import TYPE_CHECKING

from app.gui.actions import Action

if TYPE_CHECKING:
    from app.gui.window import Window

ORDER = 1


def actions(window: "Window") -> list[Action]:
    """Return the actions of this menu.

    Parameters
    ----------
    window : Window
        What they act on.

    Returns
    -------
    list of Action
        In the order of the menu.
    """
    document = window.controller.document
    return [
        Action(
            "edit.undo",
            "Edit",
            "Undo",
            "Take the last change back",
            document.undo,
            "Ctrl+Z",
            enabled=lambda: document.undo_label is not None,
        ),
        Action(
            "edit.redo",
            "Edit",
            "Redo",
            "Do again what was taken back",
            document.redo,
            "Ctrl+Shift+Z",
            enabled=lambda: document.redo_label is not None,
        ),
    ]
