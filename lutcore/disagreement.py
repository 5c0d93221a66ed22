"""How far several curvature estimators are apart at each vertex."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lutcore.arrays import FloatArray
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import ParameterError

FEWEST = 3
"""Estimators that a spread needs: of two that differ nobody knows which one errs."""

# From the median absolute deviation of normal numbers to their sigma: 1.4826 for many, with the
# factor for few of Croux and Rousseeuw (see `disagreement`), for 3 to 9 numbers.
_MANY = 1.4826
_FEW = (1.495, 1.363, 1.206, 1.200, 1.140, 1.129, 1.107)


@dataclass(frozen=True, eq=False)
class Disagreement:
    """What m estimators say of the same n vertices, put together.

    Parameters
    ----------
    spread : ndarray, shape=(n,)
        One sigma of a single estimator's k1 and k2 as the estimators' scatter shows it, 1/mesh
        unit; infinite where fewer than three have an estimate.
    k1, k2 : ndarray, shape=(n,)
        Medians over the estimators, 1/mesh unit; 0 where none has an estimate.
    count : ndarray of int, shape=(n,)
        Estimators that have an estimate.
    distance : ndarray, shape=(m, n)
        Of each estimator from the medians, sqrt(((k1 - median)^2 + (k2 - median)^2)/2), 1/mesh
        unit; infinite where it has no estimate.
    """

    spread: FloatArray
    k1: FloatArray
    k2: FloatArray
    count: NDArray[np.int64]
    distance: FloatArray

    @cached_property
    def typical_distance(self) -> FloatArray:
        """Median of each estimator's distance over its vertices, shape (m,), 1/mesh unit.

        Infinite for one that has no estimate anywhere.
        """
        rows = [row[np.isfinite(row)] for row in self.distance]
        return np.array([np.median(row) if row.size else np.inf for row in rows])

    def beyond(self, error: FloatArray, times: float = 2.0) -> float:
        """Return where the estimators are farther apart than one of them owns to.

        Parameters
        ----------
        error : ndarray, shape=(n,)
            Error bar of an estimate of the same mesh, one sigma, 1/mesh unit.
        times : float
            How many of it.

        Returns
        -------
        float
            Share of the vertices that have a spread and an error bar where the spread exceeds
            that; 0 where there are no such vertices.
        """
        both = np.isfinite(self.spread) & np.isfinite(error)
        return float(np.mean(self.spread[both] > times * error[both])) if both.any() else 0.0


def disagreement(estimates: Sequence[PrincipalCurvatures]) -> Disagreement:
    """Compare three estimates or more of one mesh, vertex by vertex.

    The spread is the median absolute deviation from the median, brought to one sigma of normal
    errors, averaged over k1 and k2. Not the root mean square, because among a handful of
    estimators one often fails by orders of magnitude, at a border, say: the map would then show
    where that one fails instead of where the surface is hard to tell. An error that all estimators
    share does not show.

    Parameters
    ----------
    estimates : sequence of PrincipalCurvatures
        Of the same n vertices.

    Returns
    -------
    Disagreement
        Spread, medians, and each estimator's distance from them.

    Raises
    ------
    ParameterError
        If there are fewer than three, or they are not of one mesh.

    References
    ----------
    C. Croux and P. J. Rousseeuw, Time-efficient algorithms for two highly robust estimators of
    scale, COMPSTAT 1992, section 4 (factors for few numbers).
    """
    if len(estimates) < FEWEST:
        raise ParameterError(
            f"{len(estimates)} estimates: a disagreement takes {FEWEST} or more, for of two that "
            "differ nobody knows which one errs"
        )
    sizes = {len(estimate.k1) for estimate in estimates}
    if len(sizes) > 1:
        counts = ", ".join(map(str, sorted(sizes)))
        raise ParameterError(f"the estimates are not of one mesh: they have {counts} vertices")
    known = np.stack([estimate.estimated for estimate in estimates])
    count = known.sum(axis=0)
    spread = np.zeros(known.shape[1])
    squared = np.zeros(known.shape)
    medians = []
    for name in ("k1", "k2"):
        values = np.stack([getattr(estimate, name) for estimate in estimates])
        middle = _median(np.where(known, values, np.inf), count)
        off = np.abs(values - middle)
        spread += 0.5 * _sigma(_median(np.where(known, off, np.inf), count), count)
        squared += 0.5 * np.square(off)
        medians.append(middle)
    return Disagreement(
        spread=np.where(count >= FEWEST, spread, np.inf),
        k1=medians[0],
        k2=medians[1],
        count=count,
        distance=np.where(known, np.sqrt(squared), np.inf),
    )


def _median(values: FloatArray, count: NDArray[np.int64]) -> FloatArray:
    """Median of the first `count` of each column in order; 0 where there are none."""
    ordered = np.sort(values, axis=0)
    low, high = np.maximum(count - 1, 0) // 2, count // 2
    ends = [np.take_along_axis(ordered, at[None], axis=0)[0] for at in (low, high)]
    return np.where(count > 0, 0.5 * (ends[0] + ends[1]), 0.0)


def _sigma(deviation: FloatArray, count: NDArray[np.int64]) -> FloatArray:
    """Bring median absolute deviations of `count` numbers to one sigma."""
    most = int(count.max(initial=FEWEST))
    # For more than nine: n/(n - 0.8), as the reference says.
    factors = [*_FEW, *(n / (n - 0.8) for n in range(FEWEST + len(_FEW), most + 1))]
    at = np.clip(count - FEWEST, 0, len(factors) - 1)
    return _MANY * np.array(factors)[at] * deviation
