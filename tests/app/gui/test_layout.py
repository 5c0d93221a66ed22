"""Docks, theme, log and the menus of what can be opened, from one run to the next."""

from qtpy.QtGui import QPalette
from qtpy.QtWidgets import QApplication

from app.gui import theme
from app.gui.settings import Settings
from app.session import Session
from tests.app.gui.hands import click_menu


def test_docks_lie_where_they_were_left(open_window, qtbot) -> None:
    window = open_window(Session(mesh="sample:sphere"))
    assert window.docks["log"].isHidden()
    click_menu(qtbot, window, "Window", "Log")
    click_menu(qtbot, window, "Window", "Shading")
    window.close()
    again = open_window(Session(mesh="sample:sphere"))
    assert not again.docks["log"].isHidden()
    assert again.docks["shading"].isHidden()
    click_menu(qtbot, again, "Window", "Reset layout")
    assert again.docks["log"].isHidden()
    assert not again.docks["shading"].isHidden()


def test_a_layout_that_is_none_is_left(open_window) -> None:
    Settings().set("layout", {"size": "garbage", "docks": "\N{SNOWMAN}"})
    window = open_window(Session(mesh="sample:sphere"))
    assert window.docks["log"].isHidden()
    window.close()
    Settings().set("layout", {"size": 3, "docks": "Z2FyYmFnZQ=="})
    assert open_window(Session(mesh="sample:sphere")).docks["log"].isHidden()


def _luminance(color) -> float:
    def linear(value: float) -> float:
        return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4

    red, green, blue = (linear(one) for one in (color.redF(), color.greenF(), color.blueF()))
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def test_words_stand_out_in_both_themes() -> None:
    role = QPalette.ColorRole
    pairs = [
        (role.WindowText, role.Window),
        (role.Text, role.Base),
        (role.ButtonText, role.Button),
        (role.HighlightedText, role.Highlight),
        (role.ToolTipText, role.ToolTipBase),
        (role.Link, role.Base),
    ]
    for name in ("light", "dark"):
        made = theme.palette(name)
        for ink, ground in pairs:
            one, other = sorted(_luminance(made.color(part)) for part in (ink, ground))
            # WCAG 2.1, 1.4.3, level AA.
            assert (other + 0.05) / (one + 0.05) >= 4.5, (name, ink, ground)


def test_a_theme_is_chosen_and_remembered(window, qtbot) -> None:
    before = QApplication.palette().window().color()
    click_menu(qtbot, window, "View", "Theme", "Dark")
    assert QApplication.palette().window().color().lightness() < 80
    qtbot.waitUntil(lambda: window.palette().window().color().lightness() < 80)
    assert theme.chosen(Settings()) == "dark"
    assert window.qactions["view.theme_dark"].isChecked()
    click_menu(qtbot, window, "View", "Theme", "As the system")
    assert QApplication.palette().window().color() == before


def test_the_log_holds_what_was_said_before_it_was_opened(window, qtbot) -> None:
    window.controller.noted.emit("said early")
    click_menu(qtbot, window, "Window", "Log")
    text = window.docks["log"].fill()
    assert "vertices" in text.toPlainText()
    assert "said early" in text.toPlainText()
    window.controller.failed.emit("said later")
    assert text.toPlainText().splitlines()[-1].endswith("said later")
