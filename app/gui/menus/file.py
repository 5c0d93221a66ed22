"""File: open, save, and what lies beside."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from qtpy.QtWidgets import QFileDialog

from app.gui import outputs
from app.gui.actions import Action
from app.gui.controller import SESSION_SUFFIX
from app.gui.neighbours import neighbour
from app.gui.session_file import save, save_as
from app.gui.unsaved import may_leave

if TYPE_CHECKING:
    from app.gui.window import Window

ORDER = 0
_FILTER = "Meshes and sessions (*);;Sessions (*.json)"


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
    return [
        Action(
            "file.open",
            "File",
            "Open\N{HORIZONTAL ELLIPSIS}",
            "Open a mesh or a session",
            partial(_open, window),
            "Ctrl+O",
        ),
        Action(
            "file.save",
            "File",
            "Save session\N{HORIZONTAL ELLIPSIS}",
            "Save the session; the command line draws the same picture of it",
            partial(_save, window),
            "Ctrl+S",
        ),
        Action(
            "file.save_as",
            "File",
            "Save session as\N{HORIZONTAL ELLIPSIS}",
            "Save the session as another file",
            partial(_save_as, window),
            "Ctrl+Shift+S",
        ),
        *outputs.actions(window),
        Action(
            "file.next",
            "File",
            "Next in folder",
            "Open the next mesh file of the same folder",
            partial(_beside, window, 1),
            "Right",
        ),
        Action(
            "file.previous",
            "File",
            "Previous in folder",
            "Open the previous mesh file of the same folder",
            partial(_beside, window, -1),
            "Left",
        ),
        Action("file.quit", "File", "Quit", "Close the window", partial(_quit, window), "Ctrl+Q"),
    ]


def _open(window: "Window") -> None:
    mesh = window.controller.session.mesh
    start = "" if mesh.startswith("sample:") else str(Path(mesh).parent)
    name, _ = QFileDialog.getOpenFileName(window, "Open", start, _FILTER)
    # A mesh is a step that can be undone; a session takes the place of all that was done.
    session = name.lower().endswith(SESSION_SUFFIX)
    if name and (not session or may_leave(window)):
        window.controller.open(name)


def _save(window: "Window") -> None:
    save(window)


def _save_as(window: "Window") -> None:
    save_as(window)


def _beside(window: "Window", step: int) -> None:
    found = neighbour(window.controller.session.mesh, step)
    if found is None:
        window.controller.noted.emit("there is no other mesh in this folder")
    else:
        window.controller.open(found)


def _quit(window: "Window") -> None:
    if may_leave(window):
        window.close()
