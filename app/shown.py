"""The quantities that a session shows, with the range that each is shown in."""

from dataclasses import dataclass

import numpy as np

from app.pipeline import Pipeline
from app.quantities import QUANTITIES, Quantity
from app.session import Session
from lutcore.arrays import BoolArray, FloatArray
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import ParameterError

ROBUST = (5.0, 95.0)
"""Percentiles at the ends of a robust range, where nothing else is said."""
# From the median absolute deviation to the sigma of a normal distribution.
_SIGMA = 1.4826
# If the error bars leave fewer values than this share, they say nothing of the rest.
_LEAST_SHARE = 0.1
# As a share of the larger end; the colour bar's labels tell no smaller step.
_LEAST_WIDTH = 0.01
_ENOUGH = 100_000


@dataclass(frozen=True, eq=False)
class Shown:
    """A quantity as a picture shows it.

    Parameters
    ----------
    quantity : Quantity
        What it is.
    values : ndarray, shape=(n,)
        In the quantity's `unit`; infinite where there is none.
    low, high : float
        Ends of the colour bar.
    """

    quantity: Quantity
    values: FloatArray
    low: float
    high: float


def names_shown(session: Session) -> tuple[str, ...]:
    """Return the quantities that a session shows.

    Parameters
    ----------
    session : Session
        Its quantity and peers are used.

    Returns
    -------
    tuple of str
        One, or each that there is where the session says ``all``.
    """
    if session.quantity != "all":
        return (session.quantity,)
    return tuple(name for name in QUANTITIES if name != "disagreement" or session.peers)


def shown(session: Session, pipeline: Pipeline, name: str) -> Shown:
    """Return a quantity of a session's mesh with the range to show it in.

    Parameters
    ----------
    session : Session
        Its mesh, estimator and colours are used.
    pipeline : Pipeline
        Where arrays come from.
    name : str
        A key of `QUANTITIES`, of `names_shown`.

    Returns
    -------
    Shown
        In millimetres; the range is the session's, or a robust one.

    Raises
    ------
    ParameterError
        If the session names no estimators to disagree, or one range for all quantities.
    """
    quantity = QUANTITIES[name]
    size = pipeline.mm_per_unit(session)
    curvatures = pipeline.curvatures(session)
    if name == "disagreement":
        if not session.peers:
            raise ParameterError("a disagreement needs estimators; name them with --disagree A,B,C")
        values = quantity.in_mm(pipeline.consult(session).disagreement.spread, size)
    else:
        values = quantity.values(curvatures, size)
    if session.range is not None:
        if session.quantity == "all":
            raise ParameterError(
                f"one range, {session.range[0]:g} to {session.range[1]:g}, does not fit all "
                "quantities; leave --range out, or choose one --quantity"
            )
        return Shown(quantity, values, *session.range)
    # Only asked for by name does a quantity that is never negative get a range that is.
    symmetric = session.symmetric and (quantity.signed or session.quantity == name)
    counted = trusted(curvatures) if quantity.measured else curvatures.estimated
    low, high = robust_range(values[counted], symmetric, session.percentiles)
    return Shown(quantity, values, low, high)


def trusted(curvatures: PrincipalCurvatures) -> BoolArray:
    """Tell which vertices have a say in the range of what is computed from k1 and k2.

    A measured curvature's variance is that of the surface plus that of its error. Where the error
    bar exceeds the spread of k1 and k2 over the mesh, their median absolute deviation as one
    sigma, a value tells more of its error than of the surface: it has no say. So borders and
    debris, whose error bars are wide, do not widen the range as long as they are the lesser half.
    One rule for all that is computed from k1 and k2, so that panels speak of the same vertices.

    Parameters
    ----------
    curvatures : PrincipalCurvatures
        An estimate.

    Returns
    -------
    ndarray of bool, shape=(n,)
        All vertices with an estimate, if the error bars would leave less than a tenth of them.
    """
    estimated = curvatures.estimated
    if not estimated.any():
        return estimated
    # A large mesh's spread shows in a part of its vertices.
    some = np.flatnonzero(estimated)[:: -(-len(estimated) // _ENOUGH)]
    variance = sum(_spread(k[some]) ** 2 for k in (curvatures.k1, curvatures.k2)) / 2.0
    certain: BoolArray = estimated & (curvatures.error <= variance**0.5)
    enough = np.count_nonzero(certain) >= _LEAST_SHARE * np.count_nonzero(estimated)
    return certain if enough else estimated


def _spread(values: FloatArray) -> float:
    return _SIGMA * float(np.median(np.abs(values - np.median(values))))


def robust_range(
    values: FloatArray, symmetric: bool = False, percentiles: tuple[float, float] = ROBUST
) -> tuple[float, float]:
    """Return the range that shows most of the values.

    Parameters
    ----------
    values : ndarray
        Infinite ones are left out.
    symmetric : bool
        Whether the range is as wide below zero as above.
    percentiles : tuple of 2 floats
        Of the values, at its ends.

    Returns
    -------
    tuple of 2 floats
        The percentiles, at least a hundredth of the larger apart, lest rounding
        errors fill the whole colour map; 0 and 1 where all is 0.
    """
    finite = values[np.isfinite(values)]
    if not finite.any():
        return 0.0, 1.0
    low, high = (float(end) for end in np.percentile(finite, percentiles))
    if symmetric:
        low, high = -max(abs(low), abs(high)), max(abs(low), abs(high))
    # Where all is alike the range opens upwards, so that nothing looks large.
    return low, max(high, low + _LEAST_WIDTH * max(abs(low), abs(high)))
