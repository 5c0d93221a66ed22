"""What every reader returns: the file's content as arrays, not yet trusted."""

from dataclasses import dataclass, field

import numpy as np

from lutcore.arrays import AnyArray, FloatArray


@dataclass
class RawSurface:
    """Polygons over vertices as the file has them; `app.loading.checks` makes a mesh of them.

    Parameters
    ----------
    vertices : ndarray of float64, shape=(n, 3)
        Positions in the file's order.
    corners : ndarray of int64, shape=(c,)
        Vertex indices of all polygons, one polygon after another.
    counts : ndarray of int64, shape=(f,)
        Number of corners of each polygon.
    colors : ndarray of float64, shape=(n, 3), or None
        sRGB-encoded vertex colours, 0 to 1.
    warnings : list of str
        What the reader passed over or had to assume.
    """

    vertices: FloatArray
    corners: AnyArray
    counts: AnyArray
    colors: FloatArray | None = None
    warnings: list[str] = field(default_factory=list)

    @classmethod
    def of_triangles(
        cls, vertices: FloatArray, faces: AnyArray, colors: FloatArray | None = None
    ) -> "RawSurface":
        """Build a surface whose polygons are all triangles.

        Parameters
        ----------
        vertices : ndarray, shape=(n, 3)
            Positions.
        faces : ndarray of int, shape=(m, 3)
            Vertex indices.
        colors : ndarray, shape=(n, 3), or None
            Vertex colours.

        Returns
        -------
        RawSurface
            The same, as polygons.
        """
        return cls(vertices, faces.reshape(-1), np.full(len(faces), 3), colors)
