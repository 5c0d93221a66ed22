"""A coarse stand-in of a mesh that is drawn while the camera moves. Knows no Qt."""

from dataclasses import dataclass

import numpy as np

from lutcore.arrays import AnyArray, FloatArray
from lutcore.mesh import TriangleMesh


@dataclass(frozen=True, eq=False)
class Coarse:
    """A mesh of some of another's vertices, so that their colours fit both.

    Parameters
    ----------
    vertices : ndarray of int, shape=(c,)
        Which vertices of the fine mesh it has.
    mesh : TriangleMesh
        The coarse mesh.
    fine : TriangleMesh
        What it stands in for.
    """

    vertices: AnyArray
    mesh: TriangleMesh
    fine: TriangleMesh


def coarse(mesh: TriangleMesh, most: int) -> Coarse | None:
    """Return a coarse stand-in of a mesh: one vertex for each cell of a grid.

    Parameters
    ----------
    mesh : TriangleMesh
        The fine mesh.
    most : int
        About how many triangles it may have.

    Returns
    -------
    Coarse or None
        None if the mesh has no more than that itself, or nothing would be left of it.
    """
    if len(mesh.faces) <= most:
        return None
    corners = mesh.vertices[mesh.faces]
    sides = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = 0.5 * float(np.linalg.norm(sides, axis=1).sum())
    # A surface that crosses a grid of cell size s has about two triangles for each s^2 of area.
    cell = np.sqrt(2.0 * area / most)
    if not cell > 0.0:
        return None
    cluster = _cells(mesh.vertices, float(cell))
    used, first, of = np.unique(cluster, return_index=True, return_inverse=True)
    faces = of.reshape(-1)[mesh.faces]
    kept = (
        (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    )
    faces = faces[kept]
    # Several fine triangles between the same three cells are one coarse triangle.
    turned = np.take_along_axis(
        faces, (np.argmin(faces, axis=1)[:, None] + np.arange(3)) % 3, axis=1
    )
    count = len(used)
    key = (turned[:, 0] * count + turned[:, 1]) * count + turned[:, 2]
    faces = turned[np.unique(key, return_index=True)[1]]
    return Coarse(first, TriangleMesh(mesh.vertices[first], faces), mesh) if len(faces) else None


def _cells(points: FloatArray, cell: float) -> AnyArray:
    steps = np.floor((points - points.min(axis=0)) / cell).astype(np.int64)
    width = steps.max(axis=0) + 1
    cells: AnyArray = (steps[:, 0] * width[1] + steps[:, 1]) * width[2] + steps[:, 2]
    return cells
