"""Vertex colours of any number type, as floats from 0 to 1."""

import numpy as np

from lutcore.arrays import AnyArray, FloatArray


def normalized(colors: AnyArray, warnings: list[str]) -> FloatArray | None:
    """Scale stored colours to 0..1.

    Parameters
    ----------
    colors : ndarray, shape=(n, 3 or more)
        Unsigned numbers of 8 and 16 bits fill their type's range, other whole numbers 0 to 255;
        floats are 0 to 1, or 0 to 255 if any is above 1.
    warnings : list of str
        Gets a line if something had to be assumed.

    Returns
    -------
    ndarray of float64, shape=(n, 3), or None
        The colours; None if the numbers cannot be colours.
    """
    rgb = np.array(colors[:, :3], dtype=np.float64)
    if colors.dtype.kind == "u" and colors.dtype.itemsize <= 2:
        return rgb / np.iinfo(colors.dtype).max
    if not np.isfinite(rgb).all() or (rgb < 0.0).any() or (rgb > 255.0).any():
        warnings.append("the vertex colours are not numbers from 0 to 1 or 0 to 255: not used")
        return None
    # Wider whole numbers hold bytes, and text formats do not say what theirs hold.
    in_bytes = colors.dtype.kind in "iu" or (rgb > 1.0).any()
    return rgb / 255.0 if in_bytes else rgb
