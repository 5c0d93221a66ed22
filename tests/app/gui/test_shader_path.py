"""Shading at pixels in the window: what chooses it, what moves it, what the status bar says."""

import threading

import numpy as np
import pytest
from qtpy.QtCore import QPoint, Qt
from qtpy.QtTest import QTest

from app.gui.coarse import coarse
from app.gui.status import Status
from app.session import Camera, Session
from tests.app.gui.conftest import pixels, settled
from tests.app.gui.hands import choose, click_menu
from tests.app.gui.mouse import move

LEFT = Qt.MouseButton.LeftButton


def _says(window) -> str:
    pixels(window)
    window.canvas.drew.emit(0.01)
    return window.findChild(Status).text().partition(",")[0]


def _by_pixel(qtbot, window) -> None:
    click_menu(qtbot, window, "View", "Compute shading", "At pixels")
    qtbot.waitUntil(lambda: window.canvas.by_pixel is not None)
    settled(qtbot, window)


def _drag(qtbot, canvas, keys, during) -> None:
    QTest.mousePress(canvas, LEFT, keys, QPoint(300, 300))
    for step in range(1, 5):
        move(qtbot, canvas, QPoint(300 + 15 * step, 300))
        qtbot.wait(10)
    during()
    QTest.mouseRelease(canvas, LEFT, keys, QPoint(360, 300))


def _alike(window, other) -> bool:
    # The sample's triangles are larger than pixels: at the rim, where the exit Fresnel factor falls
    # to 0 within one of them, the ways differ by far more than a byte, elsewhere by none or one.
    mesh = (other != other[2, 2]).any(axis=2)
    return np.median(np.abs(pixels(window).astype(int) - other)[mesh]) <= 1


def test_the_menu_chooses_and_the_status_bar_says(window, qtbot) -> None:
    vertex = pixels(window).astype(int)
    assert _says(window) == "per vertex"
    assert "chosen" in window.findChild(Status).toolTip()
    _by_pixel(qtbot, window)
    assert _says(window) == "per pixel"
    assert window.qactions["view.shade_pixel"].isChecked()
    assert _alike(window, vertex) and (pixels(window) != vertex).any()
    click_menu(qtbot, window, "View", "Compute shading", "At vertices")
    assert _says(window) == "per vertex"
    np.testing.assert_array_equal(pixels(window), vertex)
    assert window.settings.get("shading path", "") == "vertex"


@pytest.mark.parametrize("what", ["camera", "light"])
def test_a_drag_computes_nothing_until_it_rests(window, qtbot, what) -> None:
    _by_pixel(qtbot, window)
    shown, before, during = [], pixels(window).astype(int), []
    window.controller.shown.connect(shown.append)
    keys = Qt.KeyboardModifier.AltModifier if what == "light" else Qt.KeyboardModifier.NoModifier

    def look() -> None:
        during.append(pixels(window).astype(int))
        assert not shown

    _drag(qtbot, window.canvas, keys, look)
    assert np.abs(during[0] - before).max() > 10
    qtbot.waitUntil(lambda: len(shown) > 0)
    settled(qtbot, window)
    session = window.controller.session
    assert shown[-1].session.lights == session.lights
    if what == "camera":
        assert isinstance(session.camera, Camera)
        assert shown[-1].session.camera == session.camera
    # The same lights and camera, once more at vertices.
    pixel = pixels(window)
    click_menu(qtbot, window, "View", "Compute shading", "At vertices")
    assert _alike(window, pixel.astype(int))


def test_what_has_no_shader_is_shaded_at_vertices_with_the_reason(window, qtbot) -> None:
    _by_pixel(qtbot, window)
    names = window.docks["shading"].fill().model.names
    choose(qtbot, names, "wrap")
    settled(qtbot, window)
    assert _says(window) == "per vertex"
    assert "wrap" in window.findChild(Status).toolTip()
    choose(qtbot, names, "lambert")
    settled(qtbot, window)
    assert _says(window) == "per pixel"
    qtbot.keyClick(window, Qt.Key.Key_F4)
    settled(qtbot, window)
    assert _says(window) == "per pixel"


@pytest.mark.parametrize(("seconds", "way"), [(1e3, "per pixel"), (-1e3, "per vertex")])
def test_the_faster_way_is_chosen(open_window, qtbot, monkeypatch, seconds, way) -> None:
    """Frames are measured; what computing takes is given, so that one or the other wins."""
    monkeypatch.setattr("app.gui.pixel_path.step_seconds", lambda *_: seconds)
    monkeypatch.setattr("app.gui.pixel_race._LONG", 1e3)  # however slow it draws here
    window = open_window(Session(mesh="sample:sphere"), path="automatic")
    path = window.pixel_path

    def raced() -> bool:  # it may have begun, and ended, before anybody looks
        found = path.reason != "" if way == "per vertex" else window.canvas.by_pixel is not None
        return found and not path.racing

    qtbot.waitUntil(raced)
    settled(qtbot, window)
    assert _says(window) == way
    assert (path.reason != "") == (way == "per vertex")


def test_a_frame_that_is_slow_by_chance_does_not_decide(open_window, qtbot, monkeypatch) -> None:
    window = open_window(Session(mesh="sample:sphere"))
    canvas, again = window.canvas, []
    monkeypatch.setattr(canvas, "repaint", lambda: again.append(canvas.draw()))
    fast = property(lambda _: 0.7 if len(again) < 2 else 0.01)
    monkeypatch.setattr(type(canvas), "seconds", fast)
    monkeypatch.setattr("app.gui.pixel_path.step_seconds", lambda *_: 1e3)
    click_menu(qtbot, window, "View", "Compute shading", "The faster way")
    path = window.pixel_path
    qtbot.waitUntil(lambda: not path.racing and (canvas.by_pixel is not None or path.reason != ""))
    assert path.reason == "" and len(again) == 2


def test_computing_is_measured(window) -> None:
    from app.gui.pixel_race import step_seconds

    made = window.controller.outcome.composition
    assert 0.0 < step_seconds(made, window.controller.pipeline) < 60.0


def test_the_first_frame_at_pixels_is_in_its_colours(window, qtbot, monkeypatch) -> None:
    """Whoever draws first after the switch, and before anything else is told, draws the picture."""
    vertex, first = pixels(window).astype(int), []
    shade = window.canvas.shade_by_pixel

    def shade_and_look(look) -> None:
        shade(look)
        if look is not None:
            first.append(pixels(window).astype(int))

    monkeypatch.setattr(window.canvas, "shade_by_pixel", shade_and_look)
    _by_pixel(qtbot, window)
    assert len(first) == 1
    mesh = (vertex != vertex[2, 2]).any(axis=2)
    assert (first[0] != vertex).any()
    assert np.median(np.abs(first[0] - vertex)[mesh]) <= 1
    np.testing.assert_array_equal(first[0], pixels(window))


@pytest.mark.parametrize("standing_in", [True, False])
def test_a_mesh_that_is_slow_to_draw_is_not_drawn_for_the_race(
    open_window, qtbot, monkeypatch, standing_in
) -> None:
    window = open_window(Session(mesh="sample:sphere"))
    canvas, visible, screens = window.canvas, [], []
    mesh = window.controller.outcome.subject.mesh
    canvas.give_coarse(coarse(mesh, 500) if standing_in else None)
    before = pixels(window)
    fine, show, draw = canvas.drawn[0].actor, canvas._stand_in.show, canvas.draw_unseen

    def screen():
        return window.screen().grabWindow(canvas.winId()).toImage()

    def shown(drawn, on) -> None:
        show(drawn, on)
        visible.append((on, fine.GetVisibility()))

    def drawn() -> None:
        draw()
        screens.append(screen())

    on_screen, whole = screen(), threading.Event()

    def no_time(*_) -> float:
        assert whole.wait(60.0)
        return -1e3

    monkeypatch.setattr(canvas._stand_in, "show", shown)
    monkeypatch.setattr(canvas, "draw_unseen", drawn)
    monkeypatch.setattr(type(canvas), "seconds", property(lambda _: 0.7))
    monkeypatch.setattr("app.gui.pixel_path.step_seconds", no_time)
    click_menu(qtbot, window, "View", "Compute shading", "The faster way")
    qtbot.waitUntil(lambda: screen() == on_screen)  # the menus lay over the view
    whole.set()
    qtbot.waitUntil(lambda: "each step" in window.pixel_path.reason, timeout=60_000)
    np.testing.assert_array_equal(pixels(window), before)
    if standing_in:
        assert visible == 6 * [(True, 0), (False, 1)]
        assert screens == 6 * [on_screen]
    else:
        assert not visible and not screens
        assert "too slow to compare" in window.pixel_path.reason
