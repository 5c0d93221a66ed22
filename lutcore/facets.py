"""What the facets of a mesh tell at each of its vertices; compiled."""

from typing import NamedTuple

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.geometry import edge
from lutcore.tensors import Vector, between

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
    sides : ndarray, shape=(n, 6)
        Mean over the facets by area, and over the sides e of each, of e e^T: entries xx, xy, xz,
        yy, yz, zz.
    radius : float
        Thrice the mesh's volume over its area, mesh units: that of a ball; infinite for an open
        surface. A straight tube holds as much as if it had ends.
    """

    slope: FloatArray
    area: FloatArray
    bare: FloatArray
    grain: FloatArray
    corner: FloatArray
    sides: FloatArray
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
    sides = np.zeros((len(points), 6))
    area, grain, corner = (np.zeros(len(points)) for _ in range(3))
    link = np.zeros(len(points), dtype=np.int32)
    angles = np.empty((len(faces), 2))
    _angles(points, faces, angles)
    flux = np.zeros((4, 3))
    per_vertex = (slope, bare, link, area, grain, corner, sides)
    _collect(points, faces, values, angles, flux, *per_vertex)
    return Facets(slope, area, bare, grain, corner, sides, _radius(flux, float(area.sum())))


def _radius(flux: FloatArray, area: float) -> float:
    """Return thrice the volume over the area from twice int x N^T dA and int N dA.

    Over a closed surface the first is the volume times 1, over a straight tube that times 1 - t t^T
    with its axis t: the largest eigenvalue is the volume of both, and int N dA nothing.
    """
    if area == 0.0 or 0.5 * np.linalg.norm(flux[3]) >= _CLOSED * area:
        return np.inf
    volume = 0.25 * float(np.linalg.eigvalsh(flux[:3] + flux[:3].T)[-1])
    return 3.0 * volume / area if volume > 0.0 else np.inf


@compiled(parallel=True)
def in_frames(tensors: FloatArray, directions: FloatArray) -> FloatArray:
    """Return the tangent part of tensors of space in a frame of each vertex.

    Parameters
    ----------
    tensors : ndarray, shape=(n, 6)
        Entries xx, xy, xz, yy, yz, zz.
    directions : ndarray, shape=(n, 2, 3)
        Unit vectors u and v.

    Returns
    -------
    ndarray, shape=(n, 3)
        u.T u, u.T v and v.T v.
    """
    out = np.empty((len(tensors), 3))
    for i in prange(len(tensors)):
        u = (directions[i, 0, 0], directions[i, 0, 1], directions[i, 0, 2])
        v = (directions[i, 1, 0], directions[i, 1, 1], directions[i, 1, 2])
        t = tensors[i]
        out[i, 0], out[i, 1], out[i, 2] = between(t, u, u), between(t, u, v), between(t, v, v)
    return out


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
    flux: FloatArray,
    slope: FloatArray,
    bare: FloatArray,
    link: IndexArray,
    area: FloatArray,
    grain: FloatArray,
    corner: FloatArray,
    sides: FloatArray,
) -> None:
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
        for axis in range(3):
            middle = (points[i, axis] + points[j, axis] + points[k, axis]) / 3.0
            _add(flux, axis, middle * nx, middle * ny, middle * nz)
        _add(flux, 3, nx, ny, nz)
        along, across = values[j] - values[i], values[k] - values[i]
        s, t = (along * vv - across * uv) / twice, (across * uu - along * uv) / twice
        sx, sy, sz = s * ux + t * vx, s * uy + t * vy, s * uz + t * vz
        # e e^T of the sides u, v and v - u adds up to 2 (u u^T + v v^T) - u v^T - v u^T.
        size = twice / 3.0
        px, py, pz = 2.0 * ux - vx, 2.0 * uy - vy, 2.0 * uz - vz
        qx, qy, qz = 2.0 * vx - ux, 2.0 * vy - uy, 2.0 * vz - uz
        xx, xy, xz = ux * px + vx * qx, ux * py + vx * qy, ux * pz + vx * qz
        yy, yz, zz = uy * py + vy * qy, uy * pz + vy * qz, uz * pz + vz * qz
        for vertex in (i, j, k):
            area[vertex] += twice
            row = sides[vertex]
            row[0], row[1], row[2] = row[0] + size * xx, row[1] + size * xy, row[2] + size * xz
            row[3], row[4], row[5] = row[3] + size * yy, row[4] + size * yz, row[5] + size * zz
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
        for entry in range(6):
            sides[v, entry] /= area[v] if area[v] > 0.0 else 1.0
        area[v] /= 6.0


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
