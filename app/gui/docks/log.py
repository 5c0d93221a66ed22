"""What went on: messages and remarks, the newest at the end."""

import time
from typing import TYPE_CHECKING

from qtpy.QtWidgets import QPlainTextEdit, QWidget

from app.pipeline import Subject

if TYPE_CHECKING:
    from app.gui.window import Window

TITLE, AREA, ORDER, SHOWN = "Log", "bottom", 9, False
_MOST_LINES = 2000


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
    text.setMaximumBlockCount(_MOST_LINES)
    text.setAccessibleName("Log")

    def add(line: str) -> None:
        text.appendPlainText(f"{time.strftime('%H:%M:%S')}  {line}")

    def on_loaded(subject: Subject) -> None:
        mesh = subject.mesh
        add(f"{subject.loaded.path.name}: {len(mesh.vertices)} vertices, {len(mesh.faces)} faces")
        for warning in subject.warnings:
            add(f"{subject.loaded.path.name}: {warning}")

    window.controller.failed.connect(add)
    window.controller.noted.connect(add)
    window.controller.loaded.connect(on_loaded)
    return text
