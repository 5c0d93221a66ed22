"""The colour bar: its ends are dragged, and what it draws is what the map says."""

import numpy as np
import pytest
from qtpy.QtCore import QPoint, Qt

from app.colormaps import table
from app.gui.color_bar import ColorBar
from app.gui.distribution import Distribution, distribution
from app.pipeline import Pipeline
from app.quantities import QUANTITIES
from app.session import Method, Session
from app.shown import trusted
from lutcore.statistics import histogram
from tests.app.gui.mouse import move


@pytest.fixture
def bar(qtbot):
    values = np.random.default_rng(1).normal(0.0, 1.0, 20_000)
    levels = np.percentile(values, np.linspace(0.0, 100.0, 401))
    found = Distribution(QUANTITIES["k1"], -1.0, 1.0, histogram(values, -3.0, 3.0, 160), levels)
    made = ColorBar()
    qtbot.addWidget(made)
    made.resize(400, 100)
    made.show()
    qtbot.waitExposed(made)
    made.follow(found, table("green-red"), (-1.0, 1.0))
    return made


def _drag(qtbot, bar, start: float, end: float) -> None:
    at = [QPoint(round(bar.x_of(value)), 20) for value in (start, 0.5 * (start + end), end)]
    qtbot.mousePress(bar, Qt.MouseButton.LeftButton, pos=at[0])
    for place in at[1:]:
        move(qtbot, bar, place)
    qtbot.mouseRelease(bar, Qt.MouseButton.LeftButton, pos=at[-1])


def test_each_end_is_dragged_alone(bar, qtbot) -> None:
    told = []
    bar.ranged.connect(lambda low, high: told.append((low, high)))
    _drag(qtbot, bar, 1.0, 2.0)
    assert told[-1] == (-1.0, pytest.approx(2.0, abs=0.02))
    assert len(told) == 2
    _drag(qtbot, bar, -1.0, -0.4)
    assert bar.ends == (pytest.approx(-0.4, abs=0.02), pytest.approx(2.0, abs=0.02))


def test_the_ends_never_cross(bar, qtbot) -> None:
    _drag(qtbot, bar, 1.0, -2.5)
    low, high = bar.ends
    assert low == -1.0 < high < -0.9


def test_a_press_away_from_the_ends_moves_nothing(bar, qtbot) -> None:
    with qtbot.assertNotEmitted(bar.ranged), qtbot.assertNotEmitted(bar.pressed):
        _drag(qtbot, bar, 0.0, 0.5)


def test_a_double_click_asks_for_the_automatic_range(bar, qtbot) -> None:
    with qtbot.waitSignal(bar.automatic):
        qtbot.mouseDClick(bar, Qt.MouseButton.LeftButton, pos=QPoint(200, 20))


def test_the_value_under_the_mouse_is_told(bar, qtbot) -> None:
    with qtbot.waitSignal(bar.pointed) as told:
        move(qtbot, bar, QPoint(round(bar.x_of(0.5)), 20))
    assert told.args[0] == pytest.approx(0.5, abs=0.01)
    # Half a sigma above the mean of a normal distribution lie 69.1 % of it.
    assert bar._found.share_below(0.5) == pytest.approx(69.1, abs=1.0)


def test_it_draws_the_map_between_the_ends_and_columns_as_high_as_the_counts(bar) -> None:
    image = bar.grab().toImage()
    scale = image.width() / bar.width()

    def color(value: float, y: float):
        found = image.pixelColor(round(scale * bar.x_of(value)), round(scale * y))
        return np.array([found.red(), found.green(), found.blue()])

    strip = bar.height() - 1.0 * bar.fontMetrics().height()
    colors = 255.0 * table("green-red")
    for value in (-2.0, -0.5, 0.01, 0.5, 2.0):
        share = min(max(0.5 * (value + 1.0), 0.0), 1.0)
        assert color(value, strip) == pytest.approx(colors[round(255 * share)], abs=6)
    # At half height there is a column in the middle, where the density is more than half of its
    # peak up to 1.18 sigma, and none beyond.
    half = 0.5 * strip
    assert color(0.5, half) == pytest.approx(colors[191], abs=6)
    assert np.abs(color(1.5, half) - colors[255]).max() > 40


def test_what_is_dragged_does_not_run_away_while_it_is_followed(bar, qtbot) -> None:
    start = QPoint(round(bar.x_of(1.0)), 20)
    qtbot.mousePress(bar, Qt.MouseButton.LeftButton, pos=start)
    move(qtbot, bar, QPoint(bar.width() - 1, 20))
    span = bar.x_of(0.0)
    bar.follow(bar._found, table("green-red"), bar.ends)
    assert bar.x_of(0.0) == span
    qtbot.mouseRelease(bar, Qt.MouseButton.LeftButton, pos=QPoint(bar.width() - 1, 20))
    assert bar.x_of(bar.ends[1]) < bar.width() - 5  # there is room to go on


def test_the_distribution_counts_what_is_shown() -> None:
    session = Session(
        mesh="sample:torus",
        view="curvature",
        quantity="mean",
        estimator=Method("rusinkiewicz2004"),
        range=(0.0, 1.0),
    )
    pipeline = Pipeline()
    found = distribution(session, pipeline)
    curvatures = pipeline.curvatures(session)
    mean = curvatures.mean
    ends = np.percentile(mean[trusted(curvatures)], (5.0, 95.0))
    assert (found.low, found.high) == pytest.approx(tuple(ends))
    counted = found.histogram
    assert counted.counts.sum() + counted.below + counted.above == len(mean)
    assert found.share_below(float(np.median(mean))) == pytest.approx(50.0, abs=0.3)
