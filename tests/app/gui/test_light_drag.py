"""Lights dragged in the view, by their handles and with a key held."""

import numpy as np
import pytest
from qtpy.QtCore import QPoint, Qt
from qtpy.QtTest import QTest
from qtpy.QtWidgets import QStyle, QStyleOptionSlider

from app import costs
from app.gui.aiming import place_of
from app.gui.light_handles import anchor
from app.gui.lights import Lights
from app.picture import compose
from app.pipeline import Pipeline
from app.session import Method, read
from app.settling import model_of
from lutcore.choice import choose
from lutcore.costs import COLORS, PREDICTION, Cost, candidates, forget, remember
from tests.app.gui.conftest import pixels, settled
from tests.app.gui.hands import click_tab, undo
from tests.app.gui.mouse import move

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def view(qtbot, window):
    click_tab(qtbot, window, "Lights")
    content = window.docks["lights"].fill()
    settled(qtbot, window)
    qtbot.waitUntil(content.isVisible)
    return window


def handle(window, index) -> QPoint:
    canvas = window.canvas
    right, up = place_of(canvas.camera, anchor(window.lights.all[index], canvas.camera))
    left, bottom = canvas.drawn[0].renderer.GetOrigin()
    width, height = canvas.drawn[0].renderer.GetSize()
    x, y = left + width / 2 + right * height, bottom + height / 2 + up * height
    return QPoint(round(x), round(canvas.height() - 1 - y))


def drag(qtbot, canvas, start, step, keys=Qt.KeyboardModifier.NoModifier, moves=4):
    QTest.mousePress(canvas, LEFT, keys, start)
    for nth in range(1, moves + 1):
        move(qtbot, canvas, start + step * nth)
        qtbot.wait(15)
    QTest.mouseRelease(canvas, LEFT, keys, start + step * moves)


def test_a_handle_follows_the_mouse_and_the_camera_stays(qtbot, view):
    camera, second = view.canvas.camera, view.lights.all[1]
    start = handle(view, 0)
    drag(qtbot, view.canvas, start, QPoint(-15, 10))
    settled(qtbot, view)
    assert view.canvas.camera == camera and view.lights.all[1] == second
    end = handle(view, 0)
    assert abs(end.x() - start.x() + 60) <= 2 and abs(end.y() - start.y() - 40) <= 2


def test_exposure_stands_still_in_a_drag_and_is_the_command_lines_after_it(qtbot, view):
    exposures = []
    view.controller.shown.connect(lambda made: exposures.append(made.composition.exposure))
    before = view.controller.outcome.composition.exposure
    start = handle(view, 0)
    QTest.mousePress(view.canvas, LEFT, pos=start)
    for nth in range(1, 5):
        move(qtbot, view.canvas, start + QPoint(-20, 5) * nth)
        settled(qtbot, view)
    assert len(exposures) >= 2 and set(exposures) == {before}
    QTest.mouseRelease(view.canvas, LEFT, pos=start + QPoint(-80, 20))
    settled(qtbot, view)
    outcome = view.controller.outcome
    made = compose(outcome.session, Pipeline())
    assert outcome.composition.exposure == made.exposure != before
    np.testing.assert_array_equal(
        made.panels[0].content.rgb, outcome.composition.panels[0].content.rgb
    )


def test_colours_are_nearly_right_in_a_drag_and_exact_after_it(qtbot, view):
    view.controller.change("exposure", exposure=1.0)
    settled(qtbot, view)
    start = handle(view, 0)
    QTest.mousePress(view.canvas, LEFT, pos=start)
    move(qtbot, view.canvas, start + QPoint(-20, 5))
    settled(qtbot, view)
    exact, shown = _colours(view)
    assert 0 < np.abs(exact - shown).max() <= 1
    QTest.mouseRelease(view.canvas, LEFT, pos=start + QPoint(-20, 5))
    settled(qtbot, view)
    exact, shown = _colours(view)
    np.testing.assert_array_equal(exact, shown)


def _colours(view):
    outcome = view.controller.outcome
    made = compose(outcome.session, Pipeline()), outcome.composition
    return [one.panels[0].content.rgb.astype(int) for one in made]


def test_a_material_that_is_dragged_is_shaded_exactly(qtbot, view):
    click_tab(qtbot, view, "Shading")
    slider = view.docks["shading"].fill().material.scattering[0].slider
    settled(qtbot, view)
    option = QStyleOptionSlider()
    slider.initStyleOption(option)
    part = QStyle.SubControl.SC_SliderHandle
    grip = slider.style().subControlRect(QStyle.ComplexControl.CC_Slider, option, part, slider)
    QTest.mousePress(slider, LEFT, pos=grip.center())
    move(qtbot, slider, grip.center() + QPoint(15, 0))
    settled(qtbot, view)
    assert view.controller.outcome.session.material.scattering[0] > 0.74
    held = view.controller.outcome.composition.exposure
    made = compose(view.controller.outcome.session, Pipeline(), held)
    np.testing.assert_array_equal(made.panels[0].content.rgb, _colours(view)[1])
    QTest.mouseRelease(slider, LEFT, pos=grip.center() + QPoint(15, 0))
    settled(qtbot, view)
    undo(qtbot, view)
    assert view.controller.session.material == "skin1"


def test_a_drag_is_one_step_however_long_it_takes(qtbot, view, monkeypatch):
    monkeypatch.setattr("app.gui.document._ONE_STEP", 0.0)
    before = view.controller.session.lights
    drag(qtbot, view.canvas, handle(view, 0), QPoint(-15, 0))
    drag(qtbot, view.canvas, handle(view, 0), QPoint(-5, 5))
    undo(qtbot, view)
    middle = view.controller.session.lights
    undo(qtbot, view)
    assert view.controller.session.lights == before != middle
    settled(qtbot, view)


def test_alt_or_l_turns_the_chosen_light(qtbot, view):
    camera = view.canvas.camera
    x, y, _ = view.lights.all[0].direction
    spot = QPoint(view.canvas.width() // 2, view.canvas.height() // 2)
    drag(qtbot, view.canvas, spot, QPoint(-10, 0), Qt.KeyboardModifier.AltModifier)
    turned = view.lights.all[0].direction
    assert turned[0] < x and turned[1] == pytest.approx(y)
    view.canvas.setFocus()
    QTest.keyPress(view.canvas, Qt.Key.Key_L)
    drag(qtbot, view.canvas, spot, QPoint(0, -10))
    QTest.keyRelease(view.canvas, Qt.Key.Key_L)
    assert view.lights.all[0].direction[1] > turned[1]
    assert view.canvas.camera == camera
    drag(qtbot, view.canvas, spot, QPoint(0, -10))
    assert view.canvas.camera != camera
    settled(qtbot, view)


def test_a_point_light_is_moved_across_the_view(qtbot, view):
    view.lights.add("point")
    settled(qtbot, view)
    start = handle(view, 2)
    drag(qtbot, view.canvas, start, QPoint(10, 10))
    settled(qtbot, view)
    end = handle(view, 2)
    assert abs(end.x() - start.x() - 40) <= 2 and abs(end.y() - start.y() - 40) <= 2


def test_handles_are_seen_only_with_the_dock_and_never_saved(qtbot, view):
    shown = pixels(view)
    view.docks["lights"].setVisible(False)
    qtbot.waitUntil(lambda: not view.light_tool.handles.shown)
    bare = pixels(view)
    at = handle(view, 0)
    patch = np.s_[at.y() - 4 : at.y() + 5, at.x() - 4 : at.x() + 5]
    assert (shown[patch] != bare[patch]).any()
    from app.render import draw

    outcome = view.controller.outcome
    height, width = bare.shape[:2]
    made = outcome.composition
    saved = draw(made.panels, (width, height), outcome.session.background, made.rows).image
    # Rounding of a colour between vertices may differ with multisampling.
    assert np.abs(saved[patch].astype(int) - bare[patch]).max() <= 2
    assert np.abs(saved[patch].astype(int) - shown[patch]).max() > 50


def test_handles_go_when_another_tab_covers_the_dock(qtbot, view):
    at = handle(view, 0)
    patch = np.s_[at.y() - 4 : at.y() + 5, at.x() - 4 : at.x() + 5]
    shown = pixels(view)[patch]
    click_tab(qtbot, view, "Shading")
    qtbot.waitUntil(lambda: not view.light_tool.handles.shown)
    assert (pixels(view)[patch] != shown).any()
    click_tab(qtbot, view, "Lights")
    qtbot.waitUntil(lambda: view.light_tool.handles.shown)
    np.testing.assert_array_equal(pixels(view)[patch], shown)


def test_the_chosen_light_survives_that_others_go(window):
    lights = Lights(window.controller, lambda: window.canvas.camera)
    lights.choose(1)
    window.controller.change("lights", lights=lights.all[:1])
    assert lights.index == 0 and lights.light == window.controller.session.lights[0]


def test_auto_keeps_its_model_in_a_drag_and_chooses_anew_after_it(
    qtbot, view, monkeypatch, tmp_path
):
    monkeypatch.setattr(costs, "place", lambda: tmp_path / "costs.json")
    known = {one.label: Cost(10.0 + n, one.model.growth) for n, one in enumerate(candidates())}
    remember(known | {PREDICTION: Cost(5.0, "n"), COLORS: Cost(5.0, "n")})
    chosen = []

    def counted(*arguments, **named):
        chosen.append(choose(*arguments, **named))
        return chosen[-1]

    monkeypatch.setattr("plugins.shading.auto.choose", counted)
    view.controller.change("model", model=Method("auto", {"tolerance": 0.1}))
    settled(qtbot, view)
    assert len(chosen) == 1
    before = view.controller.outcome.settled
    start = handle(view, 0)
    QTest.mousePress(view.canvas, LEFT, pos=start)
    for nth in range(1, 4):
        move(qtbot, view.canvas, start + QPoint(-20, 5) * nth)
        settled(qtbot, view)
        assert view.controller.outcome.settled == before
        assert view.controller.session.model.name == "auto"
    assert len(chosen) == 1
    QTest.mouseRelease(view.canvas, LEFT, pos=start + QPoint(-60, 15))
    settled(qtbot, view)
    assert len(chosen) == 2
    after = view.controller.outcome.settled
    assert after[0].scene != before[0].scene
    assert model_of(after[0]) == chosen[-1].model
    # A session that is saved keeps it.
    view.controller.save(tmp_path / "s.json")
    assert read(tmp_path / "s.json").settled == after
    forget()
