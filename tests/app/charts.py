"""Charts made by hand, for tests."""

from app.chart.front import advise, pareto_front
from app.chart.points import Chart, Point, Spread


def point(name, time, error, setting=""):
    return Point(name, setting, Spread(time, time, time), Spread(error, error, error))


def chart(points, tolerance=None, missing=(), subject="a subject"):
    front = pareto_front(points)
    return Chart(
        subject=subject,
        meaning=("What the error is.",),
        points=tuple(points),
        front=front,
        missing=tuple(missing),
        advice=advise(front, tolerance),
        tolerance=tolerance,
        machine={"cores": "2", "system": "Any", "Python": "3"},
        facts={},
    )


LADDER = [point("a", 1e-6, 0.5), point("b", 2e-6, 0.03), point("c", 3e-6, 0.02)]
