"""Means over the faces around each vertex: what a vertex stands for on a noisy mesh."""

from typing import NamedTuple

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.geometry import Corners, edge, other_two
from lutcore.mesh import TriangleMesh


class Stars(NamedTuple):
    """The star of each vertex: the faces around it.

    Parameters
    ----------
    areas : ndarray, shape=(n,)
        A third of the area of the star, mesh unit squared.
    fields : ndarray, shape=(n, 6)
        Position and unit normal. The normal is the mean over the star weighted by area; where the
        faces cancel (a double-sided sheet), the largest face's. The position is moved along the
        tangent plane to the star's mean.
    """

    areas: FloatArray
    fields: FloatArray


def stars(mesh: TriangleMesh, corners: Corners) -> Stars:
    """Return the means over the stars of a mesh.

    Positions are averaged with the same weights as normals, so that both tell of the same place:
    with random triangles that halves and quarters the error that a vertex's own position leaves.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    corners : Corners
        Its corners by vertex.

    Returns
    -------
    Stars
        Areas, positions, normals.
    """
    areas, fields = np.empty(len(mesh.vertices)), np.empty((len(mesh.vertices), 6))
    _stars(mesh.vertices, mesh.faces, corners.start, corners.corner, areas, fields)
    return Stars(areas, fields)


@compiled(parallel=True)
def _stars(
    vertices: FloatArray,
    faces: IndexArray,
    start: IndexArray,
    corner: IndexArray,
    areas: FloatArray,
    fields: FloatArray,
) -> None:
    for vertex in prange(len(vertices)):
        total = px = py = pz = nx = ny = nz = 0.0
        largest = mx = my = mz = 0.0
        for at in range(start[vertex], start[vertex + 1]):
            after, before = other_two(faces, corner[at])
            ux, uy, uz = edge(vertices, vertex, after)
            vx, vy, vz = edge(vertices, vertex, before)
            x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
            size = np.sqrt(x * x + y * y + z * z)
            total += size
            nx, ny, nz = nx + x, ny + y, nz + z
            px, py, pz = px + size * (ux + vx), py + size * (uy + vy), pz + size * (uz + vz)
            if size > largest:
                largest, mx, my, mz = size, x, y, z
        length = np.sqrt(nx * nx + ny * ny + nz * nz)
        if length <= 1e-12 * largest:
            nx, ny, nz, length = mx, my, mz, largest
        if length == 0.0:
            total = length = 1.0
        areas[vertex] = total / 6.0
        nx, ny, nz = nx / length, ny / length, nz / length
        # Along the normal the vertex stays: moved to the mean it would sink by the star's sag.
        sag = px * nx + py * ny + pz * nz
        third = 1.0 / (3.0 * total)
        fields[vertex, 0] = vertices[vertex, 0] + third * (px - sag * nx)
        fields[vertex, 1] = vertices[vertex, 1] + third * (py - sag * ny)
        fields[vertex, 2] = vertices[vertex, 2] + third * (pz - sag * nz)
        fields[vertex, 3] = nx
        fields[vertex, 4] = ny
        fields[vertex, 5] = nz
