"""Many values in a few numbers."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lutcore.arrays import FloatArray

PERCENTILES = (1, 5, 25, 50, 75, 95, 99)


@dataclass(frozen=True, eq=False)
class Histogram:
    """How often values fall into equal steps of a range.

    Parameters
    ----------
    edges : ndarray, shape=(bins + 1,)
        From the range's low end to its high end, in the values' unit.
    counts : ndarray of int, shape=(bins,)
        Values in each step; the last one has its upper end too.
    below, above : int
        Values beyond the ends.
    """

    edges: FloatArray
    counts: NDArray[np.int64]
    below: int
    above: int


def histogram(values: FloatArray, low: float, high: float, bins: int = 48) -> Histogram:
    """Count values within a range.

    Parameters
    ----------
    values : ndarray
        Any; those that are not finite are left out.
    low, high : float
        Ends of the range, low < high.
    bins : int
        Steps.

    Returns
    -------
    Histogram
        The counts add up to the finite values.
    """
    finite = values[np.isfinite(values)]
    counts, edges = np.histogram(finite, bins, (low, high))
    below, above = (int(np.count_nonzero(beyond)) for beyond in (finite < low, finite > high))
    return Histogram(edges, counts, below, above)


def percentiles(values: FloatArray) -> dict[str, float | None]:
    """Return the percentiles of the finite values.

    Parameters
    ----------
    values : ndarray
        Any; infinite ones are left out.

    Returns
    -------
    dict of str to float or None
        ``p1`` to ``p99``, after `PERCENTILES`; None where nothing is finite.
    """
    finite = values[np.isfinite(values)]
    if finite.size == 0:
        return {f"p{share}": None for share in PERCENTILES}
    found = np.percentile(finite, PERCENTILES)
    return {f"p{share}": float(value) for share, value in zip(PERCENTILES, found, strict=True)}
