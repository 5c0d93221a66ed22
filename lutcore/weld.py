"""A mesh as estimators want it: centred, coincident vertices merged, nothing degenerate.

The bits of two positions must agree for their vertices to be merged: that joins triangle soup
(STL) and duplicated seams, and never closes a gap that is in the data.
"""

from dataclasses import dataclass

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import AnyArray, BoolArray, FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.mesh import TriangleMesh

# A face whose doubled area is below this share of its longest edge squared has no normal: at
# that thinness a float64 cross product is rounding.
_THINNEST = 1e-12


@dataclass(frozen=True)
class Welded:
    """A mesh made ready, and the way back.

    Parameters
    ----------
    mesh : TriangleMesh or None
        The ready mesh; None if no face of the input has an area.
    index : ndarray of int32, shape=(n,)
        Vertex of `mesh` that stands for each vertex of the input; -1 for one without faces.
    moved : bool
        Whether the two number the vertices differently.
    """

    mesh: TriangleMesh | None
    index: IndexArray
    moved: bool

    def spread(self, values: AnyArray, missing: AnyArray | float) -> AnyArray:
        """Return values of the ready mesh's vertices as values of the input's vertices.

        Parameters
        ----------
        values : ndarray, shape=(w, ...)
            One value for each vertex of the ready mesh.
        missing : float or ndarray
            Value where the input's vertex has no face.

        Returns
        -------
        ndarray, shape=(n, ...)
            One value for each vertex of the input, in its order.
        """
        if not self.moved:
            return values
        # Rows are copied whole, several times as fast as by indexing; -1 takes the first.
        out: AnyArray = np.take(values, self.index, axis=0, mode="clip")
        out[np.flatnonzero(self.index < 0)] = missing
        return out

    def gather(self, values: FloatArray) -> FloatArray:
        """Return values of the input's vertices as values of the ready mesh's vertices.

        Parameters
        ----------
        values : ndarray, shape=(n,)
            One value for each vertex of the input.

        Returns
        -------
        ndarray, shape=(w,)
            Where vertices were merged, the value of the last of them.
        """
        assert self.mesh is not None
        out = np.empty(len(self.mesh.vertices))
        kept = self.index >= 0
        out[self.index[kept]] = values[kept]
        return out


def weld(mesh: TriangleMesh) -> Welded:
    """Centre a mesh, merge its coincident vertices and drop what carries no surface.

    Parameters
    ----------
    mesh : TriangleMesh
        Any mesh.

    Returns
    -------
    Welded
        The ready mesh and the map back to the input's vertices.

    Notes
    -----
    A part some 1e15 times smaller than the mesh has an area of its own, and none beside the mesh's
    middle, from which estimators see it: there its vertices round to the same places. Then what
    centring brought together is merged too, and its faces are dropped.
    """
    welded, lowest = _merged(mesh)
    while welded.mesh is not None and lowest < _rounding(welded.mesh.vertices):
        faces = len(welded.mesh.faces)
        second, lowest = _merged(welded.mesh)
        welded = _chained(welded, second)
        if second.mesh is None or len(second.mesh.faces) == faces:
            break
    return welded


def _rounding(centred: FloatArray) -> float:
    """Return how much lower a triangle may have become by centring: a bound, mesh units."""
    return float(16.0 * np.finfo(np.float64).eps * max(centred.max(), -centred.min()))


def _chained(first: Welded, second: Welded) -> Welded:
    """Return two steps as one."""
    index = np.where(first.index >= 0, second.index[first.index], np.int32(-1))
    return Welded(second.mesh, index, first.moved or second.moved)


def _merged(mesh: TriangleMesh) -> tuple[Welded, float]:
    """Merge once; also return the least height of a triangle that is left."""
    same = np.empty(len(mesh.vertices), np.int32)
    bits = max(4, (2 * len(same) - 1).bit_length())
    _first_of_same(mesh.vertices, np.zeros(1 << bits, np.uint64), same)
    good, used = np.empty(len(mesh.faces), np.bool_), np.zeros(len(same), np.bool_)
    lowest = _good_faces(mesh.vertices, mesh.faces, same, good, used)
    kept = int(np.count_nonzero(used))
    if kept == 0:
        return Welded(None, np.full(len(mesh.vertices), -1, np.int32), True), lowest
    if kept == len(used):
        index = np.arange(kept, dtype=np.int32)
        points, faces = mesh.vertices, mesh.faces
        if not good.all():
            faces = faces[good]
    else:
        index, points = np.full(len(used), -1, np.int32), np.empty((kept, 3))
        faces = np.empty((int(np.count_nonzero(good)), 3), np.int32)
        _renumber(mesh.vertices, mesh.faces, same, good, used, index, points, faces)
    centred = np.empty_like(points)
    _centre(points, centred)
    ready = TriangleMesh.trusted(centred, faces)
    return Welded(ready, index, kept != len(used)), lowest


@compiled()
def _renumber(
    vertices: FloatArray,
    faces: IndexArray,
    same: IndexArray,
    good: BoolArray,
    used: BoolArray,
    index: IndexArray,
    points: FloatArray,
    ready: IndexArray,
) -> None:
    """Write the vertices that are used and the good faces, and where vertices went.

    The index is -1 everywhere before; it stays so where no face names the vertex, which does not
    become part of a surface by lying on it.
    """
    number = np.empty(len(used), np.int32)
    count = 0
    for vertex in range(len(used)):
        number[vertex] = -1
        if used[vertex]:
            for axis in range(3):
                points[count, axis] = vertices[vertex, axis]
            number[vertex] = count
            count += 1
    count = 0
    for face in range(len(faces)):
        for j in range(3):
            vertex = faces[face, j]
            index[vertex] = number[same[vertex]]
        if good[face]:
            for j in range(3):
                ready[count, j] = index[faces[face, j]]
            count += 1


@compiled(parallel=True)
def _centre(points: FloatArray, out: FloatArray) -> None:
    """Write the points relative to the middle of the box around them."""
    middle = np.empty(3)
    for axis in prange(3):
        low = high = points[0, axis]
        for i in range(len(points)):
            low, high = min(low, points[i, axis]), max(high, points[i, axis])
        middle[axis] = 0.5 * (low + high)
    for i in prange(len(points)):
        for axis in range(3):
            out[i, axis] = points[i, axis] - middle[axis]


@compiled()
def _first_of_same(vertices: FloatArray, table: NDArray[np.uint64], first: IndexArray) -> None:
    """Write for each vertex the first vertex with the same position, by open addressing.

    The table is empty, as long as a power of two, and twice as long as there are vertices.
    """
    count = len(vertices)
    mask = np.uint64(len(table) - 1)
    # A slot holds vertex + 1 and, above it, 32 bits of the hash: most unlike vertices are told
    # apart without looking at their positions.
    words = vertices.view(np.uint64)
    sign = np.uint64(1 << 63)
    for vertex in range(count):
        code = np.uint64(0)
        for axis in range(3):
            word = words[vertex, axis]
            if word == sign:  # minus zero is zero
                word = np.uint64(0)
            code = (code ^ word) * np.uint64(0x9E3779B97F4A7C15)
            code ^= code >> np.uint64(29)
        slot = code & mask
        tag = (code >> np.uint64(32)) << np.uint64(32)
        while True:
            entry = table[slot]
            if entry == 0:
                table[slot] = tag | np.uint64(vertex + 1)
                first[vertex] = vertex
                break
            if (entry ^ tag) >> np.uint64(32) == 0:
                other = np.int64(entry & np.uint64(0xFFFFFFFF)) - 1
                if (
                    vertices[other, 0] == vertices[vertex, 0]
                    and vertices[other, 1] == vertices[vertex, 1]
                    and vertices[other, 2] == vertices[vertex, 2]
                ):
                    first[vertex] = other
                    break
            slot = (slot + np.uint64(1)) & mask


@compiled()
def _height(vertices: FloatArray, a: int, b: int, c: int) -> float:
    """Return 1 to 3.5 times a triangle's height over its longest edge; 0 where that is rounding.

    Worked out at unit size, so that no square is 0 or infinite.
    """
    ux = vertices[b, 0] - vertices[a, 0]
    uy = vertices[b, 1] - vertices[a, 1]
    uz = vertices[b, 2] - vertices[a, 2]
    vx = vertices[c, 0] - vertices[a, 0]
    vy = vertices[c, 1] - vertices[a, 1]
    vz = vertices[c, 2] - vertices[a, 2]
    size = max(abs(ux), abs(uy), abs(uz), abs(vx), abs(vy), abs(vz))
    unit = 1.0 / size if size > 1e-300 else 0.0
    ux, uy, uz = ux * unit, uy * unit, uz * unit
    vx, vy, vz = vx * unit, vy * unit, vz * unit
    wx, wy, wz = vx - ux, vy - uy, vz - uz
    longest = max(
        ux * ux + uy * uy + uz * uz,
        vx * vx + vy * vy + vz * vz,
        wx * wx + wy * wy + wz * wz,
    )
    x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    area = np.sqrt(x * x + y * y + z * z)
    if not area > _THINNEST * longest:
        return 0.0
    # The longest edge is 1 to 3.5 times `size`.
    return size * area


@compiled(parallel=True)
def _good_faces(
    vertices: FloatArray, faces: IndexArray, same: IndexArray, good: BoolArray, used: BoolArray
) -> float:
    """Write which faces have an area, which vertices those use; return their least height."""
    lowest = np.inf
    for face in prange(len(faces)):
        height = _height(vertices, same[faces[face, 0]], same[faces[face, 1]], same[faces[face, 2]])
        good[face] = height > 0.0
        lowest = min(lowest, height if height > 0.0 else np.inf)
    for face in range(len(faces)):
        if good[face]:
            for j in range(3):
                used[same[faces[face, j]]] = True
    return lowest
