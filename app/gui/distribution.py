"""How the values that are shown are distributed, for a bar to choose their range on. No Qt."""

from dataclasses import dataclass

import numpy as np
from msgspec.structs import replace

from app.pipeline import Pipeline
from app.quantities import Quantity
from app.session import Session
from app.shown import shown
from lutcore.arrays import FloatArray
from lutcore.statistics import Histogram, histogram

_BINS = 160
# Beyond these percentiles lie a few wild values that would press all others together, and so do
# those of borders and debris beyond the range by more than this share of its width.
_SEEN = (0.5, 99.5)
_BEYOND = 0.6
_SHARES = np.linspace(0.0, 100.0, 401)
# Where all values are alike, as a share of the value.
_LEAST_SPAN = 1e-3


@dataclass(frozen=True, eq=False)
class Distribution:
    """Values of one quantity over a mesh.

    Parameters
    ----------
    quantity : Quantity
        What it is.
    low, high : float
        The range that it has of its own accord, in the quantity's `unit`.
    histogram : Histogram
        Of nearly all values and of that range.
    levels : ndarray, shape=(401,)
        Values below which an evenly growing share of all lies.
    """

    quantity: Quantity
    low: float
    high: float
    histogram: Histogram
    levels: FloatArray

    def share_below(self, value: float) -> float:
        """Return how many values lie below one.

        Parameters
        ----------
        value : float
            In the quantity's unit.

        Returns
        -------
        float
            Percent.
        """
        return float(np.interp(value, self.levels, _SHARES, 0.0, 100.0))


def distribution(session: Session, pipeline: Pipeline) -> Distribution:
    """Return how a session's quantity is distributed.

    Parameters
    ----------
    session : Session
        Shows one quantity.
    pipeline : Pipeline
        Where arrays come from.

    Returns
    -------
    Distribution
        Of all vertices with a finite value.

    Raises
    ------
    MeshError, ParameterError
        If there are no values, or the session does not allow it.
    """
    found = shown(replace(session, range=None), pipeline, session.quantity)
    values = found.values[np.isfinite(found.values)]
    levels = np.percentile(values, _SHARES) if values.size else np.zeros(len(_SHARES))
    seen = np.interp(_SEEN, _SHARES, levels)
    beyond = _BEYOND * (found.high - found.low)
    least = min(max(float(seen[0]), found.low - beyond), found.low)
    most = max(min(float(seen[1]), found.high + beyond), found.high)
    most = max(most, least + _LEAST_SPAN * max(abs(least), abs(most)))
    counted = histogram(values, least, most, _BINS)
    return Distribution(found.quantity, found.low, found.high, counted, levels)
