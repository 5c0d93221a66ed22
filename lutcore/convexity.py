"""The convex part S+ of the shape operator, and what shading asks of it, for compiled loops."""

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled


@compiled()
def bending(shape: FloatArray, vertex: int, x: float, y: float, z: float) -> float:
    """Return |S+ w_t|, how fast N.w changes over the surface.

    Parameters
    ----------
    shape : ndarray, shape=(n, 6)
        `lutcore.shading.ShadingInputs.shape`.
    vertex : int
        Which vertex.
    x, y, z : float
        Unit vector w to the light. S+ is tangent, so w itself stands for its tangent part w_t.

    Returns
    -------
    float
        The paper's sqrt(w1^2 k1^2 + w2^2 k2^2) with concave curvature 0, 1/mm.
    """
    xx, yy, zz = shape[vertex, 0], shape[vertex, 1], shape[vertex, 2]
    xy, yz, xz = shape[vertex, 3], shape[vertex, 4], shape[vertex, 5]
    along_x = xx * x + xy * y + xz * z
    along_y = xy * x + yy * y + yz * z
    along_z = xz * x + yz * y + zz * z
    length: float = np.sqrt(along_x * along_x + along_y * along_y + along_z * along_z)
    return length


@compiled()
def invariants(shape: FloatArray, vertex: int) -> tuple[float, float]:
    """Return the sum and the sum of squares of the convex principal curvatures.

    Parameters
    ----------
    shape : ndarray, shape=(n, 6)
        `lutcore.shading.ShadingInputs.shape`.
    vertex : int
        Which vertex.

    Returns
    -------
    tuple of float
        k1 + k2 in 1/mm and k1^2 + k2^2 in 1/mm^2, concave curvature being 0.
    """
    xx, yy, zz = shape[vertex, 0], shape[vertex, 1], shape[vertex, 2]
    xy, yz, xz = shape[vertex, 3], shape[vertex, 4], shape[vertex, 5]
    squares = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + xz * xz)
    return xx + yy + zz, squares


@compiled(parallel=True)
def convex_part(
    k1: FloatArray, k2: FloatArray, d1: FloatArray, d2: FloatArray, per_mm: float
) -> FloatArray:
    """Return S+ of every vertex, as `lutcore.shading.ShadingInputs.shape` holds it.

    Parameters
    ----------
    k1, k2 : ndarray, shape=(n,)
        Principal curvatures, convex positive, 1/mesh unit.
    d1, d2 : ndarray, shape=(n, 3)
        Their unit directions.
    per_mm : float
        Mesh units in one millimetre.

    Returns
    -------
    ndarray, shape=(n, 6)
        Entries xx, yy, zz, xy, yz, xz, 1/mm; concave curvature is 0.
    """
    shape = np.empty((len(k1), 6))
    for i in prange(len(k1)):
        p, q = max(k1[i], 0.0) * per_mm, max(k2[i], 0.0) * per_mm
        ux, uy, uz = d1[i, 0], d1[i, 1], d1[i, 2]
        vx, vy, vz = d2[i, 0], d2[i, 1], d2[i, 2]
        shape[i, 0] = p * ux * ux + q * vx * vx
        shape[i, 1] = p * uy * uy + q * vy * vy
        shape[i, 2] = p * uz * uz + q * vz * vz
        shape[i, 3] = p * ux * uy + q * vx * vy
        shape[i, 4] = p * uy * uz + q * vy * vz
        shape[i, 5] = p * ux * uz + q * vx * vz
    return shape
