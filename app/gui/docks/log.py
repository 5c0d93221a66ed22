"""What went on: messages and remarks since the window opened, the newest at the end."""

from typing import TYPE_CHECKING

from qtpy.QtWidgets import QPlainTextEdit, QWidget

from app.gui.journal import MOST_LINES

if TYPE_CHECKING:
    from app.gui.window import Window

TITLE, AREA, ORDER, SHOWN = "Log", "bottom", 9, False


def build(window: "Window") -> QWidget:
    """Make the dock's content.

    Parameters
    ----------
    window : Window
        What it is about.

    Returns
    -------
    QWidget
        The content.
    """
    text = QPlainTextEdit(window)
    text.setReadOnly(True)
    text.setMaximumBlockCount(MOST_LINES)
    text.setAccessibleName("Log")
    text.setPlainText("\n".join(window.journal.lines))
    window.journal.added.connect(text.appendPlainText, check_nargs=False)
    return text
