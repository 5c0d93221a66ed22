"""The chart of this mesh, the recommendation, the map, and the table of psi."""

import numpy as np
import pytest
from qtpy.QtCore import QPoint, Qt

from app.session import Directional, Method, Session
from lutcore.costs import COLORS, PREDICTION, Cost, candidates
from tests.app.gui.conftest import pixels, settled
from tests.app.gui.hands import click_menu, tick
from tests.app.gui.mouse import move


@pytest.fixture
def measured(monkeypatch):
    """Costs as if this machine had been measured."""
    costs = {one.label: Cost(10.0 + n, one.model.growth) for n, one in enumerate(candidates())}
    costs[PREDICTION] = costs[COLORS] = Cost(5.0, "n")
    monkeypatch.setattr("app.costs.known", lambda: True)
    monkeypatch.setattr("app.choosing.measured", lambda progress, again: costs)


@pytest.fixture
def choose(window, qtbot, measured):
    """The dock."""
    click_menu(qtbot, window, "Window", "Choose")
    panel = window.docks["choose"].fill()
    qtbot.waitUntil(lambda: panel.choosing.needs is not None, timeout=300_000)
    settled(qtbot, window)
    return panel


def test_the_recommendation_is_said_and_a_click_uses_it(window, qtbot, choose) -> None:
    choice = choose.choosing.needs.choice
    assert choice.sentence[1:] in choose.sentence.text()
    assert len(choose.chart.dots) == len(choice.rungs)
    qtbot.mouseClick(choose.use, Qt.MouseButton.LeftButton)
    settled(qtbot, window)
    assert window.controller.session.model.name == choice.chosen.candidate.name
    assert any(dot.current and dot.chosen for dot in choose.chart.dots)


def test_a_click_on_a_point_uses_that_model(window, qtbot, choose) -> None:
    index = next(i for i, dot in enumerate(choose.chart.dots) if dot.label == "wrap")
    qtbot.mouseClick(
        choose.chart, Qt.MouseButton.LeftButton, pos=choose.chart.place(index).toPoint()
    )
    settled(qtbot, window)
    assert (
        window.controller.session.model.name
        == choose.choosing.needs.choice.rungs[index].candidate.name
    )
    qtbot.keyClick(window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert window.controller.session.model.name == "curvature-lut"


def test_shadows_that_are_off_and_change_much_are_told(open_window, qtbot, measured) -> None:
    window = open_window(Session(mesh="sample:torus", lights=(Directional((0.9, 0.2, 0.35)),)))
    settled(qtbot, window)
    click_menu(qtbot, window, "Window", "Choose")
    panel = window.docks["choose"].fill()
    qtbot.waitUntil(lambda: panel.choosing.needs is not None, timeout=300_000)
    told = "Cast shadows, which are off, would change"
    assert told in panel.sentence.text()
    # They are asked about anew as soon as they are cast.
    window.controller.change("shadows", shadows="auto")
    qtbot.waitUntil(lambda: told not in panel.sentence.text(), timeout=300_000)
    assert panel.choosing.needs.choice.shadowed


def test_what_was_judged_in_shadows_keeps_them(window, choose) -> None:
    controller, rung = window.controller, choose.choosing.needs.choice.rungs[0]
    controller.change("model", model=Method("auto"))
    choose.choosing.take(rung)
    assert controller.session.model.name == rung.candidate.name
    assert controller.session.shadows == "auto"
    controller.change("shadows", shadows=None)
    choose.choosing.take(rung)
    assert controller.session.shadows is None


def test_the_tolerance_moves_the_choice(window, qtbot, choose) -> None:
    first = choose.choosing.needs
    choose.slider.setFocus()
    qtbot.keyClick(choose.slider, Qt.Key.Key_End)
    qtbot.waitUntil(lambda: choose.choosing.needs is not first, timeout=240_000)
    loose = choose.choosing.needs.choice
    assert loose.tolerance.value == pytest.approx(0.3)
    adequate = [rung.adequate for rung in loose.rungs]
    assert sum(adequate) > sum(rung.adequate for rung in first.choice.rungs)


def test_the_map_colors_the_mesh_and_goes_away(window, qtbot, choose) -> None:
    before = pixels(window)
    tick(qtbot, choose.map)
    qtbot.waitUntil(lambda: choose.choosing.map is not None, timeout=240_000)
    settled(qtbot, window)
    assert choose.legend.count() == len(choose.choosing.map.labels) + 1
    assert (pixels(window) != before).any(axis=2).mean() > 0.1
    tick(qtbot, choose.map)
    settled(qtbot, window)
    np.testing.assert_array_equal(pixels(window), before)


def test_the_table_is_brushed_in_both_directions(window, qtbot) -> None:
    click_menu(qtbot, window, "Window", "Table")
    panel = window.docks["table"].fill()
    settled(qtbot, window)
    qtbot.waitUntil(lambda: panel._arguments is not None, timeout=240_000)
    before = pixels(window)
    plot, middle = panel.plot, panel.plot.height() // 2
    left = round(plot.across(0.0))
    qtbot.mousePress(plot, Qt.MouseButton.LeftButton, pos=QPoint(left, middle))
    move(qtbot, plot, QPoint(left + 40, middle))
    qtbot.mouseRelease(plot, Qt.MouseButton.LeftButton, pos=QPoint(left + 40, middle))
    settled(qtbot, window)
    low, high = plot.brush
    share = np.mean((panel._arguments[0] >= low) & (panel._arguments[0] <= high))
    assert panel.said.text() == f"{100.0 * share:.1f} % of the vertices"
    shown = pixels(window).astype(int)
    yellow = (shown[..., 0] > shown[..., 2] + 80) & (shown[..., 1] > shown[..., 2] + 80)
    assert yellow.any()
    # From the mesh to the table.
    centre = QPoint(window.canvas.width() // 2, window.canvas.height() // 2)
    move(qtbot, window.canvas, centre, lambda: len(plot.marks) == 3)
    assert plot.marks[0] < plot.marks[2]  # red light goes farther
    qtbot.mouseClick(plot, Qt.MouseButton.LeftButton, pos=QPoint(left + 80, middle))
    settled(qtbot, window)
    assert plot.brush is None
    np.testing.assert_array_equal(pixels(window), before)
