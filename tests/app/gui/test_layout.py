"""Docks, theme, log and the menus of what can be opened, from one run to the next."""

from qtpy.QtCore import QMimeData, QPointF, Qt, QUrl
from qtpy.QtGui import QDropEvent, QPalette
from qtpy.QtWidgets import QApplication

from app.gui import theme
from app.gui.open_menus import RECENT, SAMPLES
from app.gui.settings import Settings
from app.session import Session, write
from tests.app.gui.conftest import settled


def test_docks_lie_where_they_were_left(open_window) -> None:
    window = open_window(Session(mesh="sample:sphere"))
    assert window.docks["log"].isHidden()
    window.docks["log"].show()
    window.docks["shading"].hide()
    window.close()
    again = open_window(Session(mesh="sample:sphere"))
    assert not again.docks["log"].isHidden()
    assert again.docks["shading"].isHidden()
    again.act(again.actions_["window.reset"])
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
    window.act(window.actions_["view.theme_dark"])
    assert QApplication.palette().window().color().lightness() < 80
    qtbot.waitUntil(lambda: window.palette().window().color().lightness() < 80)
    assert theme.chosen(Settings()) == "dark"
    assert window.qactions["view.theme_dark"].isChecked()
    window.act(window.actions_["view.theme_system"])
    assert QApplication.palette().window().color() == before


def test_the_log_holds_what_was_said_before_it_was_opened(window, qtbot) -> None:
    window.controller.noted.emit("said early")
    window.docks["log"].show()
    text = window.docks["log"].fill()
    assert "vertices" in text.toPlainText()
    assert "said early" in text.toPlainText()
    window.controller.failed.emit("said later")
    assert text.toPlainText().splitlines()[-1].endswith("said later")


def test_recent_files_and_samples_open(window, qtbot) -> None:
    for title in (RECENT, SAMPLES):
        window.menus[title].aboutToShow.emit()
    (first,) = window.menus[RECENT].actions()
    assert first.text() == "sample:sphere"
    saddle = next(one for one in window.menus[SAMPLES].actions() if one.text() == "saddle")
    saddle.trigger()
    settled(qtbot, window)
    assert window.controller.session.mesh == "sample:saddle"
    window.menus[RECENT].aboutToShow.emit()
    assert [one.text() for one in window.menus[RECENT].actions()] == [
        "sample:saddle",
        "sample:sphere",
    ]


def test_a_session_that_is_dropped_opens(window, qtbot, tmp_path) -> None:
    file = tmp_path / "kept.json"
    write(Session(mesh="sample:saddle", view="curvature"), file)
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(file))])
    copy, left = Qt.DropAction.CopyAction, Qt.MouseButton.LeftButton
    keys = Qt.KeyboardModifier.NoModifier
    window.dropEvent(QDropEvent(QPointF(300, 300), copy, data, left, keys))
    settled(qtbot, window)
    assert window.controller.session.mesh == "sample:saddle"
    assert window.controller.document.path == file
    assert window.controller.outcome.session.view == "curvature"
