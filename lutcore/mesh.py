"""The triangle mesh that everything else works on."""

from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from lutcore.arrays import BoolArray, FloatArray, IndexArray, read_only
from lutcore.errors import MeshError


class TriangleMesh:
    """Triangles over vertices; checked once here, trusted everywhere else.

    Parameters
    ----------
    vertices : array_like, shape=(n, 3)
        Positions in mesh units. Kept in float64.
    faces : array_like, shape=(m, 3)
        Vertex indices of each triangle, counter-clockwise seen from outside: the outward normal
        follows from their order. Faces of zero area and unreferenced vertices are allowed.

    Raises
    ------
    MeshError
        If there is no face, an array has another shape, a position is not finite or an index is
        out of range.
    """

    def __init__(self, vertices: ArrayLike, faces: ArrayLike) -> None:
        self.vertices: FloatArray = read_only(_vertices(vertices))
        self.faces: IndexArray = read_only(_faces(faces, len(self.vertices)))

    @classmethod
    def trusted(cls, vertices: FloatArray, faces: IndexArray) -> "TriangleMesh":
        """Return a mesh of arrays that came from a checked one, without checking them again.

        Parameters
        ----------
        vertices : ndarray of float64, shape=(n, 3)
            Finite positions; not copied.
        faces : ndarray of int32, shape=(m, 3)
            Indices of vertices that exist, m > 0; not copied.

        Returns
        -------
        TriangleMesh
            The mesh.
        """
        mesh = cls.__new__(cls)
        mesh.vertices, mesh.faces = read_only(vertices), read_only(faces)
        return mesh

    def __repr__(self) -> str:
        return f"TriangleMesh({len(self.vertices)} vertices, {len(self.faces)} faces)"

    @cached_property
    def diagonal(self) -> float:
        """Length of the diagonal of the box around the referenced vertices, in mesh units."""
        used = np.zeros(len(self.vertices), dtype=bool)
        used[self.faces.ravel()] = True
        points = self.vertices if used.all() else self.vertices[used]
        # By columns: NumPy reduces rows of three many times slower.
        return float(np.linalg.norm([np.ptp(points[:, axis]) for axis in range(3)]))


def _vertices(value: ArrayLike) -> FloatArray:
    try:
        vertices = np.array(value, dtype=np.float64, order="C")
    except (TypeError, ValueError):
        raise MeshError("the vertex positions are not numbers") from None
    if vertices.ndim != 2 or vertices.shape[1] != 3:
        raise MeshError(f"vertices have shape {vertices.shape}, expected (n, 3)")
    if not np.isfinite(vertices).all():
        good: BoolArray = np.asarray(np.isfinite(vertices).all(axis=1))
        first = int(np.argmin(good))
        raise MeshError(
            f"{np.count_nonzero(~good)} of {len(good)} vertex positions are not finite, "
            f"the first is vertex {first}"
        )
    return vertices


def _faces(value: ArrayLike, vertex_count: int) -> IndexArray:
    faces = np.asarray(value)
    if faces.size == 0:
        raise MeshError("there are no faces, so there is no surface")
    if faces.ndim != 2 or faces.shape[1] != 3:
        raise MeshError(f"faces have shape {faces.shape}, expected (m, 3)")
    if faces.dtype.kind not in "iu":
        raise MeshError(f"faces are of type {faces.dtype}, expected whole numbers")
    if vertex_count > np.iinfo(np.int32).max:
        raise MeshError(f"{vertex_count} vertices are more than 32-bit indices can name")
    if faces.min() < 0 or faces.max() >= vertex_count:
        bad = ((faces < 0) | (faces >= vertex_count)).any(axis=1)
        first = int(np.argmax(bad))
        raise MeshError(
            f"{np.count_nonzero(bad)} of {len(faces)} faces use vertices that do not exist, "
            f"the first is face {first}: {faces[first].tolist()} of {vertex_count} vertices"
        )
    return np.array(faces, dtype=np.int32, order="C")
