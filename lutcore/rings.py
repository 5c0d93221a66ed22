"""Who is next to whom: the vertices that share an edge with each vertex."""

import numpy as np
from numba import prange

from lutcore.arrays import IndexArray
from lutcore.compiled import compiled
from lutcore.geometry import Corners, other_two
from lutcore.mesh import TriangleMesh

# Stars of more corners are sorted; in smaller ones looking at all is faster.
_SMALL = 24


def neighbours(mesh: TriangleMesh, corners: Corners) -> tuple[IndexArray, IndexArray]:
    """Return the neighbours of each vertex.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface, n vertices.
    corners : Corners
        Its corners by vertex.

    Returns
    -------
    start : ndarray of int32, shape=(n + 1,)
        Where each vertex's neighbours begin.
    neighbour : ndarray of int32, shape=(e,)
        The vertices that share an edge with each vertex, once each.
    """
    ring = np.empty(2 * len(corners.corner), np.int32)
    start = np.zeros(len(corners.start), np.int32)
    _rings(mesh.faces, corners.start, corners.corner, ring, start[1:])
    np.cumsum(start, out=start)
    neighbour = np.empty(start[-1], np.int32)
    _joined(ring, corners.start, start, neighbour)
    return start, neighbour


@compiled()
def slot_of(neighbour: IndexArray, first: int, last: int, other: int) -> int:
    """Return where a vertex stands among the neighbours of another.

    Parameters
    ----------
    neighbour : ndarray of int32
        From `neighbours`.
    first, last : int
        Where the neighbours of that vertex begin and end.
    other : int
        One of them.

    Returns
    -------
    int
        Its index in `neighbour`.
    """
    if last - first <= _SMALL:
        for slot in range(first, last):
            if neighbour[slot] == other:
                return slot
    low, high = first, last
    while low < high:  # large stars are sorted
        middle = (low + high) // 2
        if neighbour[middle] < other:
            low = middle + 1
        else:
            high = middle
    return low


@compiled(parallel=True)
def _rings(
    faces: IndexArray, start: IndexArray, corner: IndexArray, ring: IndexArray, count: IndexArray
) -> None:
    """Write each vertex's neighbours, once each, from ``ring[2 * start[vertex]]`` on."""
    for vertex in prange(len(count)):
        base = 2 * start[vertex]
        corners = start[vertex + 1] - start[vertex]
        found = 0
        for at in range(start[vertex], start[vertex + 1]):
            for other in other_two(faces, corner[at]):
                known = False
                if corners <= _SMALL:
                    for slot in range(base, base + found):
                        if ring[slot] == other:
                            known = True
                            break
                if not known:
                    ring[base + found] = other
                    found += 1
        if corners > _SMALL:
            found = _distinct(ring[base : base + found])
        elif found > _SMALL:
            ring[base : base + found].sort()
        count[vertex] = found


@compiled()
def _distinct(values: IndexArray) -> int:
    """Sort values, move the distinct ones to the front, and return how many there are."""
    values.sort()
    found = 0
    for at in range(len(values)):
        if at == 0 or values[at] != values[found - 1]:
            values[found] = values[at]
            found += 1
    return found


@compiled(parallel=True)
def _joined(
    ring: IndexArray, corner_start: IndexArray, start: IndexArray, neighbour: IndexArray
) -> None:
    for vertex in prange(len(start) - 1):
        first = 2 * corner_start[vertex]
        for slot in range(start[vertex + 1] - start[vertex]):
            neighbour[start[vertex] + slot] = ring[first + slot]
