"""How the faces of a mesh hang together: parts, borders, and where it is no surface."""

from dataclasses import dataclass

import numpy as np

from lutcore.arrays import AnyArray, BoolArray
from lutcore.mesh import TriangleMesh
from lutcore.topology import Edges, components, edges, nonmanifold_vertices

_LISTED_ISLANDS = 10


@dataclass(frozen=True, kw_only=True)
class Connectivity:
    """Counts of what hangs together and what does not.

    Parameters
    ----------
    islands : int
        Number of connected parts.
    island_faces : tuple of int
        Faces of the ten largest parts, largest first.
    boundary_edges, boundary_loops : int
        Edges of one face, and the number of chains that they form: holes and outlines.
    nonmanifold_edges, nonmanifold_vertices : int
        Edges of more than two faces; vertices where the surface touches itself in a point.
    duplicate_faces : int
        Faces with the three vertices of an earlier one.
    flipped_edges : int
        Edges whose two faces are oriented against each other.
    inside_out_islands : int
        Closed, consistently oriented parts of negative volume.
    typical_edge : float
        Median edge length, mesh units; 0 without faces.
    """

    islands: int = 0
    island_faces: tuple[int, ...] = ()
    boundary_edges: int = 0
    boundary_loops: int = 0
    nonmanifold_edges: int = 0
    nonmanifold_vertices: int = 0
    duplicate_faces: int = 0
    flipped_edges: int = 0
    inside_out_islands: int = 0
    typical_edge: float = 0.0


def connectivity(mesh: TriangleMesh) -> Connectivity:
    """Count what hangs together.

    Parameters
    ----------
    mesh : TriangleMesh
        A mesh without coincident or unreferenced vertices and without faces of zero area, as
        `lutcore.weld.weld` makes it.

    Returns
    -------
    Connectivity
        The counts.
    """
    count = len(mesh.vertices)
    table = edges(mesh.faces, count)
    islands, label = components(table.ends, count)
    island = label[mesh.faces[:, 0]]
    sizes = np.sort(np.bincount(island, minlength=islands))[::-1]
    span = mesh.vertices[table.ends[:, 1]] - mesh.vertices[table.ends[:, 0]]
    return Connectivity(
        islands=islands,
        island_faces=tuple(int(size) for size in sizes[:_LISTED_ISLANDS]),
        boundary_edges=int(np.count_nonzero(table.boundary)),
        boundary_loops=_boundary_loops(table, count),
        nonmanifold_edges=int(np.count_nonzero(table.count > 2)),
        nonmanifold_vertices=nonmanifold_vertices(mesh.faces, table, count),
        duplicate_faces=_duplicates(mesh.faces, count),
        flipped_edges=int(np.count_nonzero(table.flipped)),
        inside_out_islands=int(np.count_nonzero(_inside_out(mesh, table, label, islands))),
        typical_edge=float(np.median(np.sqrt(np.einsum("ij,ij->i", span, span)))),
    )


def _boundary_loops(table: Edges, vertex_count: int) -> int:
    ends = table.ends[table.boundary]
    touched = np.zeros(vertex_count, dtype=bool)
    touched[ends.reshape(-1)] = True
    number = np.cumsum(touched) - 1
    return components(number[ends], int(np.count_nonzero(touched)))[0] if len(ends) else 0


def _duplicates(faces: AnyArray, vertex_count: int) -> int:
    low, middle, high = np.sort(faces, axis=1).astype(np.int64).T
    pair = low * vertex_count + middle
    order = np.lexsort((high, pair))
    pair, high = pair[order], high[order]
    return int(np.count_nonzero((pair[1:] == pair[:-1]) & (high[1:] == high[:-1])))


def inside_out_faces(mesh: TriangleMesh) -> BoolArray:
    """Tell which faces belong to closed parts that are inside out.

    Parameters
    ----------
    mesh : TriangleMesh
        A mesh as for `connectivity`.

    Returns
    -------
    ndarray of bool, shape=(m,)
        True where a face's normal points inwards.
    """
    count = len(mesh.vertices)
    table = edges(mesh.faces, count)
    islands, label = components(table.ends, count)
    found: BoolArray = _inside_out(mesh, table, label, islands)[label[mesh.faces[:, 0]]]
    return found


def _inside_out(mesh: TriangleMesh, table: Edges, label: AnyArray, islands: int) -> BoolArray:
    closed = np.ones(islands, dtype=bool)
    closed[label[table.ends[(table.count != 2) | table.flipped, 0]]] = False
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    volume = np.bincount(
        label[mesh.faces[:, 0]], np.einsum("ij,ij->i", np.cross(a, b), c), minlength=islands
    )
    # A part far from the common centre cancels large terms; below this share of them the sign
    # is rounding.
    scale = float(np.abs(mesh.vertices).max()) ** 3 * len(mesh.faces)
    found: BoolArray = closed & (volume < -1e-15 * scale)
    return found
