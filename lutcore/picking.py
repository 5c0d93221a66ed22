"""The first triangle that a line of sight meets."""

from dataclasses import dataclass

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.mesh import TriangleMesh

_BLOCK = 4096


@dataclass(frozen=True, eq=False)
class Hit:
    """Where a line of sight meets a mesh.

    Parameters
    ----------
    face : int
        Index of the triangle.
    weights : ndarray, shape=(3,)
        Barycentric weights of its corners.
    position : ndarray, shape=(3,)
        The point, mesh units.
    """

    face: int
    weights: FloatArray
    position: FloatArray


def first_hit(mesh: TriangleMesh, start: FloatArray, direction: FloatArray) -> Hit | None:
    """Return where a line of sight first meets a mesh, from either side.

    One line is met by all triangles in turn: for a mesh that changes, or one line, that is sooner
    done than a tree is built.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    start : ndarray, shape=(3,)
        Where the line begins, mesh units.
    direction : ndarray, shape=(3,)
        Where it goes, any length but 0.

    Returns
    -------
    Hit or None
        None if it meets nothing.

    References
    ----------
    T. Moeller and B. Trumbore, Fast, minimum storage ray/triangle intersection, Journal of
    Graphics Tools 2 (1), 1997.
    """
    start, direction = np.asarray(start, float), np.asarray(direction, float)
    blocks = -(-len(mesh.faces) // _BLOCK)
    distances, faces = _nearest(mesh.vertices, mesh.faces, start, direction, blocks)
    if not len(faces) or faces[best := int(np.argmin(distances))] < 0:
        return None
    face, t = int(faces[best]), float(distances[best])
    position = start + t * direction
    a, b, c = mesh.vertices[mesh.faces[face]]
    normal = np.cross(b - a, c - a)
    square = normal @ normal
    weights = np.array(
        [
            np.cross(c - b, position - b) @ normal / square,
            np.cross(a - c, position - c) @ normal / square,
            np.cross(b - a, position - a) @ normal / square,
        ]
    )
    return Hit(face, weights, position)


@compiled(parallel=True)
def _nearest(
    vertices: FloatArray, faces: IndexArray, start: FloatArray, direction: FloatArray, blocks: int
) -> tuple[FloatArray, IndexArray]:
    """Return the nearest hit of each block of triangles: its distance, and its face or -1."""
    distances = np.full(blocks, np.inf)
    found = np.full(blocks, -1, np.int32)
    for block in prange(blocks):
        for face in range(block * _BLOCK, min((block + 1) * _BLOCK, len(faces))):
            t = _distance(vertices, faces, face, start, direction)
            if t < distances[block]:
                distances[block] = t
                found[block] = face
    return distances, found


@compiled()
def _distance(
    vertices: FloatArray, faces: IndexArray, face: int, start: FloatArray, direction: FloatArray
) -> float:
    a, b, c = faces[face, 0], faces[face, 1], faces[face, 2]
    e0, e1, e2 = (
        vertices[b, 0] - vertices[a, 0],
        vertices[b, 1] - vertices[a, 1],
        vertices[b, 2] - vertices[a, 2],
    )
    f0, f1, f2 = (
        vertices[c, 0] - vertices[a, 0],
        vertices[c, 1] - vertices[a, 1],
        vertices[c, 2] - vertices[a, 2],
    )
    d0, d1, d2 = direction[0], direction[1], direction[2]
    p0, p1, p2 = d1 * f2 - d2 * f1, d2 * f0 - d0 * f2, d0 * f1 - d1 * f0
    determinant = e0 * p0 + e1 * p1 + e2 * p2
    if determinant == 0.0:
        return np.inf
    s0, s1, s2 = start[0] - vertices[a, 0], start[1] - vertices[a, 1], start[2] - vertices[a, 2]
    u = (s0 * p0 + s1 * p1 + s2 * p2) / determinant
    if not 0.0 <= u <= 1.0:
        return np.inf
    q0, q1, q2 = s1 * e2 - s2 * e1, s2 * e0 - s0 * e2, s0 * e1 - s1 * e0
    v = (d0 * q0 + d1 * q1 + d2 * q2) / determinant
    if not (v >= 0.0 and u + v <= 1.0):
        return np.inf
    t = (f0 * q0 + f1 * q1 + f2 * q2) / determinant
    return t if t > 0.0 else np.inf
