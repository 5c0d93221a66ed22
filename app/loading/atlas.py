"""Several textures side by side on one."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from app.loading.texture_wrap import CLAMP, MIRROR, REPEAT, Wrap
from lutcore.arrays import AnyArray, FloatArray

Pixels = NDArray[np.uint8]
_PLAIN = 4  # pixels of the white square for what has no texture
_MOST_SIDE = 16384


def joined(
    images: Sequence[Pixels | None],
    uv: FloatArray,
    which: AnyArray,
    wraps: Sequence[tuple[Wrap, Wrap]],
) -> tuple[Pixels, FloatArray, tuple[Wrap, Wrap]] | None:
    """Put the images that are used on one picture.

    Parameters
    ----------
    images : sequence of ndarray of uint8, shape=(height, width, 3), or None
        sRGB; None for one that could not be read.
    uv : ndarray, shape=(m, 3, 2)
        Places on the face's own image.
    which : ndarray of int, shape=(m,)
        Each face's image, -1 for none.
    wraps : sequence of tuple of 2 str
        How each image goes on, across and up; see `app.loading.texture_wrap`.

    Returns
    -------
    tuple, or None
        The picture, the places on it, and how it goes on; None where a face goes beyond an image
        that has a neighbour now, or the picture would be too large.
    """
    readable = np.array([image is not None for image in images] + [False])
    which = np.where(readable[which], which, -1)
    used = [int(one) for one in np.unique(which)]
    if len(used) == 1 and used[0] >= 0:
        only = images[used[0]]
        return None if only is None else (only, uv, wraps[used[0]])
    tiles = [_white() if one < 0 else images[one] for one in used]
    known = [tile for tile in tiles if tile is not None]
    width, height = sum(tile.shape[1] for tile in known), max(tile.shape[0] for tile in known)
    if width > _MOST_SIDE:
        return None
    within = uv.copy()
    for one in used:
        if one >= 0:
            within[which == one] = _once(uv[which == one], wraps[one])
    used_places = within[which >= 0]
    if ((used_places > 1.0 + 1e-5) | (used_places < -1e-5)).any():
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
    return picture, placed, (REPEAT, REPEAT)


def _once(uv: FloatArray, wrap: tuple[Wrap, Wrap]) -> FloatArray:
    """Take whole repeats off face by face; one that crosses an edge keeps going beyond."""
    floor = np.floor(uv.min(axis=1) + 1e-6)
    once = uv - floor[:, None, :]
    for axis, how in enumerate(wrap):
        if how == MIRROR:
            turned = floor[:, axis] % 2 == 1.0
            once[turned, :, axis] = 1.0 - once[turned, :, axis]
        elif how == CLAMP:
            # All of a face beyond an edge has the colour there.
            beyond = (uv[:, :, axis] >= 1.0).all(axis=1) | (uv[:, :, axis] <= 0.0).all(axis=1)
            once[:, :, axis] = uv[:, :, axis]
            once[beyond, :, axis] = np.clip(uv[beyond, :, axis], 0.0, 1.0)
    return once


def _white() -> Pixels:
    return np.full((_PLAIN, _PLAIN, 3), 255, dtype=np.uint8)
