"""From shape operators at several scales to one answer for each vertex, with its error bar."""

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray
from lutcore.collapse import mend
from lutcore.compiled import compiled
from lutcore.cosmoothing import Smoothed, Surface
from lutcore.curvature import PrincipalCurvatures
from lutcore.noise import extrapolated_noise, plain_noise, vertex_noise
from lutcore.tensors import write_principal

# A star that smoothing has closed to less than this share of its extent says more about the
# noise than about the surface.
_CLOSED = 0.25
# Bias after extrapolation over the change from the finer scale: 1/(1 - 1/4).
_LEFT = 4.0 / 3.0
# A polyhedron is off by this times k^3 spacing^2 at any scale, as on a clean regular torus.
_FACETS = 0.11


def extrapolated(smoothed: Smoothed, scale: int) -> FloatArray:
    """Return the tensors with the error of order s^2 removed (Richardson).

    Parameters
    ----------
    smoothed : Smoothed
        Tensors at scales that grow by sqrt(2).
    scale : int
        Column of the scale s; the next is sqrt(2) s.

    Returns
    -------
    ndarray, shape=(n, 3)
        2 S(s) - S(sqrt(2) s).
    """
    return 2.0 * smoothed.tensors[:, scale] - smoothed.tensors[:, scale + 1]


def tilt_correction(on: Surface, smoothed: Smoothed) -> float:
    """Return by how much noise has shortened the mean of unit normals, as a factor to undo it.

    Unit normals that noise tilts by an angle a have a mean of length <cos a>, and so do their
    differences. 1 - cos a of a tilt in two dimensions is distributed exponentially: its mean is
    its median over ln 2, and sharp edges do not move the median.

    Parameters
    ----------
    on : Surface
        The mesh.
    smoothed : Smoothed
        It, smoothed.

    Returns
    -------
    float
        A factor of at least 1 for every shape operator.
    """
    lost = 1.0 - np.einsum("ij,ij->i", on.fields[:, 3:], smoothed.normals)
    return 1.0 / (1.0 - min(0.5, float(np.median(lost)) / float(np.log(2.0))))


def select(on: Surface, smoothed: Smoothed, scale: int = 2) -> PrincipalCurvatures:
    """Return the curvatures at one scale, each vertex falling back where its star collapsed.

    Parameters
    ----------
    on : Surface
        The mesh.
    smoothed : Smoothed
        It, smoothed, at scales that grow by sqrt(2), its normals at the scale wanted.
    scale : int
        Column of the scale wanted, at least 2; one before and one after it are used.

    Returns
    -------
    PrincipalCurvatures
        One value for each vertex, with the scale that was used there.
    """
    links = (on.operator.start, on.operator.neighbour)
    sigma = vertex_noise(
        *links, on.fields[:, :3], smoothed.normals, smoothed.tensors[:, scale].copy()
    )
    fine, wanted = smoothed.scales[scale - 1 : scale + 1]
    noise = [plain_noise(sigma, on.spacing, length) for length in (0.0, fine)]
    noise.append(extrapolated_noise(sigma, on.spacing, wanted))
    tensors, square, used = _select(
        smoothed.tensors,
        smoothed.stretch,
        scale,
        np.array(noise),
        np.array([0.0, fine, wanted]),
        on.spacing,
    )
    mend(*links, smoothed.normals, np.flatnonzero(used == 0.0).astype(np.int32), tensors, square)
    k, directions = _principal(smoothed.normals, tensors, tilt_correction(on, smoothed))
    return PrincipalCurvatures(
        k[0], k[1], directions[0], directions[1], smoothed.normals, np.sqrt(square), used
    )


@compiled(parallel=True)
def _select(
    tensors: FloatArray,
    stretch: FloatArray,
    scale: int,
    noise: FloatArray,
    lengths: FloatArray,
    spacing: float,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return tensors, squared error bars and scales; scale 0 where the star has closed."""
    count = len(tensors)
    chosen = np.empty((count, 3))
    square = np.empty(count)
    used = np.empty(count)
    for i in prange(count):
        fine, wanted, coarse = tensors[i, scale - 1], tensors[i, scale], tensors[i, scale + 1]
        openness = min(stretch[i, scale], stretch[i, scale + 1])
        if openness >= _CLOSED:
            chosen[i] = 2.0 * wanted - coarse
            apart = chosen[i] - (2.0 * fine - wanted)
            own = noise[2]
            used[i] = lengths[2]
        elif stretch[i, scale - 1] >= _CLOSED:
            openness = stretch[i, scale - 1]
            chosen[i] = fine
            apart = fine - wanted
            own = noise[1]
            used[i] = lengths[1]
        else:
            openness = 1.0
            chosen[i] = tensors[i, 0]
            apart = chosen[i]
            # Nothing tells a flat speck from a curved one of the same size.
            own = np.hypot(noise[0], 1.0 / spacing)
            used[i] = lengths[0]
        # The bias left is c s^4 and a quarter of that at the finer scale less, so 4/3 of what the
        # two differ by; their noise is in it too, which is on the safe side.
        own /= min(openness, 1.0)
        bias = 0.5 * (apart[0] ** 2 + apart[2] ** 2) + apart[1] ** 2
        size = chosen[i, 0] ** 2 + 2.0 * chosen[i, 1] ** 2 + chosen[i, 2] ** 2
        facets = _FACETS * size * np.sqrt(size) * spacing * spacing
        square[i] = own * own + _LEFT * _LEFT * bias + facets * facets
    return chosen, square, used


@compiled(parallel=True)
def _principal(
    normals: FloatArray, tensors: FloatArray, factor: float
) -> tuple[FloatArray, FloatArray]:
    k = np.empty((2, len(normals)))
    directions = np.empty((2, len(normals), 3))
    for i in prange(len(normals)):
        n = (normals[i, 0], normals[i, 1], normals[i, 2])
        tensor = (factor * tensors[i, 0], factor * tensors[i, 1], factor * tensors[i, 2])
        write_principal(i, n, tensor, k, directions)
    return k, directions
