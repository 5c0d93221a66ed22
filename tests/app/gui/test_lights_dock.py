"""The dock of the lights: the list, the ball and the chosen light's controls."""

import numpy as np
import pytest
from qtpy.QtCore import QPoint, Qt, QTimer
from qtpy.QtTest import QTest
from qtpy.QtWidgets import QApplication

from app.gui.aiming import from_ball, kept_in, on_ball, seen_by, turned
from app.session import Camera, Cone, Directional, Point
from tests.app.gui.conftest import pixels, settled
from tests.app.gui.hands import choose, click_tab, colored, type_in, undo
from tests.app.gui.mouse import move


@pytest.fixture
def panel(qtbot, window):
    click_tab(qtbot, window, "Lights")
    content = window.docks["lights"].fill()
    settled(qtbot, window)
    qtbot.waitUntil(content.isVisible)
    return content


def click(button):
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)


def _add(qtbot, panel, kind: str) -> None:
    """Click the button, then the entry of its menu, which waits for one."""

    def pick() -> None:
        menu = QApplication.activePopupWidget()
        (entry,) = (one for one in menu.actions() if one.text().lower() == kind.lower())
        QTest.mouseClick(menu, Qt.MouseButton.LeftButton, pos=menu.actionGeometry(entry).center())

    timer = QTimer()
    timer.timeout.connect(lambda: QApplication.activePopupWidget() and pick())
    timer.start(50)
    count = panel.list.count()
    click(panel.add)
    qtbot.waitUntil(lambda: panel.list.count() == count + 1)
    timer.stop()


def at(ball, direction) -> QPoint:
    return ball.place(direction).toPoint()


def test_directions_and_places_on_the_ball_belong_together():
    for direction in ((0.3, 0.4, 0.866), (0.6, -0.2, -0.775), (0.0, 0.0, 1.0)):
        x, y, front = on_ball(direction)
        length = np.hypot(x, y)
        beyond = 1.0 if front else (2.0 - length) / length
        unit = np.asarray(direction) / np.linalg.norm(direction)
        np.testing.assert_allclose(from_ball(x * beyond, y * beyond), unit, atol=1e-9)


def test_a_drag_to_the_right_turns_the_front_to_the_right():
    np.testing.assert_allclose(turned((0.0, 0.0, 1.0), 0.5, 0.0), (1.0, 0.0, 0.0), atol=1e-12)
    np.testing.assert_allclose(turned((0.0, 0.0, 1.0), 0.0, 0.5), (0.0, 1.0, 0.0), atol=1e-12)


def test_a_light_of_either_frame_is_seen_and_kept():
    camera = Camera((5.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    world = Directional((1.0, 0.0, 0.0))
    np.testing.assert_allclose(seen_by(world, camera), (0.0, 0.0, 1.0), atol=1e-12)
    np.testing.assert_allclose(kept_in(world, (0.0, 0.0, 1.0), camera), (1, 0, 0), atol=1e-12)


def test_lights_are_added_doubled_and_removed(qtbot, window, panel):
    _add(qtbot, panel, "Point")
    lights = window.controller.session.lights
    assert isinstance(lights[2], Point) and panel.list.currentRow() == 2
    click(panel.duplicate)
    assert window.controller.session.lights[3] == lights[2]
    click(panel.remove)
    click(panel.remove)
    assert window.controller.session.lights == lights[:2]
    for _ in range(2):
        click(panel.remove)
    assert window.controller.session.lights == () and not panel.remove.isEnabled()
    undo(qtbot, window)
    assert len(window.controller.session.lights) == 1
    settled(qtbot, window)


def test_another_kind_is_as_bright_from_the_same_side(qtbot, window, panel):
    camera = window.canvas.camera
    first = window.controller.session.lights[0]
    world = kept_in(Directional(first.direction), first.direction, camera)
    choose(qtbot, panel.form.kind, panel.form.kind.itemText(panel.form.kind.findData("cone")))
    cone = window.controller.session.lights[0]
    assert isinstance(cone, Cone)
    back = np.subtract(cone.position, camera.target)
    away = np.linalg.norm(back)
    np.testing.assert_allclose(back / away, world / np.linalg.norm(world), atol=1e-9)
    np.testing.assert_allclose(np.divide(cone.intensity, away**2), first.irradiance, rtol=1e-9)
    assert panel.form.angle.isVisible() and not panel.form.frame.isVisible()
    settled(qtbot, window)


def test_a_dot_is_dragged_on_the_ball_in_one_step(qtbot, window, panel):
    ball, second = panel.ball, window.controller.session.lights[1]
    start = at(ball, second.direction)
    QTest.mousePress(ball, Qt.MouseButton.LeftButton, pos=start)
    assert panel.list.currentRow() == 1
    middle = QPoint(ball.width() // 2, ball.height() // 2)
    for share in (0.25, 0.5, 0.75, 1.0):
        move(qtbot, ball, start + (middle - start) * share)
        qtbot.wait(5)
    QTest.mouseRelease(ball, Qt.MouseButton.LeftButton, pos=middle)
    moved = window.controller.session.lights[1]
    # Half a pixel of the ball's radius.
    np.testing.assert_allclose(moved.direction, (0.0, 0.0, 1.0), atol=0.03)
    undo(qtbot, window)
    assert window.controller.session.lights[1] == second
    settled(qtbot, window)


def test_arrow_keys_turn_the_chosen_light(qtbot, window, panel):
    first = panel.list.visualItemRect(panel.list.item(0)).center()
    qtbot.mouseClick(panel.list.viewport(), Qt.MouseButton.LeftButton, pos=first)
    before = np.asarray(window.controller.session.lights[0].direction)
    panel.ball.setFocus()
    QTest.keyClick(panel.ball, Qt.Key.Key_Left)
    after = np.asarray(window.controller.session.lights[0].direction)
    assert after[0] < before[0]


def test_colour_and_strength_are_apart(qtbot, window, panel):
    before = pixels(window).astype(int)
    with colored("#ff0000"):
        click(panel.form.color)
    settled(qtbot, window)
    assert window.controller.session.lights[0].irradiance == (1.0, 0.0, 0.0)
    type_in(qtbot, panel.form.strength.number, "2")
    settled(qtbot, window)
    assert window.controller.session.lights[0].irradiance == (2.0, 0.0, 0.0)
    # The one that is lit by it alone has lost all green.
    mesh = (before != before[2, 2]).any(axis=2)
    after = pixels(window).astype(int)
    assert np.median(after[mesh][:, 1]) < 0.7 * np.median(before[mesh][:, 1])


def test_a_cone_is_narrowed_and_moved_by_what_is_typed(qtbot, window, panel):
    _add(qtbot, panel, "Cone")
    settled(qtbot, window)
    type_in(qtbot, panel.form.angle.number, "25")
    for number, text in zip(panel.form.position.numbers, ("10", "20", "90"), strict=True):
        type_in(qtbot, number, text)
    settled(qtbot, window)
    cone = window.controller.session.lights[2]
    assert isinstance(cone, Cone)
    assert cone.angle == 25.0
    assert cone.position == (10.0, 20.0, 90.0)


def test_a_light_fixed_in_the_world_comes_from_where_it_came(qtbot, window, panel):
    before = window.controller.session.lights[0]
    seen = np.asarray(before.direction) / np.linalg.norm(before.direction)
    rgb = window.controller.outcome.composition.panels[0].content.rgb
    choose(qtbot, panel.form.frame, panel.form.frame.itemText(panel.form.frame.findData("world")))
    settled(qtbot, window)
    light = window.controller.session.lights[0]
    assert light.frame == "world"
    now = np.asarray(seen_by(light, window.canvas.camera))
    np.testing.assert_allclose(now / np.linalg.norm(now), seen, atol=1e-9)
    # Rounding of the direction may move a value over the edge of a byte.
    new = window.controller.outcome.composition.panels[0].content.rgb
    assert np.abs(new.astype(int) - rgb).max() <= 1


def test_no_direction_is_refused_with_a_word(qtbot, window, panel):
    before = window.controller.session.lights[0]
    said = []
    window.controller.failed.connect(said.append)
    panel.form.direction.changed.emit((0.0, 0.0, 0.0))
    assert window.controller.session.lights[0] == before and "direction" in said[0]
