"""Shape operators of stars that tell little, improved by what their neighbours tell."""

import numpy as np

from lutcore.arrays import BoolArray, FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.tensors import in_space, in_tangent_plane

# Passes of the iteration: reaches that many rings, more than a corner of a rim closes.
_PASSES = 16
# Squared error that remains, over what the sums say: changes are not the same everywhere.
_CAUTION = 3.0
# Pairs of neighbours that tell how fast curvature changes.
_PAIRS = 20_000


def borrow(
    start: IndexArray,
    neighbour: IndexArray,
    normals: FloatArray,
    weak: IndexArray,
    closed: BoolArray,
    tensors: FloatArray,
    square: FloatArray,
) -> None:
    """Join the tensors of weak stars with those of their neighbours, by their errors.

    At a rim half of the star is missing, and inner neighbours know more. The result minimises the
    squared distance from what was measured, over its squared error, and the squared differences
    between neighbours, over what neighbours elsewhere differ by: a noisy rim takes over what the
    inside knows, a precise one stays as it is. Stars that smoothing has closed have measured
    nothing; an island without any open star keeps what it came with.

    Parameters
    ----------
    start, neighbour : ndarray of int32
        Neighbours of each vertex.
    normals : ndarray, shape=(n, 3)
        Unit normals; tensors are in their `tangent_frame`.
    weak : ndarray of int32, shape=(w,)
        Vertices near a rim, and those whose stars have closed.
    closed : ndarray of bool, shape=(w,)
        Which of them have closed.
    tensors : ndarray, shape=(n, 3)
        Entries xx, xy, yy; rewritten at `weak`.
    square : ndarray, shape=(n,)
        Squared error bars; rewritten likewise.
    """
    number = np.full(len(normals), -1, np.int32)
    number[weak] = np.arange(len(weak), dtype=np.int32)
    links = start, neighbour
    # The median is NumPy's: numba's own brings a quarter of a second of imports along.
    found = _differences(*links, normals, number, tensors)
    step = max(float(np.median(found if len(found) else square)), 1e-30)
    _join(*links, normals, number, weak, closed, step, tensors, square)


@compiled()
def _join(
    start: IndexArray,
    neighbour: IndexArray,
    normals: FloatArray,
    number: IndexArray,
    weak: IndexArray,
    closed: BoolArray,
    step: float,
    tensors: FloatArray,
    square: FloatArray,
) -> None:
    """Iterate, with each vertex's place in `weak` or -1, and how much neighbours differ."""
    reached = ~closed
    measured = np.empty((len(weak), 6))
    certainty = np.zeros(len(weak))
    now = np.empty((len(weak), 7))
    for w in range(len(weak)):
        measured[w] = np.array(in_space(normals[weak[w]], tensors[weak[w]]))
        now[w, :6] = measured[w]
        now[w, 6] = square[weak[w]]
        if not closed[w]:
            certainty[w] = 1.0 / max(square[weak[w]], 1e-30)
    inside = np.zeros_like(now)
    for w in range(len(weak)):
        for at in range(start[weak[w]], start[weak[w] + 1]):
            j = neighbour[at]
            if number[j] < 0:
                reached[w] = True
                inside[w, :6] += np.array(in_space(normals[j], tensors[j]))
                inside[w, 6] += square[j]
    after = np.empty_like(now)
    total = np.empty(7)
    for _ in range(_PASSES):
        before = reached.copy()
        for w in range(len(weak)):
            total[:] = inside[w]
            count = 0
            for at in range(start[weak[w]], start[weak[w] + 1]):
                other = number[neighbour[at]]
                if other < 0:
                    count += 1
                elif before[other]:
                    count += 1
                    for entry in range(7):
                        total[entry] += now[other, entry]
            after[w] = now[w]
            if count > 0:
                reached[w] = True
                pull = count / step
                for entry in range(6):
                    own = certainty[w] * measured[w, entry]
                    after[w, entry] = (own + total[entry] / step) / (certainty[w] + pull)
                # Neighbours err alike: together they know no more than one of them does.
                after[w, 6] = 1.0 / (certainty[w] + 1.0 / (total[6] / count + step))
        now, after = after, now
    for w in range(len(weak)):
        if not reached[w]:
            continue
        i = weak[w]
        tensors[i, 0], tensors[i, 1], tensors[i, 2] = in_tangent_plane(normals[i], now[w, :6])
        square[i] = _CAUTION * now[w, 6]


@compiled()
def _differences(
    start: IndexArray,
    neighbour: IndexArray,
    normals: FloatArray,
    number: IndexArray,
    tensors: FloatArray,
) -> FloatArray:
    """Return squared differences of some pairs of neighbours that are not weak."""
    every = 1 + len(normals) // _PAIRS
    found = np.empty(len(normals) // every + 1)
    count = 0
    for i in range(0, len(normals), every):
        if start[i] == start[i + 1]:
            continue
        j = neighbour[start[i]]
        if number[i] < 0 and number[j] < 0:
            d = np.array(in_space(normals[i], tensors[i]))
            d -= np.array(in_space(normals[j], tensors[j]))
            xx, xy, yy = in_tangent_plane(normals[i], d)
            found[count] = 0.5 * (xx * xx + yy * yy) + xy * xy
            count += 1
    return found[:count]
