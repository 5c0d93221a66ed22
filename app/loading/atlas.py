"""Several textures side by side on one."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lutcore.arrays import AnyArray, FloatArray

Pixels = NDArray[np.uint8]
_PLAIN = 4  # pixels of the white square for what has no texture
_MOST_SIDE = 16384


def joined(
    images: Sequence[Pixels | None], uv: FloatArray, which: AnyArray
) -> tuple[Pixels, FloatArray] | None:
    """Put the images that are used on one picture.

    Parameters
    ----------
    images : sequence of ndarray of uint8, shape=(height, width, 3), or None
        sRGB; None for one that could not be read.
    uv : ndarray, shape=(m, 3, 2)
        Places on the face's own image.
    which : ndarray of int, shape=(m,)
        Each face's image, -1 for none.

    Returns
    -------
    tuple of ndarray, or None
        The picture, and the places on it; None where a face goes beyond an image that cannot
        repeat any more, or the picture would be too large.
    """
    readable = np.array([image is not None for image in images] + [False])
    which = np.where(readable[which], which, -1)
    used = [int(one) for one in np.unique(which)]
    if len(used) == 1 and used[0] >= 0:
        only = images[used[0]]
        return None if only is None else (only, uv)
    tiles = [_white() if one < 0 else images[one] for one in used]
    known = [tile for tile in tiles if tile is not None]
    width, height = sum(tile.shape[1] for tile in known), max(tile.shape[0] for tile in known)
    if width > _MOST_SIDE:
        return None
    # Whole repeats are taken off face by face; one that crosses a repeat has no place here.
    floor = np.floor(uv.min(axis=1) + 1e-6)
    within = uv - floor[:, None, :]
    if (within[which >= 0] > 1.0 + 1e-5).any():
        return None
    picture = np.zeros((height, width, 3), dtype=np.uint8)
    placed = np.empty_like(uv)
    left = 0
    for one, tile in zip(used, known, strict=True):
        rows, columns = tile.shape[:2]
        picture[height - rows :, left : left + columns] = tile
        here = which == one
        # Half a pixel inside, so that no neighbour shines in.
        spot = np.clip(within[here] * (columns, rows), 0.5, (columns - 0.5, rows - 0.5))
        placed[here] = (spot + (left, 0.0)) / (width, height)
        left += columns
    return picture, placed


def _white() -> Pixels:
    return np.full((_PLAIN, _PLAIN, 3), 255, dtype=np.uint8)
