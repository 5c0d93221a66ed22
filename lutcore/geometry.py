"""Areas and normals of a mesh, and which corners meet at each vertex; compiled, race-free.

A corner ``c`` is corner ``c % 3`` of face ``c // 3``. Every vertex gathers from its own corners,
so the loops over vertices run in parallel and give the same bits on any number of threads.
"""

from typing import NamedTuple

import numba
import numpy as np
from numba import prange

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.mesh import TriangleMesh

# Each chunk of the counting sort holds a number for every vertex.
_MOST_CHUNKS = 8


class Corners(NamedTuple):
    """The corners at each vertex: those of vertex v are ``corner[start[v]:start[v + 1]]``.

    Parameters
    ----------
    start : ndarray of int32, shape=(n + 1,)
        Where each vertex's corners begin.
    corner : ndarray of int32, shape=(3 m,)
        Corners, in ascending order within a vertex.
    """

    start: IndexArray
    corner: IndexArray


def vertex_corners(mesh: TriangleMesh) -> Corners:
    """Return which corners meet at each vertex.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.

    Returns
    -------
    Corners
        The corners, grouped by vertex.
    """
    chunks, count = min(numba.get_num_threads(), _MOST_CHUNKS), len(mesh.vertices)
    start, corner = np.empty(count + 1, np.int32), np.empty(mesh.faces.size, np.int32)
    _vertex_corners(mesh.faces, np.zeros((chunks, count), np.int32), start, corner)
    return Corners(start, corner)


def face_areas(mesh: TriangleMesh) -> FloatArray:
    """Return the area of each face.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.

    Returns
    -------
    ndarray, shape=(m,)
        Areas, mesh unit squared.
    """
    return 0.5 * np.sqrt(np.square(_face_crosses(mesh)).sum(axis=1))


def face_normals(mesh: TriangleMesh) -> FloatArray:
    """Return the outward unit normal of each face.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.

    Returns
    -------
    ndarray, shape=(m, 3)
        Unit normals, zero for faces of zero area.
    """
    crosses = _face_crosses(mesh)
    length = np.sqrt(np.square(crosses).sum(axis=1, keepdims=True))
    return np.divide(crosses, length, out=np.zeros_like(crosses), where=length > 0.0)


def vertex_areas(mesh: TriangleMesh, corners: Corners) -> FloatArray:
    """Return a third of the area of the faces around each vertex.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    corners : Corners
        Its corners by vertex.

    Returns
    -------
    ndarray, shape=(n,)
        Areas, mesh unit squared; 0 where a vertex has no face.
    """
    areas = np.empty(len(mesh.vertices))
    _vertex_areas(mesh.vertices, mesh.faces, corners.start, corners.corner, areas)
    return areas


def vertex_normals(mesh: TriangleMesh, corners: Corners) -> FloatArray:
    """Return the outward unit normal at each vertex, exact for vertices on a sphere.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    corners : Corners
        Its corners by vertex.

    Returns
    -------
    ndarray, shape=(n, 3)
        Unit normals; zero only where a vertex has no face with an area.

    References
    ----------
    N. Max, Weights for computing vertex normals from facet normals, J. Graphics Tools 4 (2),
    1999.
    """
    return _normals(mesh, corners, False)


def area_normals(mesh: TriangleMesh, corners: Corners) -> FloatArray:
    """Return unit normals weighted by area, those that suffer least from noise.

    A weighting by short edges, as in `vertex_normals`, multiplies the noise of slivers.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    corners : Corners
        Its corners by vertex.

    Returns
    -------
    ndarray, shape=(n, 3)
        Unit normals; zero only where a vertex has no face with an area.
    """
    return _normals(mesh, corners, True)


def _normals(mesh: TriangleMesh, corners: Corners, by_area: bool) -> FloatArray:
    normals = np.empty((len(mesh.vertices), 3))
    _vertex_normals(mesh.vertices, mesh.faces, corners.start, corners.corner, by_area, normals)
    return normals


def median_vertex_area(areas: FloatArray) -> float:
    """Return the median of the vertex areas, the square of the mesh's typical spacing.

    Parameters
    ----------
    areas : ndarray, shape=(n,)
        From `vertex_areas`.

    Returns
    -------
    float
        The median over vertices with an area, mesh unit squared.
    """
    return float(np.median(areas[areas > 0.0]))


def typical_spacing(mesh: TriangleMesh) -> float:
    """Return the square root of the median vertex area.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.

    Returns
    -------
    float
        The mesh's typical spacing, mesh units.
    """
    return float(np.sqrt(median_vertex_area(vertex_areas(mesh, vertex_corners(mesh)))))


@compiled(parallel=True)
def _vertex_corners(
    faces: IndexArray, place: IndexArray, start: IndexArray, corner: IndexArray
) -> None:
    """Write the corners; `place` is all zero, with a row for each chunk of faces."""
    face_count = faces.shape[0]
    chunks, vertex_count = place.shape
    for chunk in prange(chunks):
        for face in range(face_count * chunk // chunks, face_count * (chunk + 1) // chunks):
            for j in range(3):
                place[chunk, faces[face, j]] += 1
    total = 0
    for vertex in range(vertex_count):
        start[vertex] = total
        for chunk in range(chunks):
            count = place[chunk, vertex]
            place[chunk, vertex] = total
            total += count
    start[vertex_count] = total
    # Chunks are consecutive faces, so the order within a vertex does not depend on their number.
    for chunk in prange(chunks):
        for face in range(face_count * chunk // chunks, face_count * (chunk + 1) // chunks):
            for j in range(3):
                vertex = faces[face, j]
                corner[place[chunk, vertex]] = 3 * face + j
                place[chunk, vertex] += 1


def _face_crosses(mesh: TriangleMesh) -> FloatArray:
    crosses = np.empty((len(mesh.faces), 3))
    _write_face_crosses(mesh.vertices, mesh.faces, crosses)
    return crosses


@compiled(parallel=True)
def _write_face_crosses(vertices: FloatArray, faces: IndexArray, crosses: FloatArray) -> None:
    for face in prange(faces.shape[0]):
        a, b, c = faces[face, 0], faces[face, 1], faces[face, 2]
        ux, uy, uz = edge(vertices, a, b)
        vx, vy, vz = edge(vertices, a, c)
        crosses[face, 0] = uy * vz - uz * vy
        crosses[face, 1] = uz * vx - ux * vz
        crosses[face, 2] = ux * vy - uy * vx


@compiled()
def edge(vertices: FloatArray, tail: int, head: int) -> tuple[float, float, float]:
    """Return the vector from one vertex to another (for compiled loops).

    Parameters
    ----------
    vertices : ndarray, shape=(n, 3)
        Positions.
    tail, head : int
        Vertices.

    Returns
    -------
    tuple of float
        Its three components.
    """
    return (
        vertices[head, 0] - vertices[tail, 0],
        vertices[head, 1] - vertices[tail, 1],
        vertices[head, 2] - vertices[tail, 2],
    )


@compiled()
def other_two(faces: IndexArray, corner: int) -> tuple[int, int]:
    """Return the vertices that follow and precede a corner in its face (for compiled loops).

    Parameters
    ----------
    faces : ndarray, shape=(m, 3)
        Vertices of each face.
    corner : int
        A corner.

    Returns
    -------
    tuple of int
        The next and the previous vertex.
    """
    face = corner // 3
    j = corner - 3 * face
    return faces[face, (j + 1) % 3], faces[face, (j + 2) % 3]


@compiled(parallel=True)
def _vertex_areas(
    vertices: FloatArray,
    faces: IndexArray,
    start: IndexArray,
    corner: IndexArray,
    areas: FloatArray,
) -> None:
    for vertex in prange(len(vertices)):
        total = 0.0
        for at in range(start[vertex], start[vertex + 1]):
            after, before = other_two(faces, corner[at])
            ux, uy, uz = edge(vertices, vertex, after)
            vx, vy, vz = edge(vertices, vertex, before)
            x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
            total += np.sqrt(x * x + y * y + z * z)
        areas[vertex] = total / 6.0


@compiled(parallel=True)
def _vertex_normals(
    vertices: FloatArray,
    faces: IndexArray,
    start: IndexArray,
    corner: IndexArray,
    by_area: bool,
    normals: FloatArray,
) -> None:
    for vertex in prange(len(vertices)):
        nx = ny = nz = 0.0
        largest = mx = my = mz = 0.0
        for at in range(start[vertex], start[vertex + 1]):
            after, before = other_two(faces, corner[at])
            ux, uy, uz = edge(vertices, vertex, after)
            vx, vy, vz = edge(vertices, vertex, before)
            x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
            lengths = (ux * ux + uy * uy + uz * uz) * (vx * vx + vy * vy + vz * vz)
            size = x * x + y * y + z * z
            if size == 0.0:
                continue
            weight = 1.0 if by_area else 1.0 / lengths  # Max 1999
            nx, ny, nz = nx + weight * x, ny + weight * y, nz + weight * z
            if size > largest:
                largest, mx, my, mz = size, x, y, z
        length = np.sqrt(nx * nx + ny * ny + nz * nz)
        # Faces that cancel (a double-sided sheet) leave no mean normal: take the largest's.
        if length <= 1e-12 * (np.sqrt(largest) if by_area else 1.0 / np.sqrt(largest)):
            nx, ny, nz, length = mx, my, mz, np.sqrt(largest)
        if length == 0.0:
            length = 1.0
        normals[vertex, 0] = nx / length
        normals[vertex, 1] = ny / length
        normals[vertex, 2] = nz / length
