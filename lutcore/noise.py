"""The noise of a mesh's vertices, told from its shape, and what it does to curvature."""

import numpy as np
from numba import prange

from lutcore.arrays import BoolArray, FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.tensors import tangent_frame

# White noise of sigma 1 on a regular triangulation leaves this standard deviation after the
# difference to the mean of six neighbours is taken twice: the root of the sum of squares of
# (I - P)^2, 1.3611 + 0.4630 + 0.0231.
_TWICE_DIFFERENCED = 1.359
# Median absolute deviation of a Gaussian.
_MAD = 0.6745
# Second derivative of white noise under a Gaussian of deviation s: its variance is
# 3/(16 pi) sigma^2 A/s^6, the fourth derivative at 0 of a Gaussian of variance 2 s^2. Twice
# that at s less that at sqrt(2) s, with covariance 1/(18 pi): 4(3/16) + 3/128 - 4/18 over pi.
_PLAIN = float(np.sqrt(3.0 / (16.0 * np.pi)))
_EXTRAPOLATED = float(np.sqrt((0.75 + 3.0 / 128.0 - 4.0 / 18.0) / np.pi))
# What star and vertex normal average by themselves, as a variance in units of A; fitted on a
# regular torus with white noise, where it brings the formula within a tenth from s^2 = A on.
_STAR = 0.76
# One ring: k = 2 (mean of six - z)/h^2, and normals that are nearly independent of it.
_RING = 2.24


def plain_noise(sigma: float, spacing: float, scale: float) -> float:
    """Return the noise of k at one scale.

    Parameters
    ----------
    sigma : float
        Noise of the vertices, mesh units.
    spacing : float
        Square root of the median vertex area, mesh units.
    scale : float
        Scale of the smoothing, mesh units; 0 for none.

    Returns
    -------
    float
        Standard deviation, 1/mesh unit.
    """
    if scale == 0.0:
        return _RING * sigma / spacing**2
    return float(_PLAIN * sigma * spacing / (scale**2 + _STAR * spacing**2) ** 1.5)


def extrapolated_noise(sigma: float, spacing: float, scale: float) -> float:
    """Return the noise of k after Richardson's extrapolation from s and sqrt(2) s.

    Parameters
    ----------
    sigma : float
        Noise of the vertices, mesh units.
    spacing : float
        Square root of the median vertex area, mesh units.
    scale : float
        The scale s, mesh units.

    Returns
    -------
    float
        Standard deviation, 1/mesh unit.
    """
    return plain_noise(sigma, spacing, scale) * _EXTRAPOLATED / _PLAIN


def vertex_noise(
    start: IndexArray,
    neighbour: IndexArray,
    vertices: FloatArray,
    normals: FloatArray,
    tensors: FloatArray,
    judge: BoolArray | None = None,
) -> float:
    """Return the standard deviation of the vertices along the normal.

    Parameters
    ----------
    start, neighbour : ndarray of int32
        Neighbours of each vertex.
    vertices : ndarray, shape=(n, 3)
        Positions.
    normals : ndarray, shape=(n, 3)
        Smoothed unit normals.
    tensors : ndarray, shape=(n, 3)
        Smoothed shape operators in the `tangent_frame` of `normals`.
    judge : ndarray of bool, shape=(n,), optional
        Vertices to judge by; all if not given.

    Returns
    -------
    float
        Robust estimate over those vertices, mesh units.
    """
    residual = _residual(start, neighbour, vertices, normals, tensors)
    twice = _difference(start, neighbour, residual)
    if judge is not None:
        twice = twice[judge]
    return float(np.median(np.abs(twice))) / (_MAD * _TWICE_DIFFERENCED)


@compiled(parallel=True)
def _residual(
    start: IndexArray,
    neighbour: IndexArray,
    vertices: FloatArray,
    normals: FloatArray,
    tensors: FloatArray,
) -> FloatArray:
    """Return how far each vertex is off the paraboloids that its neighbours continue."""
    residual = np.empty(len(vertices))
    for i in prange(len(vertices)):
        n = (normals[i, 0], normals[i, 1], normals[i, 2])
        u, v = tangent_frame(n[0], n[1], n[2])
        total = 0.0
        for at in range(start[i], start[i + 1]):
            j = neighbour[at]
            x, y, z = 0.0, 0.0, 0.0
            for axis in range(3):
                d = vertices[j, axis] - vertices[i, axis]
                x, y, z = x + d * u[axis], y + d * v[axis], z + d * n[axis]
            total += z + 0.5 * (
                tensors[i, 0] * x * x + 2.0 * tensors[i, 1] * x * y + tensors[i, 2] * y * y
            )
        residual[i] = total / max(start[i + 1] - start[i], 1)
    return residual


@compiled(parallel=True)
def _difference(start: IndexArray, neighbour: IndexArray, values: FloatArray) -> FloatArray:
    """Return each value less the mean of its neighbours."""
    out = np.empty(len(values))
    for i in prange(len(values)):
        total = 0.0
        for at in range(start[i], start[i + 1]):
            total += values[neighbour[at]]
        out[i] = values[i] - total / max(start[i + 1] - start[i], 1)
    return out
