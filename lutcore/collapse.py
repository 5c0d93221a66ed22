"""Shape operators where smoothing has closed the star: corners of a rim and tiny islands."""

import numpy as np

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.tensors import in_space, in_tangent_plane

# Passes of the interpolation: reaches that many rings, more than a corner of a rim closes.
_PASSES = 40


@compiled()
def mend(
    start: IndexArray,
    neighbour: IndexArray,
    normals: FloatArray,
    closed: IndexArray,
    tensors: FloatArray,
    square: FloatArray,
) -> None:
    """Replace the tensors of closed stars by interpolation from the open ones around them.

    The interpolation is harmonic: repeated means over the neighbours, the open ones held. An
    island with no open star is left with the mean of the tensors it came with. Error bars are
    interpolated likewise and doubled, since nothing was measured there.

    Parameters
    ----------
    start, neighbour : ndarray of int32
        Neighbours of each vertex.
    normals : ndarray, shape=(n, 3)
        Unit normals; tensors are in their `tangent_frame`.
    closed : ndarray of int32, shape=(c,)
        Vertices whose stars closed.
    tensors : ndarray, shape=(n, 3)
        Entries xx, xy, yy; rewritten at `closed`, where they hold a first guess.
    square : ndarray, shape=(n,)
        Squared error bars; rewritten likewise.
    """
    number = np.full(len(normals), -1, np.int32)
    for c in range(len(closed)):
        number[closed[c]] = c
    now = np.empty((len(closed), 7))
    for c in range(len(closed)):
        now[c, :6] = in_space(normals[closed[c]], tensors[closed[c]])
        now[c, 6] = square[closed[c]]
    after = np.empty_like(now)
    for _ in range(_PASSES):
        for c in range(len(closed)):
            first, last = start[closed[c]], start[closed[c] + 1]
            total = now[c].copy()
            for at in range(first, last):
                j = neighbour[at]
                if number[j] >= 0:
                    total += now[number[j]]
                else:
                    total[:6] += in_space(normals[j], tensors[j])
                    total[6] += square[j]
            after[c] = total / (last - first + 1)
        now, after = after, now
    for c in range(len(closed)):
        i = closed[c]
        tensors[i, 0], tensors[i, 1], tensors[i, 2] = in_tangent_plane(normals[i], now[c])
        square[i] = 4.0 * now[c, 6]
