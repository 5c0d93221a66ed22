"""The Pareto front of speed and accuracy, and one plain recommendation from it."""

from collections.abc import Iterable, Sequence

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


def advise(front: Sequence[Point], tolerance: float | None) -> Advice:
    """Return the fastest point of a front that is accurate enough.

    Parameters
    ----------
    front : sequence of Point
        From `pareto_front`.
    tolerance : float or None
        Greatest error that is accepted, as a share; None accepts twice the least error
        on the front.

    Returns
    -------
    Advice
        The recommendation; without a point if the tolerance is not met, or the front is empty.
    """
    if not front:
        return Advice(None, "No recommendation: nothing gave figures.")
    best = front[-1]
    bound = FACTOR * best.share if tolerance is None else tolerance
    fit = [point for point in front if point.share <= bound]
    if not fit:
        return Advice(
            None,
            f"Nothing meets {percent(bound)}: the nearest is {said(best)}.",
        )
    taken = fit[0]
    if tolerance is not None:
        return Advice(taken, f"{said(taken)}; nothing faster meets {percent(bound)}.")
    if taken.share == best.share:
        return Advice(taken, f"{said(taken)}; nothing faster is within a factor {FACTOR:g} of it.")
    return Advice(
        taken,
        f"{said(taken)}; nothing faster is within a factor {FACTOR:g} of the least error, "
        f"{percent(best.share)} by {best.label}.",
    )


def said(point: Point) -> str:
    """Return a point in words.

    Parameters
    ----------
    point : Point
        Any.

    Returns
    -------
    str
        Label, error and time.
    """
    return (
        f"{point.label}: {percent(point.share)} error at {microseconds(point.seconds)} µs a vertex"
    )


def percent(share: float) -> str:
    """Return a share as people read it.

    Parameters
    ----------
    share : float
        Not negative.

    Returns
    -------
    str
        In per cent, with its sign.
    """
    return f"{number(100.0 * share)} %"


def microseconds(seconds: float) -> str:
    """Return seconds as a number of microseconds.

    Parameters
    ----------
    seconds : float
        Not negative.

    Returns
    -------
    str
        Without the unit.
    """
    return number(1e6 * seconds)


def number(value: float) -> str:
    """Return a number that is not negative, to three digits or to whole ones.

    Parameters
    ----------
    value : float
        Any that is not negative.

    Returns
    -------
    str
        Without an exponent up to 100 000.
    """
    return f"{value:.0f}" if 100.0 <= value < 1e5 else f"{value:.3g}"
