"""Do things by name; see what the keys do."""

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QApplication

from app.gui.matching import ranked
from app.gui.menus.help import keys_text
from app.gui.palette import Palette
from tests.app.gui.conftest import settled


def test_letters_in_order_and_word_beginnings_come_first() -> None:
    names = ["View: Reset camera", "Material: cream", "File: Open", "Material: ream"]
    assert ranked("mcr", names)[0] == 1
    assert ranked("xyz", names) == []
    assert ranked("", names) == [0, 1, 2, 3]


def test_a_material_is_chosen_by_typing(window, qtbot) -> None:
    qtbot.keyClick(
        window,
        Qt.Key.Key_P,
        Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier,
    )
    palette = next(one for one in QApplication.topLevelWidgets() if isinstance(one, Palette))
    qtbot.waitUntil(palette.isVisible)
    qtbot.keyClicks(palette.line, "mat marble")
    assert palette.list.item(0).text() == "Material: marble"
    qtbot.keyClick(palette.line, Qt.Key.Key_Return)
    settled(qtbot, window)
    assert window.controller.session.material == "marble"
    assert not palette.isVisible()


def test_the_sheet_has_the_keys_as_they_are_now(window) -> None:
    said = keys_text(window)
    assert "Ctrl+O" in said
    assert "Open a mesh" in said
    window.qactions["file.open"].setShortcut("Ctrl+9")
    assert "Ctrl+9" in keys_text(window)
