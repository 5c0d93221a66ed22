"""Keys go to the control that has the focus before they go to the window's shortcuts."""

import pytest
from qtpy.QtCore import Qt
from qtpy.QtGui import QKeySequence
from qtpy.QtWidgets import (
    QAbstractItemView,
    QAbstractSpinBox,
    QComboBox,
    QLineEdit,
    QPlainTextEdit,
    QWidget,
)

from app.gui.slider import Slider
from tests.app.gui.conftest import settled

KEY = Qt.Key
DOCKS = (
    ["choose", "compare", "curvature", "health", "lights", "log", "probe", "shading", "table"]
)  # fmt: skip


def counted(window) -> list[str]:
    """Names of the actions that are done from now on, instead of doing them."""
    done: list[str] = []
    window.act = lambda action: done.append(action.name)
    return done


def focusable(root: QWidget) -> list[QWidget]:
    return [
        one
        for one in root.findChildren(QWidget)
        if one.isEnabled()
        and one.isVisibleTo(root)
        and one.focusPolicy() & Qt.FocusPolicy.TabFocus
        and one.focusProxy() is None
        and one.metaObject().className() != "QScrollArea"
    ]


def press(qtbot, window, widget, key) -> None:
    widget.setFocus()
    qtbot.waitUntil(widget.hasFocus)
    qtbot.keyClick(widget, key)


def test_the_list_of_docks_is_whole(window) -> None:
    assert set(DOCKS) == set(window.docks)


@pytest.mark.parametrize("name", DOCKS)
def test_no_control_of_a_dock_loses_its_keys(window, qtbot, name) -> None:
    dock = window.docks[name]
    dock.show()
    dock.raise_()
    content = dock.fill()
    qtbot.waitUntil(content.isVisible)
    settled(qtbot, window)
    done = counted(window)
    letters = [
        KEY[f"Key_{one.shortcut}"]
        for one in window.actions_
        if len(one.shortcut) == 1 and one.shortcut.isalnum()
    ]
    found = focusable(content)
    assert found or name in ("log", "table")
    for widget in found:
        field = isinstance(widget, QAbstractSpinBox | QLineEdit)
        ends = field or isinstance(widget, QAbstractItemView)
        keys = [KEY.Key_Left, KEY.Key_Right]
        keys += [KEY.Key_Return, KEY.Key_Enter] if ends else []
        for key in keys + (letters if field else []):
            press(qtbot, window, widget, key)
            assert not done, (type(widget).__name__, widget.accessibleName(), key.name)
    settled(qtbot, window)


def test_the_view_leaves_its_keys_to_the_window(window, qtbot) -> None:
    done = counted(window)
    for key in (KEY.Key_Left, KEY.Key_Right, KEY.Key_Return, KEY.Key_H, KEY.Key_1):
        press(qtbot, window, window.canvas, key)
    assert done == ["file.previous", "file.next", "view.reset", "help.keys", "view.from_front"]


def test_a_click_on_the_view_gives_it_the_keys_back(window, qtbot) -> None:
    number = window.docks["shading"].fill().findChild(QAbstractSpinBox)
    number.setFocus()
    done = counted(window)
    qtbot.mouseClick(window.canvas, Qt.MouseButton.LeftButton)
    qtbot.keyClick(window.focusWidget(), KEY.Key_Right)
    assert done == ["file.next"]


def test_letters_are_typed_into_a_field_and_shortcuts_of_control_still_act(window, qtbot) -> None:
    line = QLineEdit(window.centralWidget())
    line.show()
    done = counted(window)
    for key in (KEY.Key_H, KEY.Key_B, KEY.Key_1, KEY.Key_Left, KEY.Key_N):
        press(qtbot, window, line, key)
    assert line.text() == "hbn1"
    assert not done
    qtbot.keyClick(line, KEY.Key_S, Qt.KeyboardModifier.ControlModifier)
    assert done == ["file.save"]


def test_a_log_that_is_only_read_leaves_letters_to_the_window(window, qtbot) -> None:
    text = QPlainTextEdit("read me", window.centralWidget())
    text.setReadOnly(True)
    text.show()
    done = counted(window)
    press(qtbot, window, text, KEY.Key_Right)
    assert not done
    press(qtbot, window, text, KEY.Key_H)
    assert done == ["help.keys"]


def test_undo_in_a_number_takes_the_change_back(window, qtbot) -> None:
    exposure: Slider = window.docks["shading"].fill().exposure
    before = window.controller.session.exposure
    exposure.number.setFocus()
    exposure.number.selectAll()
    qtbot.keyClicks(exposure.number, "2")
    qtbot.keyClick(exposure.number, KEY.Key_Return)
    assert window.controller.session.exposure == 4.0
    assert QKeySequence(QKeySequence.StandardKey.Undo).toString() == "Ctrl+Z"
    qtbot.keyClick(exposure.number, KEY.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert window.controller.session.exposure == before
    settled(qtbot, window)


def test_arrows_choose_in_a_list_that_drops_down(window, qtbot) -> None:
    box: QComboBox = window.docks["curvature"].fill().quantity
    window.docks["curvature"].raise_()
    qtbot.waitUntil(box.isVisible)
    done = counted(window)
    press(qtbot, window, box, KEY.Key_Right)
    assert not done
    before = box.currentIndex()
    press(qtbot, window, box, KEY.Key_Down)
    assert box.currentIndex() == before + 1
    settled(qtbot, window)
