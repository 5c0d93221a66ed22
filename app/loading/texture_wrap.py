"""How a texture goes on beyond its picture."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

Wrap = Literal["repeat", "clamp", "mirror"]
REPEAT: Wrap = "repeat"
CLAMP: Wrap = "clamp"
MIRROR: Wrap = "mirror"


def within(pixel: NDArray[np.int64], size: int, wrap: Wrap) -> NDArray[np.int64]:
    """Return which pixel of a picture is seen.

    Parameters
    ----------
    pixel : ndarray of int
        Which it would be if the picture went on for ever.
    size : int
        Pixels of the picture along this axis.
    wrap : str
        How it goes on: ``repeat``, ``clamp`` (its last pixel) or ``mirror``.

    Returns
    -------
    ndarray of int
        0 to `size` - 1.
    """
    if wrap == CLAMP:
        return np.clip(pixel, 0, size - 1)
    if wrap == MIRROR:
        there = pixel % (2 * size)
        return np.minimum(there, 2 * size - 1 - there)
    return pixel % size
