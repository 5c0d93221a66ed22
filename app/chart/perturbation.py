"""Noise added to a mesh whose true surface nobody knows."""

from collections.abc import Callable

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.geometry import vertex_corners, vertex_normals
from lutcore.mesh import TriangleMesh
from lutcore.topology import edges
from lutcore.weld import weld


def perturbation(mesh: TriangleMesh, share: float) -> Callable[[int], TriangleMesh]:
    """Return the function that moves every vertex of a mesh along its normal.

    Coincident vertices move together, so that no seam opens.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    share : float
        Standard deviation of the white noise, as a share of the mean edge at the vertex.

    Returns
    -------
    callable
        From a seed to a mesh with the same vertices in the same order.
    """
    welded = weld(mesh)
    if welded.mesh is None:
        return lambda seed: mesh
    joined = welded.mesh
    normals = vertex_normals(joined, vertex_corners(joined))
    directions = share * normals * _mean_edges(joined)[:, None]

    def moved(seed: int) -> TriangleMesh:
        noise = np.random.default_rng(seed).standard_normal(len(directions))
        offsets = welded.spread(directions * noise[:, None], 0.0)
        return TriangleMesh(mesh.vertices + offsets, mesh.faces)

    return moved


def _mean_edges(mesh: TriangleMesh) -> FloatArray:
    """Return the mean length of the edges at each vertex, mesh units."""
    ends = edges(mesh.faces, len(mesh.vertices)).ends
    lengths = np.sqrt(np.square(mesh.vertices[ends[:, 0]] - mesh.vertices[ends[:, 1]]).sum(axis=1))
    count = len(mesh.vertices)
    total = np.bincount(ends.ravel(), np.repeat(lengths, 2), count)
    return total / np.maximum(np.bincount(ends.ravel(), minlength=count), 1)
