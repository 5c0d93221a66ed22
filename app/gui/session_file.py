"""Saves the session as a file, under its name or another."""

from pathlib import Path
from typing import TYPE_CHECKING

from qtpy.QtWidgets import QFileDialog

from app.gui.controller import SESSION_SUFFIX
from app.samples import PREFIX

if TYPE_CHECKING:
    from app.gui.window import Window


def save(window: "Window") -> bool:
    """Save the session where it came from; ask where, if it came from no file.

    Parameters
    ----------
    window : Window
        Its session.

    Returns
    -------
    bool
        Whether it was saved.
    """
    path = window.controller.document.path
    return save_as(window) if path is None else window.controller.save(path)


def save_as(window: "Window") -> bool:
    """Ask for a file and save the session there.

    Parameters
    ----------
    window : Window
        Its session.

    Returns
    -------
    bool
        Whether it was saved.
    """
    proposed = str(window.controller.document.path or beside(window, SESSION_SUFFIX))
    name, _ = QFileDialog.getSaveFileName(
        window, "Save session", proposed, f"Sessions (*{SESSION_SUFFIX})"
    )
    return bool(name) and window.controller.save(Path(name))


def beside(window: "Window", ending: str) -> Path:
    """Return a name to propose for a result: that of the session or the mesh, in its folder.

    Parameters
    ----------
    window : Window
        Says the session.
    ending : str
        Of the name.

    Returns
    -------
    Path
        Relative for a sample that belongs to no folder.
    """
    document = window.controller.document
    mesh = document.session.mesh
    if document.path is not None:
        return document.path.with_name(document.path.stem + ending)
    if mesh.startswith(PREFIX):
        return Path(mesh.removeprefix(PREFIX) + ending)
    return Path(mesh).with_name(Path(mesh).stem + ending)
