"""The curvature dock: every control changes the session, and follows it."""

import numpy as np
import pytest
from qtpy.QtCore import QPoint, Qt
from qtpy.QtTest import QTest

from app.gui.form import ParameterForm
from app.session import Method, Session
from lutcore.estimation import estimator_registry
from tests.app.gui.conftest import pixels, settled
from tests.app.gui.mouse import move


@pytest.fixture
def window(open_window):
    return open_window(
        Session(mesh="sample:torus", view="curvature", estimator=Method("rusinkiewicz2004"))
    )


@pytest.fixture
def panel(window, qtbot):
    dock = window.docks["curvature"]
    dock.show()
    dock.raise_()
    qtbot.waitUntil(lambda: dock.content is not None and dock.content.isVisible())
    settled(qtbot, window)
    qtbot.waitUntil(lambda: dock.content._found is not None)
    return dock.content


def _choose(qtbot, box, text: str) -> None:
    """Choose from a combo box by its keys."""
    box.setFocus()
    index = box.findText(text, Qt.MatchFlag.MatchStartsWith)
    assert index >= 0
    step = Qt.Key.Key_Down if index > box.currentIndex() else Qt.Key.Key_Up
    for _ in range(abs(index - box.currentIndex())):
        qtbot.keyClick(box, step)


def _tick(qtbot, box) -> None:
    """Click a check box where its square is: beyond its words it is no part of it."""
    qtbot.mouseClick(box, Qt.MouseButton.LeftButton, pos=QPoint(8, box.height() // 2))


def test_a_quantity_is_chosen_and_undone(window, panel, qtbot) -> None:
    before = pixels(window)
    _choose(qtbot, panel.quantity, "Gauss")
    settled(qtbot, window)
    assert window.controller.session.quantity == "gauss"
    assert (pixels(window) != before).any()
    assert panel._found.quantity.power == 2
    while window.controller.document.undo_label:
        window.controller.document.undo()
    settled(qtbot, window)
    assert panel.quantity.currentData() == "curvedness"


def test_choosing_a_quantity_leaves_the_shading(window, panel, qtbot) -> None:
    window.controller.change("view", view="shade")
    settled(qtbot, window)
    _choose(qtbot, panel.quantity, "curvature k1")
    assert window.controller.session.view == "curvature"


def test_disagreement_asks_several_estimators(window, panel, qtbot) -> None:
    window.act(window.actions_["curvature.show_disagreement"])
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
    window.controller.document.undo()
    window.controller.document.undo()
    assert window.controller.session.range is None
    assert window.controller.document.undo_label is None


def test_the_ends_are_typed(window, panel, qtbot) -> None:
    high = panel.range.high
    high.setFocus()
    high.selectAll()
    qtbot.keyClicks(high, "0.5")
    qtbot.keyClick(high, Qt.Key.Key_Return)
    settled(qtbot, window)
    assert window.controller.session.range[1] == 0.5
    assert panel.range.bar.ends[1] == 0.5


def test_a_symmetric_range_moves_both_ends(window, panel, qtbot) -> None:
    _choose(qtbot, panel.quantity, "mean")
    _tick(qtbot, panel.switches["symmetric"])
    settled(qtbot, window)
    low, high = panel.range.bar.ends
    assert low == -high
    panel.range.high.setValue(0.3)
    settled(qtbot, window)
    assert window.controller.session.range == (-0.3, 0.3)


def test_percentiles_are_chosen(window, panel, qtbot) -> None:
    low, high = panel.range.bar.ends
    _choose(qtbot, panel.range.percentiles, "0 to 100")
    settled(qtbot, window)
    assert window.controller.session.percentiles == (0.0, 100.0)
    assert panel.range.bar.ends[0] <= low
    assert panel.range.bar.ends[1] > high


def test_a_locked_range_stays_for_another_mesh(window, panel, qtbot) -> None:
    ends = panel.range.bar.ends
    window.controller.open("sample:sphere")
    settled(qtbot, window)
    assert window.controller.session.range is None
    window.controller.document.undo()
    settled(qtbot, window)
    _tick(qtbot, panel.range.lock)
    settled(qtbot, window)
    window.controller.open("sample:sphere")
    settled(qtbot, window)
    assert window.controller.session.mesh == "sample:sphere"
    assert window.controller.outcome.composition.ranges["curvedness"] == ends
    # Of another unit it is no range any more.
    window.act(window.actions_["curvature.show_gauss"])
    assert window.controller.session.range is None
    assert not window.controller.range_locked


def test_switches_menu_and_session_agree(window, panel, qtbot) -> None:
    for name, switch in panel.switches.items():
        before = pixels(window)
        _tick(qtbot, switch)
        settled(qtbot, window)
        assert getattr(window.controller.session, name)
        assert window.qactions[f"curvature.{name}"].isChecked()
        if name != "fade":  # a torus this exact has nothing to fade
            assert (pixels(window) != before).any(), name
        window.act(window.actions_[f"curvature.{name}"])
        settled(qtbot, window)
        assert not switch.isChecked()
        np.testing.assert_array_equal(pixels(window), before)


def test_estimator_parameters_and_scale(window, panel, qtbot) -> None:
    _choose(qtbot, panel.estimator.names, "auto")
    settled(qtbot, window)
    assert window.controller.session.estimator == Method("auto")
    form = panel.estimator.form
    form.controls["steadiness"].number.setValue(5.0)
    settled(qtbot, window)
    assert window.controller.session.estimator == Method("auto", {"steadiness": 5.0})
    qtbot.mouseClick(form.reset, Qt.MouseButton.LeftButton)
    assert window.controller.session.estimator == Method("auto")
    window.controller.change("unit", mm_per_unit=10.0)
    settled(qtbot, window)
    _tick(qtbot, panel.scale.auto)
    panel.scale.slider.number.setValue(8.0)
    settled(qtbot, window)
    # Shown in millimetres, kept in mesh units.
    assert window.controller.session.scale == pytest.approx(0.8)
    # And what was measured with is what the automatic scale's slider showed.
    assert panel.scale._median == pytest.approx(0.8)


def test_colour_maps_follow_the_session(window, panel, qtbot) -> None:
    _choose(qtbot, panel.colormap, "cividis")
    assert window.controller.session.colormap == "cividis"
    window.controller.change("colour map", colormap="Spectral")
    assert panel.colormap.currentText() == "Spectral"
    window.controller.change("another", colormap="twilight", percentiles=(2.0, 98.0))
    assert panel.colormap.currentText() == "twilight"
    window.controller.change("more", percentiles=(3.0, 97.0))
    assert panel.range.percentiles.currentText() == "3 to 97 %"
    _choose(qtbot, panel.colormap, "green to red")
    assert window.controller.session.colormap is None


def test_with_all_quantities_there_is_no_one_range(window, panel, qtbot) -> None:
    panel.range.high.setValue(0.4)
    settled(qtbot, window)
    window.act(window.actions_["curvature.show_all"])
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
