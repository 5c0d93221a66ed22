"""The command palette: type a few letters of anything that can be done."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from qtpy.QtCore import Qt
from qtpy.QtGui import QKeyEvent
from qtpy.QtWidgets import QDialog, QLineEdit, QListWidget, QListWidgetItem, QVBoxLayout

from app.gui.fitting import fit
from app.gui.matching import ranked
from app.session import Method

if TYPE_CHECKING:
    from app.gui.window import Window

_MOST = 12
Command = tuple[str, Callable[[], object]]


class Palette(QDialog):
    """A line to type in, and what it may mean.

    Parameters
    ----------
    window : Window
        What is acted on.
    """

    def __init__(self, window: "Window") -> None:
        super().__init__(window)
        self.setWindowTitle("Command palette")
        self._commands = commands(window)
        self._found: list[Command] = []
        self.line = QLineEdit(self)
        self.line.setPlaceholderText("Type what you want to do")
        self.line.setAccessibleName("Command")
        self.line.textChanged.connect(self._on_text)
        self.list = QListWidget(self)
        self.list.setAccessibleName("What it may mean")
        self.list.itemActivated.connect(lambda _: self._run())
        column = QVBoxLayout(self)
        column.addWidget(self.line)
        column.addWidget(self.list)
        fit(self, window.width() / 2, window.height() / 2)
        self._on_text("")

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802
        """Choose with the arrows, run with Return."""
        step = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1}.get(Qt.Key(event.key()))
        if step is not None:
            last = self.list.count() - 1
            self.list.setCurrentRow(min(max(self.list.currentRow() + step, 0), last))
        elif event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._run()
        else:
            super().keyPressEvent(event)

    def _on_text(self, text: str) -> None:
        names = [name for name, _ in self._commands]
        self._found = [self._commands[index] for index in ranked(text, names)[:_MOST]]
        self.list.clear()
        for name, _ in self._found:
            self.list.addItem(QListWidgetItem(name))
        self.list.setCurrentRow(0)

    def _run(self) -> None:
        row = self.list.currentRow()
        self.accept()
        if 0 <= row < len(self._found):
            self._found[row][1]()


def commands(window: "Window") -> Sequence[Command]:
    """Return all that the palette offers.

    Parameters
    ----------
    window : Window
        What is acted on.

    Returns
    -------
    sequence of (str, callable)
        The actions of the menus that can be done now, then models, estimators and materials.
    """
    from lutcore.estimation import estimators
    from lutcore.materials import materials
    from lutcore.shading import shading_models

    controller = window.controller
    found: list[Command] = [
        (f"{one.menu}: {one.text}", partial(window.act, one))
        for one in window.actions_
        if one.enabled is None or one.enabled()
    ]
    for name in shading_models():
        change = partial(controller.change, f"model {name}", model=Method(name))
        found.append((f"Shading model: {name}", change))
    for name in estimators():
        change = partial(controller.change, f"estimator {name}", estimator=Method(name))
        found.append((f"Estimator: {name}", change))
    for name in materials():
        change = partial(controller.change, f"material {name}", material=name)
        found.append((f"Material: {name}", change))
    return found
