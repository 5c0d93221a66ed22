"""Vertex colours of any number type, as floats from 0 to 1."""

import numpy as np

from lutcore.arrays import AnyArray, FloatArray

FACE_COLORS_UNUSED = "the faces have colours of their own: not used, only those of vertices are"
# Interpolation and rounding take shares a little above 1; bytes of which none is above 2 are black.
_LARGEST_SHARE = 2.0


def normalized(
    colors: AnyArray, warnings: list[str], *, floats_are_shares: bool = False
) -> FloatArray | None:
    """Scale stored colours to 0..1.

    Parameters
    ----------
    colors : ndarray, shape=(n, 3 or more)
        Unsigned numbers of 8 and 16 bits fill their type's range, other whole numbers 0 to 255;
        floats are 0 to 1, or 0 to 255 if any is above 2.
    warnings : list of str
        Gets a line if something had to be assumed.
    floats_are_shares : bool
        Whether the format defines floats as 0 to 1, however large one is.

    Returns
    -------
    ndarray of float64, shape=(n, 3), or None
        The colours, clipped to 0..1; None if the numbers cannot be colours.
    """
    rgb = np.array(colors[:, :3], dtype=np.float64)
    if colors.dtype.kind == "u" and colors.dtype.itemsize <= 2:
        return rgb / np.iinfo(colors.dtype).max
    shares = floats_are_shares and colors.dtype.kind == "f"
    outside = (rgb < 0.0) | (rgb > 255.0)
    if not np.isfinite(rgb).all() or (outside.any() and not shares):
        warnings.append("the vertex colours are not numbers from 0 to 1 or 0 to 255: not used")
        return None
    # Wider whole numbers hold bytes, and text formats do not say what theirs hold.
    if colors.dtype.kind in "iu" or (not shares and (rgb > _LARGEST_SHARE).any()):
        return rgb / 255.0
    if ((rgb < 0.0) | (rgb > 1.0)).any():
        warnings.append("some vertex colours are not between 0 and 1: clipped")
    return np.clip(rgb, 0.0, 1.0)
