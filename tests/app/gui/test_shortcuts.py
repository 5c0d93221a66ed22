"""Keys can be chosen, take effect at once, and are told where they are taken."""

from qtpy.QtCore import Qt

from app.gui.settings import Settings
from app.gui.shortcut_editor import ShortcutEditor
from app.session import Session
from tests.app.gui.conftest import settled
from tests.app.gui.hands import click_menu


def _editor(qtbot, window) -> ShortcutEditor:
    click_menu(qtbot, window, "Help", "Change shortcuts")
    (found,) = window.findChildren(ShortcutEditor)
    return found


def _pick(qtbot, editor: ShortcutEditor, menu: str, text: str) -> None:
    """Click the row of an action."""
    found = editor.list.findItems(text, Qt.MatchFlag.MatchExactly, 1)
    (row,) = (one for one in found if one.text(0) == menu)
    editor.list.scrollToItem(row)
    place = editor.list.visualItemRect(row).center()
    qtbot.mouseClick(editor.list.viewport(), Qt.MouseButton.LeftButton, pos=place)
    assert editor.list.currentItem() is row


def test_a_chosen_key_acts_at_once_and_in_the_next_window(window, open_window, qtbot) -> None:
    editor = _editor(qtbot, window)
    _pick(qtbot, editor, "View", "Curvature")
    qtbot.keyClick(editor.key, Qt.Key.Key_F9)
    qtbot.mouseClick(editor.assign, Qt.MouseButton.LeftButton)
    qtbot.keyClick(editor, Qt.Key.Key_Escape)
    window.activateWindow()  # no window manager gives it the keyboard back
    qtbot.waitUntil(window.isActiveWindow)
    qtbot.keyClick(window, Qt.Key.Key_F3)
    assert window.controller.session.view == "shade"
    qtbot.keyClick(window, Qt.Key.Key_F9)
    settled(qtbot, window)
    assert window.controller.session.view == "curvature"
    again = open_window(Session(mesh="sample:sphere"))
    assert again.qactions["view.curvature"].shortcut().toString() == "F9"


def test_a_key_that_is_taken_is_told_and_given_over(window, qtbot) -> None:
    editor = _editor(qtbot, window)
    _pick(qtbot, editor, "View", "Curvature")
    qtbot.keyClick(editor.key, Qt.Key.Key_F2)
    assert "Shading" in editor.note.text()
    qtbot.mouseClick(editor.assign, Qt.MouseButton.LeftButton)
    assert editor.note.text() == ""
    assert window.qactions["view.shade"].shortcut().isEmpty()
    assert window.qactions["view.curvature"].shortcut().toString() == "F2"
    qtbot.mouseClick(editor.reset, Qt.MouseButton.LeftButton)
    assert window.qactions["view.shade"].shortcut().toString() == "F2"
    assert window.qactions["view.curvature"].shortcut().toString() == "F3"
    assert Settings().get("shortcuts", {}) == {}


def test_settings_that_are_no_keys_are_left(open_window) -> None:
    settings = Settings()
    settings.set("shortcuts", {"view.shade": 7, "no.such": "F2", "view.figure": ""})
    window = open_window(Session(mesh="sample:sphere"))
    assert window.qactions["view.shade"].shortcut().toString() == "F2"
    assert window.qactions["view.figure"].shortcut().isEmpty()
    window.shortcuts.reset()
    assert window.qactions["view.figure"].shortcut().toString() == "F4"
