import numpy as np
import pytest

from app.chart.front import advise, pareto_front
from app.chart.points import Point, Spread
from tests.app.charts import LADDER, point


def names(points):
    return "".join(one.name for one in points)


@pytest.mark.parametrize(
    ("points", "front"),
    [
        ([], ""),
        ([("a", 1, 1)], "a"),
        ([("b", 2, 1), ("a", 1, 2)], "ab"),
        ([("a", 1, 1), ("b", 2, 2)], "a"),
        ([("a", 1, 2), ("b", 1, 1)], "b"),  # as fast: the better one
        ([("a", 2, 1), ("b", 1, 1)], "b"),  # as good: the faster one
        ([("a", 1, 1), ("b", 1, 1)], "ab"),  # alike: both
        ([("a", 1, 1), ("b", 1, 1), ("c", 2, 1), ("d", 3, 0)], "abd"),
        ([("d", 4, 3), ("c", 3, 4), ("b", 2, 5), ("a", 1, 6), ("x", 3, 5)], "abcd"),
    ],
)
def test_the_front_holds_what_nothing_beats(points, front):
    assert names(pareto_front(point(*one) for one in points)) == front


def test_the_front_is_what_its_definition_says_on_random_points():
    # Few different values, so that there are ties of every kind.
    table = np.random.default_rng(5).integers(0, 6, (40, 2))
    points = [point(str(i), float(t), float(e)) for i, (t, e) in enumerate(table)]

    def beaten(one):
        return any(
            other.seconds <= one.seconds
            and other.share <= one.share
            and (other.seconds, other.share) != (one.seconds, one.share)
            for other in points
        )

    expected = {one.name for one in points if not beaten(one)}
    assert {one.name for one in pareto_front(points)} == expected


def test_time_counts_by_its_least_and_error_by_its_median():
    steady = Point("a", "", Spread(2.0, 2.0, 2.0), Spread(0.1, 0.3, 0.9))
    disturbed = Point("b", "", Spread(1.0, 5.0, 9.0), Spread(0.1, 0.3, 0.4))
    assert names(pareto_front([steady, disturbed])) == "b"
    assert Spread.of([3.0, 1.0, 9.0, 2.0]) == Spread(1.0, 2.5, 9.0)


def test_without_a_tolerance_the_fastest_within_twice_the_least_error_is_taken():
    advice = advise(LADDER, None)
    assert advice.point is LADDER[1]
    assert advice.sentence == (
        "b: 3 % error at 2 µs a vertex; nothing faster is within a factor 2 of the least error, "
        "2 % by c."
    )


def test_where_nothing_else_is_near_the_most_accurate_is_taken():
    advice = advise([LADDER[0], point("d", 9e-6, 0.0035)], None)
    assert advice.sentence == (
        "d: 0.35 % error at 9 µs a vertex; nothing faster is within a factor 2 of it."
    )


@pytest.mark.parametrize(
    ("tolerance", "taken"), [(0.5, "a"), (0.4999, "b"), (0.03, "b"), (0.02, "c"), (9.0, "a")]
)
def test_with_a_tolerance_the_fastest_that_meets_it_is_taken(tolerance, taken):
    advice = advise(LADDER, tolerance)
    assert advice.point is not None
    assert advice.point.name == taken
    assert "nothing faster meets" in advice.sentence


def test_a_tolerance_that_nothing_meets_names_the_nearest():
    advice = advise(LADDER, 0.001)
    assert advice.point is None
    assert advice.sentence == ("Nothing meets 0.1 %: the nearest is c: 2 % error at 3 µs a vertex.")


def test_without_points_nothing_is_recommended():
    assert advise([], None).point is None
    assert "No recommendation" in advise([], 0.1).sentence
