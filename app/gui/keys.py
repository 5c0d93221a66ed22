"""Keys that a control with the focus needs although the window has shortcuts on them."""

from qtpy.QtCore import QEvent, QObject, Qt
from qtpy.QtGui import QKeyEvent, QKeySequence
from qtpy.QtWidgets import (
    QAbstractItemView,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QKeySequenceEdit,
    QLineEdit,
    QPlainTextEdit,
    QTextEdit,
    QWidget,
)

from app.gui.canvas import Canvas

_KEY = Qt.Key
_STANDARD = QKeySequence.StandardKey
_MOVES = {
    _KEY.Key_Left,
    _KEY.Key_Right,
    _KEY.Key_Up,
    _KEY.Key_Down,
    _KEY.Key_Home,
    _KEY.Key_End,
    _KEY.Key_PageUp,
    _KEY.Key_PageDown,
}
_ENDS = {_KEY.Key_Return, _KEY.Key_Enter}
_EDITS = {_KEY.Key_Backspace, _KEY.Key_Delete, _KEY.Key_Insert}
_OTHERS = (
    Qt.KeyboardModifier.ControlModifier
    | Qt.KeyboardModifier.AltModifier
    | Qt.KeyboardModifier.MetaModifier
)


class Keys(QObject):
    """Lets the control that has the focus claim its keys before the window's shortcuts do.

    A control need not know of it: what has the focus, view apart, keeps the keys that move in it;
    fields, lists and tables Return as well, and fields whatever can be typed.

    Parameters
    ----------
    window : QWidget
        Whose controls it watches.
    """

    def __init__(self, window: QWidget) -> None:
        super().__init__(window)
        self._window = window
        self._watched: QWidget | None = None
        application = QApplication.instance()
        assert isinstance(application, QApplication)
        application.focusChanged.connect(self._on_focus)

    def _on_focus(self, before: QWidget | None, now: QWidget | None) -> None:
        # Only who has the focus is watched: a filter of all events would slow all of them.
        if before is not None and before is self._watched:
            before.removeEventFilter(self)
        self._watched = None
        if now is not None and self._window.isAncestorOf(now) and not isinstance(now, Canvas):
            self._watched = now
            now.installEventFilter(self)

    def eventFilter(self, watched: QObject | None, event: QEvent | None) -> bool:  # noqa: N802
        """Claim a key, or give it to the window."""
        if event is None or event.type() != QEvent.Type.ShortcutOverride:
            return False
        assert isinstance(event, QKeyEvent)
        if isinstance(watched, QWidget) and claims(watched, event):
            event.accept()
            return True
        if isinstance(watched, QAbstractSpinBox) and _nothing_typed(watched, event):
            # It would claim undo for its own text, where there is nothing to undo.
            event.ignore()
            return True
        return False


def claims(widget: QWidget, event: QKeyEvent) -> bool:
    """Tell whether a control needs a key.

    Parameters
    ----------
    widget : QWidget
        What has the focus.
    event : QKeyEvent
        The key.

    Returns
    -------
    bool
        False for keys with Control, Alt or Meta: controls claim those of text themselves.
    """
    if event.modifiers() & _OTHERS:
        return False
    key = _KEY(event.key())
    if key in _MOVES:
        return True
    if isinstance(widget, QPlainTextEdit | QTextEdit) and widget.isReadOnly():
        return False
    field = isinstance(
        widget, QAbstractSpinBox | QLineEdit | QPlainTextEdit | QTextEdit | QKeySequenceEdit
    ) or (isinstance(widget, QComboBox) and widget.isEditable())
    if key in _ENDS:
        return field or isinstance(widget, QAbstractItemView)
    return field and (key in _EDITS or (bool(event.text()) and event.text().isprintable()))


def _nothing_typed(box: QAbstractSpinBox, event: QKeyEvent) -> bool:
    line = box.lineEdit()
    undone = event.matches(_STANDARD.Undo) and not (line and line.isUndoAvailable())
    return undone or (event.matches(_STANDARD.Redo) and not (line and line.isRedoAvailable()))
