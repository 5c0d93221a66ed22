"""Triangle strips and fans, as in glTF and in PLY files of range scanners."""

import numpy as np

from lutcore.arrays import AnyArray


def strip_faces(corners: AnyArray, counts: AnyArray) -> AnyArray:
    """Take triangle strips apart.

    Parameters
    ----------
    corners : ndarray of int, shape=(c,)
        Vertex indices of all strips, one after another; -1 ends a strip and begins another.
    counts : ndarray of int, shape=(s,)
        Number of indices of each strip.

    Returns
    -------
    ndarray of int, shape=(m, 3)
        Triangles, every other one turned so that all face the same way. Those with a repeated
        vertex only join pieces of a strip, and are left out.
    """
    breaks = np.zeros(len(corners) + 1, dtype=bool)
    breaks[np.cumsum(counts) - counts] = True
    cut = corners == -1
    breaks[:-1] |= cut
    breaks[1:] |= cut
    breaks = breaks[:-1]
    position = np.arange(len(corners))
    begin = np.maximum.accumulate(np.where(breaks, position, 0))
    step = (position - begin)[2:]
    faces = np.column_stack((corners[:-2], corners[1:-1], corners[2:]))
    odd = step % 2 == 1
    faces[odd] = faces[odd][:, [1, 0, 2]]
    first, second, third = faces.T
    distinct = (first != second) & (second != third) & (first != third)
    kept: AnyArray = faces[(step >= 2) & distinct & ~cut[2:]]
    return kept


def fan_faces(corners: AnyArray) -> AnyArray:
    """Take a triangle fan apart.

    Parameters
    ----------
    corners : ndarray of int, shape=(c,)
        Vertex indices, the hub first.

    Returns
    -------
    ndarray of int, shape=(max(c - 2, 0), 3)
        Its triangles.
    """
    rim = corners[1:]
    hub = np.repeat(corners[:1], max(len(rim) - 1, 0))
    return np.column_stack((hub, rim[:-1], rim[1:]))
