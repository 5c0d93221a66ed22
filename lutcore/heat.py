"""Diffusion of fields over a mesh to several scales at once, by one Chebyshev recurrence."""

from collections.abc import Sequence

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.laplacian import Laplacian
from lutcore.progress import Progress, silent, tell

SingleArray = NDArray[np.float32]
FIELDS = 6
"""Fields diffused together: three of positions, three of normals."""

_TWO = np.float32(2.0)


def diffusion(
    operator: Laplacian,
    fields: FloatArray,
    scales: Sequence[float],
    tolerance: float,
    progress: Progress = silent,
) -> SingleArray:
    """Return how far diffusion moves the fields, (exp(-s^2 L / 2) - 1) f for each scale s.

    The recurrence runs on L f rather than on f: what it carries is as small as the change it
    computes, so single precision loses nothing, however far the mesh extends.

    Parameters
    ----------
    operator : Laplacian
        The Laplacian L.
    fields : ndarray, shape=(n, 6)
        The fields f.
    scales : sequence of float
        Standard deviations s of the Gaussians that diffusion amounts to, mesh units.
    tolerance : float
        Share of the roughest part of f that may remain or be added.
    progress : callable
        Told where the work stands.

    Returns
    -------
    ndarray of float32, shape=(n, S, 6)
        The changes, scale by scale.

    References
    ----------
    D. Hammond, P. Vandergheynst, R. Gribonval, Wavelets on graphs via spectral graph theory,
    Appl. Comput. Harmon. Anal. 30, 2011, section 6.
    """
    series = [_series(scale, operator.bound, tolerance) for scale in scales]
    terms = max(len(one) for one in series)
    weights = np.zeros((terms, len(scales)), np.float32)
    for column, one in enumerate(series):
        weights[: len(one), column] = one
    links = (operator.start, operator.neighbour, operator.rate)
    before = _apply(*links, fields, 0.5 * operator.bound)
    change = weights[0][None, :, None] * before[:, None, :]
    now = np.zeros_like(before)
    _step(*links, before, now, change, weights[1], np.float32(0.5))
    for term in range(2, terms):
        if term % 8 == 0:
            tell(progress, term / terms, "smoothing")
        _step(*links, now, before, change, weights[term], np.float32(1.0))
        now, before = before, now
    return change


def _series(scale: float, bound: float, tolerance: float) -> FloatArray:
    """Return the Chebyshev coefficients of (exp(-t x) - 1)/x on 0 <= x <= bound, cut off."""
    from scipy.fft import dct

    time = 0.5 * scale * scale
    size = 32 + 4 * int(np.sqrt(time * bound * 12.0))
    angle = np.pi * (np.arange(size) + 0.5) / size
    x = 0.5 * bound * (1.0 + np.cos(angle))
    values = np.expm1(-time * x) / x
    coefficients = dct(values, type=2) / size
    coefficients[0] *= 0.5
    # Each T_k is at most 1, and L f at most bound times f.
    tail = bound * np.cumsum(np.abs(coefficients[::-1]))[::-1]
    return coefficients[: max(2, int(np.searchsorted(-tail, -tolerance)))]


@compiled(parallel=True)
def _apply(
    start: IndexArray, neighbour: IndexArray, rate: SingleArray, f: FloatArray, factor: float
) -> SingleArray:
    out = np.empty(f.shape, np.float32)
    for i in prange(len(start) - 1):
        s0 = s1 = s2 = s3 = s4 = s5 = 0.0
        for at in range(start[i], start[i + 1]):
            j, w = neighbour[at], factor * rate[at]
            s0 += w * (f[i, 0] - f[j, 0])
            s1 += w * (f[i, 1] - f[j, 1])
            s2 += w * (f[i, 2] - f[j, 2])
            s3 += w * (f[i, 3] - f[j, 3])
            s4 += w * (f[i, 4] - f[j, 4])
            s5 += w * (f[i, 5] - f[j, 5])
        out[i, 0], out[i, 1], out[i, 2] = s0, s1, s2
        out[i, 3], out[i, 4], out[i, 5] = s3, s4, s5
    return out


@compiled(parallel=True)
def _step(
    start: IndexArray,
    neighbour: IndexArray,
    rate: SingleArray,
    now: SingleArray,
    before: SingleArray,
    change: SingleArray,
    weight: SingleArray,
    half: np.float32,
) -> None:
    """Replace T_{k-1} by T_{k+1} = 2 x T_k - T_{k-1} and add its share to every scale."""
    double = _TWO * half
    keep = double - np.float32(1.0)
    for i in prange(len(start) - 1):
        r = np.float32(0.0)
        s0 = s1 = s2 = s3 = s4 = s5 = np.float32(0.0)
        for at in range(start[i], start[i + 1]):
            j, w = neighbour[at], rate[at]
            r += w
            s0 += w * now[j, 0]
            s1 += w * now[j, 1]
            s2 += w * now[j, 2]
            s3 += w * now[j, 3]
            s4 += w * now[j, 4]
            s5 += w * now[j, 5]
        r -= np.float32(1.0)
        t0 = double * (r * now[i, 0] - s0) - keep * before[i, 0]
        t1 = double * (r * now[i, 1] - s1) - keep * before[i, 1]
        t2 = double * (r * now[i, 2] - s2) - keep * before[i, 2]
        t3 = double * (r * now[i, 3] - s3) - keep * before[i, 3]
        t4 = double * (r * now[i, 4] - s4) - keep * before[i, 4]
        t5 = double * (r * now[i, 5] - s5) - keep * before[i, 5]
        before[i, 0], before[i, 1], before[i, 2] = t0, t1, t2
        before[i, 3], before[i, 4], before[i, 5] = t3, t4, t5
        for scale in range(len(weight)):
            c = weight[scale]
            if c != np.float32(0.0):
                change[i, scale, 0] += c * t0
                change[i, scale, 1] += c * t1
                change[i, scale, 2] += c * t2
                change[i, scale, 3] += c * t3
                change[i, scale, 4] += c * t4
                change[i, scale, 5] += c * t5
