"""What the facets of a mesh tell at each of its vertices; compiled."""

from typing import NamedTuple

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.geometry import edge
from lutcore.tensors import Vector

_CLOSED = 1e-6


class Facets(NamedTuple):
    """What the facets around each of n vertices tell.

    Parameters
    ----------
    slope : ndarray, shape=(n, 3)
        Gradient of a field along the surface, the mean of the facets' by area.
    area : ndarray, shape=(n,)
        A third of the facets'.
    bare : ndarray, shape=(n, 3)
        Mean of their normals by area, of unit length; zero without a facet.
    grain : ndarray, shape=(n,)
        Mean by area of 1 - cos of the angle between their normals and `bare`.
    corner : ndarray, shape=(n,)
        Share of 2 pi that their angles at the vertex lack, negative where there is more; 0 at
        borders, where the surface ends.
    radius : float
        Thrice the mesh's volume over its area, mesh units: that of a ball; infinite for an open
        surface.
    """

    slope: FloatArray
    area: FloatArray
    bare: FloatArray
    grain: FloatArray
    corner: FloatArray
    radius: float


def facets(points: FloatArray, faces: IndexArray, values: FloatArray) -> Facets:
    """Return what the facets at each vertex tell.

    Parameters
    ----------
    points : ndarray, shape=(n, 3)
        Positions, mesh units.
    faces : ndarray, shape=(m, 3)
        Triangles.
    values : ndarray, shape=(n,)
        A field.

    Returns
    -------
    Facets
        For each vertex.
    """
    slope, bare = np.zeros((len(points), 3)), np.zeros((len(points), 3))
    area, grain, corner = (np.zeros(len(points)) for _ in range(3))
    link = np.zeros(len(points), dtype=np.int32)
    angles = np.empty((len(faces), 2))
    _angles(points, faces, angles)
    radius = _collect(points, faces, values, angles, slope, bare, link, area, grain, corner)
    return Facets(slope, area, bare, grain, corner, radius)


@compiled(parallel=True)
def _angles(points: FloatArray, faces: IndexArray, angles: FloatArray) -> None:
    """Write the angles at the first two corners of each face."""
    for face in prange(len(faces)):
        u, v, n = _sides(points, faces, face)
        twice, uu, uv = np.sqrt(_dot(n, n)), _dot(u, u), _dot(u, v)
        angles[face, 0], angles[face, 1] = np.arctan2(twice, uv), np.arctan2(twice, uu - uv)


@compiled()
def _collect(
    points: FloatArray,
    faces: IndexArray,
    values: FloatArray,
    angles: FloatArray,
    slope: FloatArray,
    bare: FloatArray,
    link: IndexArray,
    area: FloatArray,
    grain: FloatArray,
    corner: FloatArray,
) -> float:
    six, whole, open_x, open_y, open_z = 0.0, 0.0, 0.0, 0.0, 0.0
    for face in range(len(faces)):
        i, j, k = faces[face, 0], faces[face, 1], faces[face, 2]
        first_side, second_side, cross = _sides(points, faces, face)
        (ux, uy, uz), (vx, vy, vz), (nx, ny, nz) = first_side, second_side, cross
        twice, uu = np.sqrt(_dot(cross, cross)), _dot(first_side, first_side)
        uv, vv = _dot(first_side, second_side), _dot(second_side, second_side)
        first, second = angles[face, 0], angles[face, 1]
        corner[i] += first
        corner[j] += second
        corner[k] += np.pi - first - second
        # Steps along the edges opposite a vertex add up to nothing where they go all around it.
        link[i] += k - j
        link[j] += i - k
        link[k] += j - i
        if twice == 0.0:
            continue
        whole += twice
        open_x, open_y, open_z = open_x + nx, open_y + ny, open_z + nz
        six += points[i, 0] * nx + points[i, 1] * ny + points[i, 2] * nz
        along, across = values[j] - values[i], values[k] - values[i]
        s, t = (along * vv - across * uv) / twice, (across * uu - along * uv) / twice
        sx, sy, sz = s * ux + t * vx, s * uy + t * vy, s * uz + t * vz
        for vertex in (i, j, k):
            area[vertex] += twice
            _add(slope, vertex, sx, sy, sz)
            _add(bare, vertex, nx, ny, nz)
    for v in range(len(points)):
        borders = link[v] != 0 or area[v] == 0.0
        corner[v] = 0.0 if borders else 1.0 - corner[v] / (2.0 * np.pi)
        length = np.sqrt(bare[v, 0] ** 2 + bare[v, 1] ** 2 + bare[v, 2] ** 2)
        grain[v] = 1.0 - length / area[v] if area[v] > 0.0 else 0.0
        for axis in range(3):
            slope[v, axis] /= area[v] if area[v] > 0.0 else 1.0
            bare[v, axis] /= length if length > 0.0 else 1.0
        area[v] /= 6.0
    # The normals of a closed surface, by area, add up to nothing.
    unclosed = np.sqrt(open_x * open_x + open_y * open_y + open_z * open_z)
    closed = whole > 0.0 and unclosed < _CLOSED * whole and six > 0.0
    return six / whole if closed else np.inf


@compiled()
def _sides(points: FloatArray, faces: IndexArray, face: int) -> tuple[Vector, Vector, Vector]:
    """Return the sides of a face from its first corner, and their cross product."""
    i, j, k = faces[face, 0], faces[face, 1], faces[face, 2]
    ux, uy, uz = edge(points, i, j)
    vx, vy, vz = edge(points, i, k)
    cross = (uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx)
    return (ux, uy, uz), (vx, vy, vz), cross


@compiled()
def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled()
def _add(to: FloatArray, row: int, x: float, y: float, z: float) -> None:
    to[row, 0] += x
    to[row, 1] += y
    to[row, 2] += z
