"""The edges of a mesh, how faces meet along them, and what hangs together.

A half-edge ``h`` runs from corner ``h`` of face ``h // 3`` to that face's next corner.
"""

from dataclasses import dataclass

import numpy as np

from lutcore.arrays import AnyArray, BoolArray, IndexArray


@dataclass(frozen=True)
class Edges:
    """Every edge once, with the half-edges that lie on it.

    Parameters
    ----------
    ends : ndarray, shape=(e, 2)
        Its vertices, the smaller index first.
    of_half : ndarray, shape=(3 m,)
        Edge of each half-edge.
    halves : ndarray, shape=(3 m,)
        Half-edges, grouped by edge.
    start : ndarray, shape=(e,)
        Where each edge's group begins.
    count : ndarray, shape=(e,)
        Number of faces that meet at it.
    forward : ndarray, shape=(e,)
        Number of those that run from the smaller index to the larger.
    """

    ends: AnyArray
    of_half: AnyArray
    halves: AnyArray
    start: AnyArray
    count: AnyArray
    forward: AnyArray

    @property
    def boundary(self) -> BoolArray:
        """True for edges of one face."""
        single: BoolArray = self.count == 1
        return single

    @property
    def flipped(self) -> BoolArray:
        """True for edges whose two faces run along them the same way, so that one is turned."""
        against: BoolArray = (self.count == 2) & (self.forward != 1)
        return against


def edges(faces: IndexArray, vertex_count: int) -> Edges:
    """Find the edges of a mesh.

    Parameters
    ----------
    faces : ndarray of int, shape=(m, 3)
        Triangles with three different vertices each.
    vertex_count : int
        Number of vertices.

    Returns
    -------
    Edges
        All edges.
    """
    tail = faces.reshape(-1).astype(np.int64)
    head = faces[:, [1, 2, 0]].reshape(-1).astype(np.int64)
    key = np.minimum(tail, head) * vertex_count + np.maximum(tail, head)
    halves = np.argsort(key, kind="stable")
    sorted_key = key[halves]
    first = np.ones(len(key), dtype=bool)
    first[1:] = sorted_key[1:] != sorted_key[:-1]
    start = np.flatnonzero(first)
    of_half = np.empty(len(key), dtype=np.int64)
    of_half[halves] = np.cumsum(first) - 1
    forward = np.add.reduceat((tail < head)[halves].astype(np.int64), start)
    ends = np.column_stack(np.divmod(sorted_key[start], vertex_count))
    return Edges(ends, of_half, halves, start, np.diff(start, append=len(key)), forward)


def components(links: AnyArray, count: int) -> tuple[int, AnyArray]:
    """Find what hangs together.

    Parameters
    ----------
    links : ndarray of int, shape=(l, w)
        Each row: things that are linked with one another.
    count : int
        Number of things.

    Returns
    -------
    int
        Number of groups.
    ndarray of int32, shape=(count,)
        Group of each thing; groups are numbered by their first things.
    """
    from lutcore.joining import joined  # compiled: who reads files need not load it

    return joined(np.ascontiguousarray(links), count)


def nonmanifold_vertices(faces: IndexArray, table: Edges, vertex_count: int) -> int:
    """Count the vertices at which more than one fan of faces meets.

    Parameters
    ----------
    faces : ndarray of int, shape=(m, 3)
        Triangles.
    table : Edges
        Their edges.
    vertex_count : int
        Number of vertices.

    Returns
    -------
    int
        Vertices where the surface touches itself in a point only.
    """
    # Corners at one vertex are linked where their faces share an edge; each group is a fan.
    one, two = _neighbouring_halves(table)
    # Corner at the tail of a half-edge, and at its head.
    next_one, next_two = one - one % 3 + (one + 1) % 3, two - two % 3 + (two + 1) % 3
    corner = faces.reshape(-1)
    same = corner[one] == corner[two]
    links = np.concatenate(
        (
            np.column_stack((one, np.where(same, two, next_two))),
            np.column_stack((next_one, np.where(same, next_two, two))),
        )
    )
    groups, label = components(links, len(corner))
    vertex = np.empty(groups, dtype=np.int64)
    vertex[label] = corner
    return int(np.count_nonzero(np.bincount(vertex, minlength=vertex_count) > 1))


def _neighbouring_halves(table: Edges) -> tuple[AnyArray, AnyArray]:
    same_edge = table.of_half[table.halves[1:]] == table.of_half[table.halves[:-1]]
    return table.halves[:-1][same_edge], table.halves[1:][same_edge]
