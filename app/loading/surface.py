"""What every reader returns: the file's content as arrays, not yet trusted."""

from dataclasses import dataclass, field

import numpy as np

from app.loading.texture_wrap import REPEAT, Wrap
from lutcore.arrays import AnyArray, FloatArray


@dataclass(frozen=True)
class RawPicture:
    """One picture of a texture.

    Parameters
    ----------
    name : str
        For messages.
    content : bytes or None
        Encoded; None for a plain white one.
    tint : tuple of 3 floats
        Linear factor on its colours, 0 to 1.
    wrap : tuple of 2 str
        How it goes on, across and up; see `app.loading.texture_wrap`.
    """

    name: str
    content: bytes | None
    tint: tuple[float, float, float] = (1.0, 1.0, 1.0)
    wrap: tuple[Wrap, Wrap] = (REPEAT, REPEAT)


@dataclass
class RawTexture:
    """Pictures that a file wraps around its surface, as it has them.

    Parameters
    ----------
    corners : ndarray of float64, shape=(c, 2)
        Place on the picture of each corner of the polygons: (0, 0) at the lower left, NaN for
        none.
    which : ndarray of int, shape=(f,)
        Each polygon's picture, -1 for none.
    images : list of RawPicture
        The pictures.
    """

    corners: FloatArray
    which: AnyArray
    images: list[RawPicture]


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
    mm_per_unit : float or None
        Size of a unit, where the file says it.
    others : list of bytes
        Contents of the files beside it that were read along.
    texture : RawTexture or None
        What is wrapped around it.
    """

    vertices: FloatArray
    corners: AnyArray
    counts: AnyArray
    colors: FloatArray | None = None
    warnings: list[str] = field(default_factory=list)
    mm_per_unit: float | None = None
    others: list[bytes] = field(default_factory=list)
    texture: RawTexture | None = None

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
