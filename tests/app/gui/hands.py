"""What a person does with mouse and keys: menus, lists, fields, boxes and dialogs."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from qtpy.QtCore import QPoint, Qt, QTimer
from qtpy.QtTest import QTest
from qtpy.QtWidgets import (
    QAbstractButton,
    QApplication,
    QColorDialog,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QLineEdit,
    QMessageBox,
    QScrollArea,
    QTabBar,
    QWidget,
)

LEFT = Qt.MouseButton.LeftButton
_PATIENCE = 60.0  # s
_MARK = 8  # pixels from the left edge of a box to the middle of its mark


def click_menu(qtbot, window, *titles: str) -> None:
    """Click through the menus, by what they say without their dots."""
    holder, path = window.menuBar(), ""
    for title in titles:
        (entry,) = (one for one in holder.actions() if _bare(one.text()) == title)
        qtbot.mouseClick(holder, LEFT, pos=holder.actionGeometry(entry).center())
        path = f"{path}/{title}".lstrip("/")
        if path in window.menus:
            holder = window.menus[path]
            qtbot.waitUntil(holder.isVisible)


def _bare(text: str) -> str:
    return text.replace("&", "").rstrip("\N{HORIZONTAL ELLIPSIS}")


def click_tab(qtbot, window, title: str) -> None:
    """Bring a dock to the front by a click on its tab."""
    for bar in window.findChildren(QTabBar):
        texts = [bar.tabText(index) for index in range(bar.count())]
        if bar.isVisible() and title in texts:
            qtbot.mouseClick(bar, LEFT, pos=bar.tabRect(texts.index(title)).center())
            return
    raise AssertionError(f"no tab is called {title}")


def choose(qtbot, box: QComboBox, text: str) -> None:
    """Choose from a list that drops down, by its keys."""
    box.setFocus()
    index = box.findText(text, Qt.MatchFlag.MatchStartsWith)
    assert index >= 0, text
    step = Qt.Key.Key_Down if index > box.currentIndex() else Qt.Key.Key_Up
    for _ in range(abs(index - box.currentIndex())):
        qtbot.keyClick(box, step)


def tick(qtbot, box: QAbstractButton) -> None:
    """Click a box, or a round one, on its mark: beyond its words it takes no clicks."""
    qtbot.mouseClick(box, LEFT, pos=QPoint(_MARK, box.height() // 2))


def bring_to_view(qtbot, widget: QWidget) -> None:
    """Scroll until a part of a dock is seen."""
    above = widget.parentWidget()
    while not isinstance(above, QScrollArea):
        above = above.parentWidget()
    above.ensureWidgetVisible(widget)
    qtbot.waitUntil(lambda: widget.visibleRegion().boundingRect().height() > 0)


def undo(qtbot, window) -> None:
    """Press the keys that take the last change back."""
    qtbot.keyClick(window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)


def type_in(qtbot, field: QWidget, text: str) -> None:
    """Type in place of what stands in a field, and confirm."""
    field.setFocus()
    field.selectAll()  # type: ignore[attr-defined]
    qtbot.keyClicks(field, text)
    qtbot.keyClick(field, Qt.Key.Key_Return)


@contextmanager
def answered(kind: type[QDialog], answer: Callable[[QDialog], None]) -> Iterator[None]:
    """Answer a dialog that must come while the block runs, which waits for it."""
    came: list[str] = []
    window = QApplication.activeWindow()
    begun = time.monotonic()

    def look() -> None:
        dialog = QApplication.activeModalWidget()
        if time.monotonic() - begun > _PATIENCE and isinstance(dialog, QDialog):
            dialog.reject()  # or the block would wait for ever
            raise AssertionError(f"{dialog.windowTitle()!r} did not go")
        if came or not isinstance(dialog, kind) or not dialog.isVisible():
            return
        came.append(dialog.windowTitle())
        answer(dialog)

    timer = QTimer()
    timer.timeout.connect(look)
    timer.start(20)
    try:
        yield
    finally:
        timer.stop()
    assert came, f"no {kind.__name__} came"
    if window is not None and window.isVisible():
        window.activateWindow()  # no window manager gives it the keyboard back
        assert QTest.qWaitForWindowActive(window, round(1000 * _PATIENCE))


def named(path: Path | str):
    """Give the name of a file to the dialog that asks for one."""
    return answered(QFileDialog, partial(_confirm, lambda line: True, str(path)))


def colored(text: str):
    """Give a colour to the dialog that asks for one."""
    return answered(QColorDialog, partial(_confirm, lambda line: line.text()[:1] == "#", text))


def _confirm(wanted: Callable[[QLineEdit], bool], text: str, dialog: QDialog) -> None:
    """Give a text and confirm, once more where that came too early."""
    accepting = QDialogButtonBox.ButtonRole.AcceptRole
    box = dialog.findChild(QDialogButtonBox)
    button = next(one for one in box.buttons() if box.buttonRole(one) == accepting)
    line = next(one for one in dialog.findChildren(QLineEdit) if one.isVisible() and wanted(one))
    end = time.monotonic() + _PATIENCE
    while dialog.isVisible() and time.monotonic() < end:
        line.selectAll()
        # As if pasted: letter by letter a dialog of files may go on holding the folders on the way
        # for what is meant, and let nobody confirm.
        line.insert(text)
        QTest.mouseClick(button, LEFT)
        QTest.qWait(100)


def dismissed(kind: type[QDialog]):
    """Leave a dialog with Escape."""
    return answered(kind, lambda dialog: QTest.keyClick(dialog, Qt.Key.Key_Escape))


def pressed(button: QMessageBox.StandardButton):
    """Click a button of a question."""

    def answer(dialog: QDialog) -> None:
        assert isinstance(dialog, QMessageBox)
        QTest.mouseClick(dialog.button(button), LEFT)

    return answered(QMessageBox, answer)
