"""What becomes of unsaved changes when they would be lost."""

from enum import Enum
from typing import TYPE_CHECKING

from qtpy.QtWidgets import QMessageBox

from app.gui.session_file import save

if TYPE_CHECKING:
    from app.gui.window import Window


class Answer(Enum):
    """What a person wants of unsaved changes."""

    SAVE = "save"
    DISCARD = "discard"
    CANCEL = "cancel"


def may_leave(window: "Window") -> bool:
    """Tell whether the session may go, after asking where it has unsaved changes.

    Parameters
    ----------
    window : Window
        Its `ask_unsaved` is asked, only if there is something to lose.

    Returns
    -------
    bool
        False if a person wants to stay, or what was to be saved could not be.
    """
    if not window.controller.document.dirty:
        return True
    answer = window.ask_unsaved(window)
    return save(window) if answer is Answer.SAVE else answer is Answer.DISCARD


def ask(window: "Window") -> Answer:
    """Ask in a dialog.

    Parameters
    ----------
    window : Window
        What it belongs to.

    Returns
    -------
    Answer
        Cancel, too, if the dialog was closed.
    """
    document = window.controller.document
    name = document.path.name if document.path else "this session"
    box = QMessageBox(window)
    box.setIcon(QMessageBox.Icon.Warning)
    box.setWindowTitle("Unsaved changes")
    box.setText(f"Save the changes to {name}?")
    box.setInformativeText("Settings, lights and camera are saved; the mesh itself never changes.")
    buttons = QMessageBox.StandardButton
    box.setStandardButtons(buttons.Save | buttons.Discard | buttons.Cancel)
    box.setDefaultButton(buttons.Save)
    chosen = box.exec()
    answers = {buttons.Save: Answer.SAVE, buttons.Discard: Answer.DISCARD}
    return answers.get(buttons(chosen), Answer.CANCEL)
