"""When a scene is shaded well enough: from errors of vertices to one number."""

from typing import NamedTuple

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.color import auto_exposure, srgb_encode
from lutcore.metrics import ciede2000_lab, lab

METRICS = ("relative", "mean-de2000", "p99-de2000")
"""See `Tolerance.metric`."""

DEFAULTS = {"relative": 0.02, "mean-de2000": 1.0, "p99-de2000": 2.0}
"""Tolerances by metric where none is given; a CIEDE2000 of 1 is just noticeable side by side."""

_LIGHT_OF_COLOR = 0.01
# Errors of three channels may add up in colour or cancel: all signs but for the common one.
_SIGNS = np.array([[1.0, 1.0, 1.0], [1.0, 1.0, -1.0], [1.0, -1.0, 1.0], [-1.0, 1.0, 1.0]])


class Tolerance(NamedTuple):
    """How wrong a picture may be.

    Parameters
    ----------
    value : float
        Above 0.
    metric : str
        ``relative``: the 99th percentile over the vertices of the largest channel's error, in R_d
        and the largest irradiance; ``mean-de2000`` and ``p99-de2000``: mean and 99th percentile
        over the vertices of the CIEDE2000 difference, exposed and encoded as for a display.
    """

    value: float
    metric: str = "relative"

    @property
    def light(self) -> float:
        """The relative error of light that is as strict, or stricter.

        L* = 116 Y^(1/3) - 16: a share s of the light moves it by at most 39 s, so that a
        CIEDE2000 of 1 is 2.6 % of white and more of what is darker; a hundredth is taken.
        """
        return self.value if self.metric == "relative" else _LIGHT_OF_COLOR * self.value

    def score(self, errors: FloatArray) -> float:
        """Return what the tolerance is compared with.

        Parameters
        ----------
        errors : ndarray, shape=(n,)
            Of vertices, in the metric's unit.

        Returns
        -------
        float
            Mean or 99th percentile; 0 for no vertices.
        """
        if not len(errors):
            return 0.0
        mean = self.metric == "mean-de2000"
        return float(errors.mean() if mean else np.percentile(errors, 99.0))


def relative(errors: FloatArray, irradiance: FloatArray) -> FloatArray:
    """Return errors of vertices in R_d and the largest irradiance.

    Parameters
    ----------
    errors : ndarray, shape=(n, 3)
        Of the exitance, in R_d and the lights' unit.
    irradiance : ndarray, shape=(3,)
        Largest irradiance by channel; channels without light do not count.

    Returns
    -------
    ndarray, shape=(n,)
        Of the channel where it is most.
    """
    lit = irradiance > 0.0
    if not lit.any():
        return np.zeros(len(errors))
    return np.asarray((errors[:, lit] / irradiance[lit]).max(axis=1))


def color_differences(exitance: FloatArray, errors: FloatArray) -> FloatArray:
    """Return the largest CIEDE2000 difference that errors of the exitance can make.

    Parameters
    ----------
    exitance : ndarray, shape=(n, 3)
        Linear RGB.
    errors : ndarray, shape=(n, 3)
        Bounds on its error, of any sign, channel by channel.

    Returns
    -------
    ndarray, shape=(n,)
        Differences from `exitance` with the exposure that suits it.
    """
    exposure = auto_exposure(exitance)
    base = _lab(exposure * exitance)
    largest = np.zeros(len(exitance))
    for signs in (*_SIGNS, *-_SIGNS):
        other = _lab(exposure * np.maximum(exitance + signs * errors, 0.0))
        largest = np.maximum(largest, ciede2000_lab(base, other))
    return largest


def color_distances(one: FloatArray, other: FloatArray, exposure: float) -> FloatArray:
    """Return how different two exitances look.

    Parameters
    ----------
    one, other : ndarray, shape=(n, 3)
        Linear RGB.
    exposure : float
        Factor of both.

    Returns
    -------
    ndarray, shape=(n,)
        CIEDE2000, encoded as for a display.
    """
    return ciede2000_lab(_lab(exposure * one), _lab(exposure * other))


def _lab(linear: FloatArray) -> FloatArray:
    return lab(srgb_encode(np.ascontiguousarray(linear)))
