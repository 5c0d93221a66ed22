"""Point at the mesh, pin, copy, save."""

import csv
import threading

import numpy as np
import pytest
from qtpy.QtCore import QEvent, QPoint, Qt
from qtpy.QtGui import QGuiApplication

from tests.app.gui.conftest import pixels, settled
from tests.app.gui.hands import click_menu, named
from tests.app.gui.mouse import move


@pytest.fixture
def panel(window, qtbot):
    dock = window.docks["probe"]
    click_menu(qtbot, window, "Window", "Probe")
    panel = dock.fill()
    qtbot.waitUntil(panel.isVisible)
    settled(qtbot, window)
    return panel


def _middle(window) -> QPoint:
    return QPoint(window.canvas.width() // 2, round(window.canvas.height() * 0.48))


def test_what_is_under_the_mouse_is_said_with_its_error(window, qtbot, panel) -> None:
    move(qtbot, window.canvas, _middle(window), lambda: panel.probing.current is not None)
    found = panel.probing.current
    # The sphere has radius 10 mm, and its middle is seen from the front.
    assert found.values["k1"] == pytest.approx(0.1, rel=0.05)
    assert found.position[2] == pytest.approx(10.0, abs=0.2)
    shown = {
        panel.values.topLevelItem(row).text(0): panel.values.topLevelItem(row).text(1)
        for row in range(panel.values.topLevelItemCount())
    }
    assert "\N{PLUS-MINUS SIGN}" in shown["curvature k1"]
    # What the model of the view gives is what the view shows there.
    color = pixels(window)[_middle(window).y(), _middle(window).x()].astype(int)
    assert np.abs(color - found.readings[0].color).max() <= 6 or (color > 240).all()


def test_the_mark_under_the_mouse_goes_with_the_panel(window, qtbot, panel) -> None:
    plain = pixels(window)
    move(qtbot, window.canvas, _middle(window), lambda: panel.probing.current is not None)
    settled(qtbot, window)
    assert (pixels(window) != plain).any()
    height = window.canvas.height()
    click_menu(qtbot, window, "Window", "Probe")
    qtbot.waitUntil(lambda: window.canvas.height() > height)
    settled(qtbot, window)
    left = pixels(window)
    window.canvas.leaveEvent(QEvent(QEvent.Type.Leave))
    settled(qtbot, window)
    np.testing.assert_array_equal(pixels(window), left)
    assert panel.probing.current is None


def test_a_click_pins_and_the_table_can_be_copied_and_saved(window, qtbot, panel, tmp_path) -> None:
    canvas = window.canvas
    for shift in (0, 40):
        qtbot.mouseClick(canvas, Qt.MouseButton.LeftButton, pos=_middle(window) + QPoint(shift, 0))
        qtbot.waitUntil(lambda n=shift // 40 + 1: len(panel.probing.pins) == n, timeout=240_000)
    assert window.controller.document.undo_label is None
    assert panel.table.rowCount() == 2
    # A mark of the pins' colour is on the mesh.
    yellow = np.array([255, 217, 26])
    assert (np.abs(pixels(window).astype(int) - yellow).max(axis=2) < 8).sum() > 20
    qtbot.mouseClick(panel.buttons["Copy"], Qt.MouseButton.LeftButton)
    copied = QGuiApplication.clipboard().text()
    with named(tmp_path / "pins.csv"):
        qtbot.mouseClick(panel.buttons["CSV"], Qt.MouseButton.LeftButton)
    assert (tmp_path / "pins.csv").read_text() == copied
    rows = list(csv.DictReader(copied.splitlines()))
    assert [int(row["vertex"]) for row in rows] == [one.vertex for one in panel.probing.pins]
    assert float(rows[0]["k1"]) == panel.probing.pins[0].values["k1"]
    assert rows[0]["lambert color"].startswith("#")
    second = panel.probing.pins[1]
    place = panel.table.visualItemRect(panel.table.item(0, 0)).center()
    qtbot.mouseClick(panel.table.viewport(), Qt.MouseButton.LeftButton, pos=place)
    qtbot.mouseClick(panel.buttons["Remove"], Qt.MouseButton.LeftButton)
    assert panel.probing.pins == [second]
    qtbot.mouseClick(panel.buttons["Clear"], Qt.MouseButton.LeftButton)
    assert panel.table.rowCount() == 0
    assert not (np.abs(pixels(window).astype(int) - yellow).max(axis=2) < 8).any()


def test_a_click_pins_what_it_was_on_wherever_the_mouse_goes_meanwhile(
    window, qtbot, panel
) -> None:
    canvas, free = window.canvas, threading.Event()
    window.controller.run("other work", lambda _: free.wait(60.0), lambda _: None)
    qtbot.mouseClick(canvas, Qt.MouseButton.LeftButton, pos=_middle(window))
    place = _middle(window) + QPoint(40, 0)
    move(qtbot, canvas, place)
    qtbot.waitUntil(lambda: not panel._rest.isActive())
    free.set()
    settled(qtbot, window)
    (pinned,) = panel.probing.pins
    assert pinned.vertex != panel.probing.current.vertex
    qtbot.mouseClick(canvas, Qt.MouseButton.LeftButton, pos=_middle(window))
    settled(qtbot, window)
    assert [one.vertex for one in panel.probing.pins] == [pinned.vertex]


def test_beside_the_mesh_there_is_nothing(window, qtbot, panel) -> None:
    qtbot.mouseClick(window.canvas, Qt.MouseButton.LeftButton, pos=QPoint(5, 5))
    settled(qtbot, window)
    assert panel.probing.current is None
    assert panel.probing.pins == []
    # Nor is what the mouse goes to next pinned.
    move(qtbot, window.canvas, _middle(window), lambda: panel.probing.current is not None)
    assert panel.probing.pins == []


def test_a_pin_cannot_be_saved_where_there_is_no_folder(window, panel, tmp_path) -> None:
    # No dialog leads there; but a folder may be gone by the time it is written.
    panel.save(tmp_path / "missing" / "pins.csv")
    assert "pins.csv" in window.banner.label.text()
