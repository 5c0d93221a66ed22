"""Points in the order of an octree's cells."""

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled

LEVELS = 20
"""Bits of a code by axis."""


def codes(points: FloatArray) -> NDArray[np.int64]:
    """Return Morton codes, in whose order a depth-first walk of an octree meets points.

    Parameters
    ----------
    points : ndarray, shape=(q, 3)
        The points; none are allowed.

    Returns
    -------
    ndarray of int64, shape=(q,)
        Three bits a level: the cells of a cube around all of them.
    """
    if not len(points):
        return np.empty(0, np.int64)
    low = points.min(axis=0)
    extent = float((points.max(axis=0) - low).max())
    cells = (points - low) * ((2.0**LEVELS - 1.0) / extent if extent > 0.0 else 0.0)
    found: NDArray[np.int64] = _interleaved(cells.astype(np.int64))
    return found


@compiled(parallel=True)
def _interleaved(cells: NDArray[np.int64]) -> NDArray[np.int64]:
    code = np.zeros(len(cells), np.int64)
    for i in prange(len(cells)):
        for bit in range(LEVELS):
            for axis in range(3):
                code[i] |= ((cells[i, axis] >> bit) & 1) << (3 * bit + axis)
    return code


@compiled()
def runs(code: NDArray[np.int64], most: int) -> NDArray[np.int64]:
    """Cut sorted points into cells of few: cubes, halves and quarters of cubes.

    Parameters
    ----------
    code : ndarray of int64, shape=(q,)
        Their codes, ascending.
    most : int
        Points in a cell at most, 1 or more.

    Returns
    -------
    ndarray of int64, shape=(r + 1,)
        Where each begins, and q.
    """
    count = len(code)
    start, cells, begin = np.empty(count + 1, np.int64), 0, 0
    while begin < count:
        start[cells] = begin
        cells += 1
        end = min(begin + most, count)
        # Points that share all bits cannot be parted by cells.
        if most > 1 and code[begin] != code[end - 1]:
            for shift in range(3 * LEVELS):
                cell = code[begin] >> shift
                if begin > 0 and code[begin - 1] >> shift == cell:
                    break
                after = begin + np.searchsorted(code[begin:], (cell + 1) << shift)
                if after - begin > most:
                    break
                end = after
        begin = end
    start[cells] = count
    return start[: cells + 1].copy()
