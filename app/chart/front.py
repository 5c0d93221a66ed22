"""The Pareto front of speed and accuracy, and one plain recommendation from it."""

from collections.abc import Iterable, Sequence

from app.chart.measure import PERCENT, Measure, microseconds
from app.chart.points import Advice, Point

FACTOR = 2.0
"""Without a tolerance, an error up to this many times the least is taken for good enough."""


def pareto_front(points: Iterable[Point]) -> tuple[Point, ...]:
    """Return the points that no other one beats.

    Parameters
    ----------
    points : iterable of Point
        Their `seconds` and `share` are compared.

    Returns
    -------
    tuple of Point
        Fastest first. A point is beaten by one that is as fast and as accurate at least, and
        better in one of both; of points that are alike in both, all stay.
    """
    front: list[Point] = []
    for point in sorted(points, key=_place):
        best = front[-1] if front else None
        if best is None or point.share < best.share or _place(point) == _place(best):
            front.append(point)
    return tuple(front)


def _place(point: Point) -> tuple[float, float]:
    return point.seconds, point.share


def advise(front: Sequence[Point], tolerance: float | None, measure: Measure = PERCENT) -> Advice:
    """Return the fastest point of a front that is accurate enough.

    Parameters
    ----------
    front : sequence of Point
        From `pareto_front`.
    tolerance : float or None
        Greatest error that is accepted; None accepts twice the least error on the front.
    measure : Measure
        What the error is.

    Returns
    -------
    Advice
        The recommendation; without a point if the tolerance is not met, or the front is empty.
    """
    if not front:
        return Advice(None, "No recommendation: nothing gave figures.")
    best = front[-1]
    bound = FACTOR * best.share if tolerance is None else tolerance
    limit = measure.said(bound)
    fit = [point for point in front if point.share <= bound]
    if not fit:
        return Advice(None, f"Nothing meets {limit}: the nearest is {said(best, measure)}.")
    taken = fit[0]
    words = f"{said(taken, measure)}; nothing faster"
    if tolerance is not None:
        return Advice(taken, f"{words} meets {limit}.")
    if taken.share == best.share:
        return Advice(taken, f"{words} is within a factor {FACTOR:g} of it.")
    least = f"{measure.title}, {measure.said(best.share)} by {best.label}"
    return Advice(taken, f"{words} is within a factor {FACTOR:g} of the least {least}.")


def said(point: Point, measure: Measure = PERCENT) -> str:
    """Return a point in words.

    Parameters
    ----------
    point : Point
        Any.
    measure : Measure
        What its error is.

    Returns
    -------
    str
        Label, error and time.
    """
    error = f"{measure.said(point.share)} {measure.title}"
    return f"{point.label}: {error} at {microseconds(point.seconds)} µs a vertex"
