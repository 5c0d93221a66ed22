"""From what another package tells of a mesh to `PrincipalCurvatures`, in our terms."""

import numpy as np
from numba import prange

from lutcore.arrays import BoolArray, FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.curvature import PrincipalCurvatures
from lutcore.geometry import (
    Corners,
    other_two,
    vertex_corners,
    vertex_normals,
)
from lutcore.mesh import TriangleMesh
from lutcore.tensors import tangent_frame


def completed(
    mesh: TriangleMesh,
    one: FloatArray,
    other: FloatArray,
    *,
    along: FloatArray | None = None,
    scale: float = 0.0,
    reach: float = 1.0,
) -> PrincipalCurvatures:
    """Return curvatures that came without normals and error bars, with both.

    Normals are ours, of the one-ring. Values that are not finite count as not estimated.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    one, other : ndarray, shape=(n,)
        The two curvatures of each vertex, in either order, convex positive, 1/mesh unit.
    along : ndarray, shape=(n, 3), optional
        Directions that belong to `one`, of any length; without them no direction is estimated.
    scale : float
        Length over which the surface was averaged, mesh units.
    reach : float
        The same in spacings of the mesh, for `spread`.

    Returns
    -------
    PrincipalCurvatures
        One value for each vertex.
    """
    corners = vertex_corners(mesh)
    normals = vertex_normals(mesh, corners)
    known = np.isfinite(one) & np.isfinite(other)
    one, other = np.where(known, one, 0.0), np.where(known, other, 0.0)
    k1, k2 = np.maximum(one, other), np.minimum(one, other)
    error = spread(mesh, corners, k1, k2, known, reach)
    first = np.zeros_like(normals) if along is None else np.where(known[:, None], along, 0.0)
    d1, d2 = _frames(normals, first, one < other)
    return PrincipalCurvatures(
        k1, k2, d1, d2, normals, np.where(known, error, np.inf), scale, along is not None
    )


def spread(
    mesh: TriangleMesh,
    corners: Corners,
    k1: FloatArray,
    k2: FloatArray,
    known: BoolArray,
    reach: float,
) -> FloatArray:
    """Return by how much curvatures differ from their average over the method's reach.

    This is the error bar of methods that give none. It holds noise, and detail of the surface
    finer than the reach; not the bias, which is alike at neighbours.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    corners : Corners
        Its corners by vertex.
    k1, k2 : ndarray, shape=(n,)
        Curvatures, 1/mesh unit.
    known : ndarray of bool, shape=(n,)
        Where they were estimated; others are left out.
    reach : float
        Length over which errors of neighbours are alike, in spacings.

    Returns
    -------
    ndarray, shape=(n,)
        Root mean square over k1, k2 and the star of the vertex, 1/mesh unit.
    """
    # The mean over a star has a deviation of some spacing: n of them, of its root.
    steps = max(1, round(reach * reach))
    around = (mesh.faces, corners.start, corners.corner)
    values = np.stack([k1, k2], axis=1)
    average = values
    for _ in range(steps):
        average = _star_means(*around, average, known)
    off: FloatArray = np.square(values - average).mean(axis=1)
    return np.sqrt(_star_means(*around, off[:, None], known)[:, 0])


@compiled(parallel=True)
def _star_means(
    faces: IndexArray,
    start: IndexArray,
    corner: IndexArray,
    values: FloatArray,
    known: BoolArray,
) -> FloatArray:
    """Return the means over each vertex and its neighbours."""
    out = np.zeros_like(values)
    for vertex in prange(len(values)):
        count = 0.0
        if known[vertex]:
            out[vertex] += values[vertex]
            count += 1.0
        for at in range(start[vertex], start[vertex + 1]):
            after, before = other_two(faces, corner[at])
            for other in (after, before):
                if known[other]:
                    out[vertex] += 0.5 * values[other]
                    count += 0.5
        out[vertex] /= max(count, 0.5)
    return out


@compiled(parallel=True)
def _frames(
    normals: FloatArray, along: FloatArray, turned: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """Return d1 and d2: `along` in the tangent plane, turned by 90 degrees where it is d2."""
    d1, d2 = np.empty_like(normals), np.empty_like(normals)
    for i in prange(len(normals)):
        n = (normals[i, 0], normals[i, 1], normals[i, 2])
        u, v = tangent_frame(n[0], n[1], n[2])
        a = b = 0.0
        for axis in range(3):
            a, b = a + along[i, axis] * u[axis], b + along[i, axis] * v[axis]
        # A direction may be too small to be squared, or to be divided by its own length.
        largest = max(abs(a), abs(b))
        a, b = (a / largest, b / largest) if 0.0 < largest < np.inf else (1.0, 0.0)
        length = np.hypot(a, b)
        a, b = a / length, b / length
        if turned[i]:
            a, b = b, -a
        for axis in range(3):
            d1[i, axis] = a * u[axis] + b * v[axis]
            d2[i, axis] = a * v[axis] - b * u[axis]
    return d1, d2
