"""The curvature dock: every control changes the session, and follows it."""

from typing import get_args

import numpy as np
import pytest
from qtpy.QtCore import QPoint, Qt
from qtpy.QtTest import QTest

from app.gui.form import ParameterForm
from app.gui.showing import SWITCHES
from app.session import Method, Quantity, Session
from lutcore.estimation import estimator_registry
from tests.app.gui.conftest import pixels, settled
from tests.app.gui.hands import choose, click_menu, click_tab, tick, type_in
from tests.app.gui.mouse import move


@pytest.fixture
def window(open_window):
    return open_window(
        Session(mesh="sample:torus", view="curvature", estimator=Method("rusinkiewicz2004"))
    )


@pytest.fixture
def panel(window, qtbot):
    dock = window.docks["curvature"]
    click_tab(qtbot, window, "Curvature")
    qtbot.waitUntil(lambda: dock.content is not None and dock.content.isVisible())
    settled(qtbot, window)
    qtbot.waitUntil(lambda: dock.content._found is not None)
    return dock.content


def test_a_quantity_is_chosen_and_undone(window, panel, qtbot) -> None:
    before = pixels(window)
    choose(qtbot, panel.quantity, "Gauss")
    settled(qtbot, window)
    assert window.controller.session.quantity == "gauss"
    assert (pixels(window) != before).any()
    assert panel._found.quantity.power == 2
    while window.controller.document.undo_label:
        qtbot.keyClick(window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    settled(qtbot, window)
    assert panel.quantity.currentData() == "curvedness"


def test_every_quantity_is_shown_in_its_own_range(window, panel, qtbot) -> None:
    seen = []
    while panel.quantity.currentIndex() > 0:
        qtbot.keyClick(panel.quantity, Qt.Key.Key_Up)
    for index in range(panel.quantity.count()):
        settled(qtbot, window)
        name = panel.quantity.currentData()
        assert window.controller.outcome.session.quantity == name
        ranges = window.controller.outcome.composition.ranges
        if name != "all":
            assert list(ranges) == [name]
            assert panel.range.bar.ends == ranges[name]
            low, high = panel.range.low.value(), panel.range.high.value()
            assert (low, high) == pytest.approx(ranges[name], rel=1e-3)
        seen.append((name, pixels(window).tobytes()))
        if index < panel.quantity.count() - 1:
            qtbot.keyClick(panel.quantity, Qt.Key.Key_Down)
    assert {name for name, _ in seen} == set(get_args(Quantity))
    assert len({picture for _, picture in seen}) == len(seen)


def test_choosing_a_quantity_leaves_the_shading(window, panel, qtbot) -> None:
    qtbot.keyClick(window, Qt.Key.Key_F2)
    settled(qtbot, window)
    assert window.controller.outcome.session.view == "shade"
    choose(qtbot, panel.quantity, "curvature k1")
    assert window.controller.session.view == "curvature"


def test_disagreement_asks_several_estimators(window, panel, qtbot) -> None:
    click_menu(qtbot, window, "Curvature", "Quantity", "Disagreement")
    settled(qtbot, window)
    assert len(window.controller.session.peers) == 3
    assert "disagreement" in window.controller.outcome.composition.ranges
    assert panel.peers.isVisible()


def test_the_range_is_dragged_as_one_step_and_made_automatic_again(window, panel, qtbot) -> None:
    bar, before = panel.range.bar, pixels(window)
    automatic = window.controller.outcome.composition.ranges["curvedness"]
    assert bar.ends == automatic
    x = round(bar.x_of(bar.ends[1]))
    qtbot.mousePress(bar, Qt.MouseButton.LeftButton, pos=QPoint(x, 20))
    for step in (10, 20, 30):
        move(qtbot, bar, QPoint(x - step, 20))
        qtbot.wait(10)
    qtbot.mouseRelease(bar, Qt.MouseButton.LeftButton, pos=QPoint(x - 30, 20))
    settled(qtbot, window)
    session = window.controller.session
    assert session.range == (automatic[0], pytest.approx(bar.ends[1]))
    assert session.range[1] < automatic[1]
    assert panel.range.high.value() == pytest.approx(session.range[1])
    assert (pixels(window) != before).any()
    qtbot.mouseDClick(bar, Qt.MouseButton.LeftButton, pos=QPoint(10, 20))
    settled(qtbot, window)
    assert window.controller.session.range is None
    np.testing.assert_array_equal(pixels(window), before)
    for _ in range(2):
        qtbot.keyClick(window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert window.controller.session.range is None
    assert window.controller.document.undo_label is None


def test_the_ends_are_typed(window, panel, qtbot) -> None:
    type_in(qtbot, panel.range.high, "0.5")
    settled(qtbot, window)
    assert window.controller.session.range[1] == 0.5
    assert panel.range.bar.ends[1] == 0.5


def test_a_symmetric_range_moves_both_ends(window, panel, qtbot) -> None:
    choose(qtbot, panel.quantity, "mean")
    tick(qtbot, panel.switches["symmetric"])
    settled(qtbot, window)
    low, high = panel.range.bar.ends
    assert low == -high
    type_in(qtbot, panel.range.high, "0.3")
    settled(qtbot, window)
    assert window.controller.session.range == (-0.3, 0.3)


def test_percentiles_are_chosen(window, panel, qtbot) -> None:
    low, high = panel.range.bar.ends
    choose(qtbot, panel.range.percentiles, "0 to 100")
    settled(qtbot, window)
    assert window.controller.session.percentiles == (0.0, 100.0)
    assert panel.range.bar.ends[0] <= low
    assert panel.range.bar.ends[1] > high


def test_a_locked_range_stays_for_another_mesh(window, panel, qtbot) -> None:
    ends = panel.range.bar.ends
    click_menu(qtbot, window, "File", "Sample meshes", "sphere")
    settled(qtbot, window)
    assert window.controller.session.range is None
    qtbot.keyClick(window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    settled(qtbot, window)
    tick(qtbot, panel.range.lock)
    settled(qtbot, window)
    click_menu(qtbot, window, "File", "Sample meshes", "sphere")
    settled(qtbot, window)
    assert window.controller.session.mesh == "sample:sphere"
    assert window.controller.outcome.composition.ranges["curvedness"] == ends
    # Of another unit it is no range any more.
    choose(qtbot, panel.quantity, "Gauss")
    assert window.controller.session.range is None
    assert not window.controller.range_locked


def test_switches_menu_and_session_agree(window, panel, qtbot) -> None:
    for name, switch in panel.switches.items():
        before = pixels(window)
        tick(qtbot, switch)
        settled(qtbot, window)
        assert getattr(window.controller.session, name)
        assert window.qactions[f"curvature.{name}"].isChecked()
        if name != "fade":  # a torus this exact has nothing to fade; see below
            assert (pixels(window) != before).any(), name
        click_menu(qtbot, window, "Curvature", SWITCHES[name][0])
        settled(qtbot, window)
        assert not switch.isChecked()
        np.testing.assert_array_equal(pixels(window), before)


def test_what_is_below_its_error_fades_to_grey(open_window, qtbot) -> None:
    estimator = Method("rusinkiewicz2004")
    window = open_window(Session(mesh="sample:bunny", view="curvature", estimator=estimator))
    panel = window.docks["curvature"].fill()
    click_tab(qtbot, window, "Curvature")
    settled(qtbot, window)
    before = pixels(window).astype(int)
    tick(qtbot, panel.switches["fade"])
    settled(qtbot, window)
    after = pixels(window).astype(int)
    changed = np.abs(after - before).max(axis=2) > 20
    assert changed.mean() > 0.001
    vivid = np.ptp(before, axis=2)[changed].mean()
    assert np.ptp(after, axis=2)[changed].mean() < 0.5 * vivid
    tick(qtbot, panel.switches["fade"])
    settled(qtbot, window)
    np.testing.assert_array_equal(pixels(window), before)


def test_estimator_parameters_and_scale(window, panel, qtbot) -> None:
    choose(qtbot, panel.estimator.names, "auto")
    settled(qtbot, window)
    assert window.controller.session.estimator == Method("auto")
    form = panel.estimator.form
    type_in(qtbot, form.controls["steadiness"].number, "5")
    settled(qtbot, window)
    assert window.controller.session.estimator == Method("auto", {"steadiness": 5.0})
    qtbot.mouseClick(form.reset, Qt.MouseButton.LeftButton)
    assert window.controller.session.estimator == Method("auto")
    window.controller.change("unit", mm_per_unit=10.0)
    settled(qtbot, window)
    automatic = pixels(window)
    tick(qtbot, panel.scale.auto)
    type_in(qtbot, panel.scale.slider.number, "8")
    settled(qtbot, window)
    # Shown in millimetres, kept in mesh units; the longer the flatter.
    assert window.controller.session.scale == pytest.approx(0.8)
    assert (pixels(window) != automatic).any()
    tick(qtbot, panel.scale.auto)
    settled(qtbot, window)
    assert window.controller.session.scale is None
    np.testing.assert_array_equal(pixels(window), automatic)
    # The slider stands where the automatic scale is.
    assert 0.0 < panel.scale.slider.value < 8.0


def test_colour_maps_follow_the_session(window, panel, qtbot) -> None:
    choose(qtbot, panel.colormap, "cividis")
    assert window.controller.session.colormap == "cividis"
    window.controller.change("colour map", colormap="Spectral")
    assert panel.colormap.currentText() == "Spectral"
    window.controller.change("another", colormap="twilight", percentiles=(2.0, 98.0))
    assert panel.colormap.currentText() == "twilight"
    window.controller.change("more", percentiles=(3.0, 97.0))
    assert panel.range.percentiles.currentText() == "3 to 97 %"
    choose(qtbot, panel.colormap, "green to red")
    assert window.controller.session.colormap is None


def test_with_all_quantities_there_is_no_one_range(window, panel, qtbot) -> None:
    type_in(qtbot, panel.range.high, "0.4")
    settled(qtbot, window)
    click_menu(qtbot, window, "Curvature", "Quantity", "All")
    settled(qtbot, window)
    assert len(window.controller.outcome.composition.ranges) == 8
    assert not window.banner.isVisible()
    assert not panel.range.low.isEnabled()


def test_a_form_shows_every_estimator(qtbot) -> None:
    QTest.qWait(1)
    for name in estimator_registry.names():
        told: list[dict] = []
        plugin = estimator_registry.get(name)
        form = ParameterForm(plugin, {}, told.append)
        qtbot.addWidget(form)
        assert form.values == {}
        assert told == []
        for control in form.controls.values():
            assert control.accessibleName()
            assert control.toolTip()
