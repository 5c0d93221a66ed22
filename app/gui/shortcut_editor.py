"""A dialog that gives actions other keys; each takes effect at once."""

from typing import TYPE_CHECKING

from qtpy.QtCore import Qt
from qtpy.QtGui import QKeySequence
from qtpy.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QKeySequenceEdit,
    QLabel,
    QPushButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.gui.fitting import fit

if TYPE_CHECKING:
    from app.gui.window import Window

_NAME = Qt.ItemDataRole.UserRole
_PORTABLE = QKeySequence.SequenceFormat.PortableText
_GAP = 16
_NATIVE = QKeySequence.SequenceFormat.NativeText


class ShortcutEditor(QDialog):
    """Lists the actions with their keys.

    Parameters
    ----------
    window : Window
        Whose keys they are.
    """

    def __init__(self, window: "Window") -> None:
        super().__init__(window)
        self.setWindowTitle("Shortcuts")
        self._shortcuts = window.shortcuts
        self.list = QTreeWidget(self)
        self.list.setAccessibleName("Actions and their keys")
        self.list.setHeaderLabels(["Menu", "Action", "Key"])
        self.list.setRootIsDecorated(False)
        self._rows: dict[str, QTreeWidgetItem] = {}
        for action in window.actions_:
            text = action.text.rstrip("\N{HORIZONTAL ELLIPSIS}")
            row = QTreeWidgetItem(self.list, [action.menu.replace("/", ", "), text, ""])
            row.setData(0, _NAME, action.name)
            row.setToolTip(1, action.doc)
            self._rows[action.name] = row
            self._follow(action.name)
        for column in range(3):
            self.list.resizeColumnToContents(column)
        self.key = QKeySequenceEdit(self)
        self.key.setAccessibleName("New key")
        self.key.setToolTip("Click here and press the key for the chosen action")
        self.key.setMaximumSequenceLength(1)
        self.key.setClearButtonEnabled(True)
        self.note = QLabel(self)
        self.note.setWordWrap(True)
        self.note.setAccessibleName("Whose key it is now")
        self.assign = QPushButton("Assign", self)
        self.assign.setToolTip("Give the chosen action this key; an empty one takes its key away")
        self.assign.setAutoDefault(False)
        self._arrange()
        self._shortcuts.changed.connect(self._follow)
        self.finished.connect(lambda *_: self._shortcuts.changed.disconnect(self._follow))
        self.list.currentItemChanged.connect(lambda *_: self._on_chosen())
        self.key.keySequenceChanged.connect(lambda *_: self._check())
        self.assign.clicked.connect(self._on_assign)
        self.list.setCurrentItem(self.list.topLevelItem(0))
        # Apart: what stands in one column must not run into the next.
        for column in range(2):
            self.list.setColumnWidth(column, self.list.columnWidth(column) + _GAP)
        width = max(window.width() * 0.55, self.list.header().length() + 60)
        fit(self, width, window.height() * 0.8)

    def _arrange(self) -> None:
        below = QWidget(self)
        row = QHBoxLayout(below)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self.key, 1)
        row.addWidget(self.assign)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        self.reset = buttons.addButton("Reset all", QDialogButtonBox.ButtonRole.ResetRole)
        self.reset.setToolTip("Give all actions their own keys back")
        self.reset.clicked.connect(self._on_reset)
        # Return in the field of the key is a key, and must not press a button.
        for button in buttons.buttons():
            if isinstance(button, QPushButton):
                button.setAutoDefault(False)
        buttons.rejected.connect(self.accept)
        column = QVBoxLayout(self)
        column.addWidget(self.list, 1)
        column.addWidget(below)
        column.addWidget(self.note)
        column.addWidget(buttons)

    @property
    def _chosen(self) -> str:
        return str(self.list.currentItem().data(0, _NAME))

    @property
    def _typed(self) -> str:
        return self.key.keySequence().toString(_PORTABLE)

    def _on_chosen(self) -> None:
        self.key.setKeySequence(QKeySequence(self._shortcuts.key(self._chosen)))
        self._check()

    def _check(self) -> None:
        holder = self._shortcuts.holder(self._typed, besides=self._chosen)
        self.note.setText(
            ""
            if holder is None
            else f"This is the key of {holder.text.rstrip(chr(0x2026))} ({holder.menu}), which "
            "loses it."
        )

    def _on_assign(self) -> None:
        self._shortcuts.bind(self._chosen, self._typed)
        self._check()

    def _on_reset(self) -> None:
        self._shortcuts.reset()
        self._on_chosen()

    def _follow(self, name: str) -> None:
        key = QKeySequence(self._shortcuts.key(name))
        self._rows[name].setText(2, key.toString(_NATIVE))
