"""Nothing is cut or covered: at 1280 x 800, and at 200 % on such a screen, which leaves half."""

import os
import subprocess
import sys
from dataclasses import replace

import pytest
from qtpy.QtCore import QPoint, QRect, QSize, Qt
from qtpy.QtWidgets import (
    QAbstractButton,
    QAbstractSpinBox,
    QComboBox,
    QDialog,
    QLabel,
    QLineEdit,
    QMessageBox,
    QScrollArea,
    QSizeGrip,
    QStyle,
    QStyleOptionComboBox,
    QTreeView,
    QWidget,
)

from app.gui.picture_dialog import PictureDialog
from app.gui.scatter import Dot, Scatter
from app.session import Method, Session
from tests.app.gui.conftest import settled
from tests.app.gui.hands import answered, click_menu
from tests.app.gui.test_keys import DOCKS

SIZES = [(1280, 800), (632, 370)]
"""In units of the display's scale: of a screen of 1280 x 800 at 100 %, and at 200 %."""


def _cut(one: QWidget) -> str:
    """What of a control cannot be read, empty for nothing."""
    metrics = one.fontMetrics()
    if isinstance(one, QLabel) and one.text() and one.pixmap().isNull():
        if one.wordWrap():
            needed = one.heightForWidth(one.width())
            return f"{needed} high in {one.height()}" if needed > one.height() else ""
        wide = one.minimumSizeHint().width()
        return f"{wide} wide in {one.width()}" if wide > one.width() else ""
    if isinstance(one, QAbstractButton) and one.text():
        wide = metrics.horizontalAdvance(one.text().replace("&", ""))
        return f"{wide} wide in {one.width()}" if wide > one.width() else ""
    if isinstance(one, QComboBox) and not one.isEditable():
        option = QStyleOptionComboBox()
        one.initStyleOption(option)
        room = one.style().subControlRect(
            QStyle.ComplexControl.CC_ComboBox, option, QStyle.SubControl.SC_ComboBoxEditField, one
        )
        wide = metrics.horizontalAdvance(one.currentText())
        return f"{wide} wide in {room.width()}" if wide > room.width() else ""
    if isinstance(one, QAbstractSpinBox):
        line = one.findChild(QLineEdit)
        wide = metrics.horizontalAdvance(line.text())
        return f"{wide} wide in {line.width()}" if wide > line.width() else ""
    if isinstance(one, QTreeView) and not one.isHeaderHidden():
        header = one.header()
        for column in range(header.count() - 1):  # the last takes what is left, and scrolls
            if header.sectionSizeHint(column) > header.sectionSize(column):
                return f"column {column}"
    return ""


def _covered(parent: QWidget) -> list[str]:
    """Which children of a widget lie over one another."""
    kinds = QWidget
    shown = [
        one
        for one in parent.findChildren(kinds, options=Qt.FindChildOption.FindDirectChildrenOnly)
        if one.isVisible() and not one.isWindow() and not isinstance(one, QSizeGrip)
    ]
    if parent.layout() is None:  # a control that arranges its own parts
        return []
    return [
        f"{_name(one)} over {_name(other)}"
        for at, one in enumerate(shown)
        for other in shown[at + 1 :]
        if one.geometry().intersects(other.geometry())
    ]


def _name(one: QWidget) -> str:
    text = one.text() if isinstance(one, QLabel | QAbstractButton) else ""
    return f"{type(one).__name__} {one.accessibleName() or text!r}"


def faults(root: QWidget) -> list[str]:
    """What is cut or covered below a widget."""
    found = []
    for one in [root, *root.findChildren(QWidget)]:
        if not one.isVisible() or isinstance(one.parentWidget(), QAbstractSpinBox | QComboBox):
            continue
        cut = _cut(one)
        found += [f"{_name(one)}: {cut}"] if cut else []
        found += _covered(one)
        if isinstance(one, QScrollArea) and one.horizontalScrollBar().isVisible():
            found.append(f"{_name(one)} scrolls sideways")
    return found


@pytest.fixture(params=SIZES, ids=["100 %", "200 %"])
def sized(request, open_window):
    window = open_window(Session(mesh="sample:sphere"), size=request.param)
    assert (window.width(), window.height()) == request.param
    return window


@pytest.mark.parametrize("name", DOCKS)
def test_nothing_of_a_dock_is_cut_or_covered(sized, qtbot, name) -> None:
    window = sized
    window.controller.change("compare", compared=(Method("lambert"), Method("curvature-lut")))
    dock = window.docks[name]
    dock.show()
    dock.raise_()
    content = dock.fill()
    qtbot.waitUntil(content.isVisible)
    settled(qtbot, window)
    qtbot.wait(50)
    assert faults(dock.widget()) == []
    assert window.width() in (1280, 632), "the docks pushed the window open"
    assert window.canvas.width() > 0.3 * window.width()
    assert window.canvas.height() > 0.3 * window.height()


def test_messages_fit(sized, qtbot) -> None:
    window = sized
    window.banner.warn(
        "bad.ply: its header ends before the word end_header: the file is cut off; copy it again "
        "from where it came, or open another one",
        lambda: None,
    )
    window.units.asked.emit(0.05)
    qtbot.wait(100)
    assert faults(window.centralWidget()) == []
    assert window.unit_bar.isVisible()
    content = window.docks["shading"].fill()
    assert content.visibleRegion().boundingRect().width() > 200


@pytest.mark.parametrize("name", ["help.palette", "help.shortcuts", "help.keys"])
def test_dialogs_fit(sized, qtbot, name) -> None:
    before = set(sized.findChildren(QDialog))
    sized.act(sized.actions_[name])
    (dialog,) = set(sized.findChildren(QDialog)) - before
    qtbot.waitUntil(dialog.isVisible)
    qtbot.wait(50)
    assert dialog.width() <= sized.width()
    assert dialog.height() <= sized.height()
    assert faults(dialog) == []
    dialog.close()


def test_the_dialog_of_pictures_fits(sized, qtbot) -> None:
    dialog = PictureDialog(sized, (16384, 16384), (1280, 960), True)
    qtbot.addWidget(dialog)
    dialog.show()
    qtbot.waitUntil(dialog.isVisible)
    assert faults(dialog) == []


def test_the_question_about_changes_fits(sized, qtbot) -> None:
    found = []

    def look(dialog) -> None:
        found.extend(faults(dialog))
        inside = dialog.width() <= sized.width() and dialog.height() <= sized.height()
        found.extend([] if inside else ["wider than the window"])
        qtbot.keyClick(dialog, Qt.Key.Key_Escape)

    click_menu(qtbot, sized, "Curvature", "Flip colours")
    with answered(QMessageBox, look):
        qtbot.keyClick(sized, Qt.Key.Key_Q, Qt.KeyboardModifier.ControlModifier)
    assert found == []


def test_labels_of_the_chart_are_not_struck_out(qtbot) -> None:
    chart = Scatter(None, "time", "error")
    qtbot.addWidget(chart)
    chart.resize(400, 300)
    dots = (Dot("left", 1.0, 1e-2, 0.0), Dot("right", 1e4, 1e-4, 0.0))
    pictures = []
    for front in (False, True):
        chart.show_dots([replace(dot, front=front) for dot in dots], None)
        pictures.append(chart.grab().toImage())
    # The line from dot to dot begins under the label.
    at = chart.place(0).toPoint() + QPoint(
        9 + chart.fontMetrics().horizontalAdvance("left") // 2, 0
    )
    box = QRect(at - QPoint(8, 6), QSize(16, 12))
    plain, lined = (one.copy(box) for one in pictures)
    differ = [
        abs(plain.pixelColor(x, y).lightness() - lined.pixelColor(x, y).lightness())
        for x in range(box.width())
        for y in range(box.height())
    ]
    assert max(differ) < 80
    assert pictures[0] != pictures[1]


def test_what_is_cut_or_covered_is_found(window, qtbot) -> None:
    panel = window.docks["shading"].fill()
    assert faults(panel) == []
    label = QLabel("long enough to be cut", panel)
    label.setGeometry(0, 0, 20, 20)
    label.show()
    assert any("wide in 20" in one for one in faults(panel))
    assert any(" over " in one for one in faults(panel))


_CHILD = """
from qtpy.QtWidgets import QApplication
application = QApplication([])
from app.gui.window import Window
from app.session import Session
window = Window(Session(mesh="sample:sphere"))
window.show()
room = application.primaryScreen().availableGeometry()
print(room.width(), room.height(), window.width(), window.height(), window.devicePixelRatioF())
"""


@pytest.mark.parametrize(("scale", "width"), [("1", 1280), ("2", 640)])
def test_a_first_window_lies_on_its_screen(scale, width, config) -> None:
    done = subprocess.run(
        [sys.executable, "-c", _CHILD],
        env=os.environ | {"QT_SCALE_FACTOR": scale},
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    numbers = [float(one) for one in done.stdout.split()[-5:]]
    assert numbers[0] == width
    assert numbers[2] <= numbers[0]
    assert numbers[3] <= numbers[1]
    assert numbers[4] == float(scale)
