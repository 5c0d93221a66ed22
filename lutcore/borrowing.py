"""Shape operators of stars that tell little, improved by what their neighbours tell."""

import numpy as np

from lutcore.arrays import BoolArray, FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.tensors import in_space, in_tangent_plane

# Sweeps of the iteration, ring by ring from the inside out and back; and passes over islands that
# have no inside, all their vertices at once.
_SWEEPS, _PASSES_ALONE = 2, 48
# Squared error that remains, over what the sums say: changes are not the same everywhere.
_CAUTION = 3.0
# Near a rim neighbours differ by more than elsewhere, squared, by about this.
_WIDER = 4.0
# Vertices that tell, with their neighbours, how fast curvature changes.
_STARS = 5_000


def borrow(
    start: IndexArray,
    neighbour: IndexArray,
    normals: FloatArray,
    weak: IndexArray,
    closed: BoolArray,
    tensors: FloatArray,
    square: FloatArray,
    doubt: FloatArray,
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
    doubt : ndarray, shape=(w,)
        Squared error that each of them counts with in its own favour: `square`, or more.
    """
    number = np.full(len(normals), -1, np.int32)
    number[weak] = np.arange(len(weak), dtype=np.int32)
    links = start, neighbour
    # The median is NumPy's: numba's own brings a quarter of a second of imports along.
    found = _differences(*links, normals, number, tensors)
    step = _WIDER * max(float(np.median(found if len(found) else square)), 1e-30)
    _join(*links, normals, number, weak, closed, step, tensors, square, doubt)


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
    doubt: FloatArray,
) -> None:
    """Iterate, with each vertex's place in `weak` or -1, and how much neighbours differ."""
    measured = np.empty((len(weak), 6))
    certainty = np.zeros(len(weak))
    now = np.empty((len(weak), 7))
    for w in range(len(weak)):
        own = in_space(normals[weak[w]], tensors[weak[w]])
        for entry in range(6):
            measured[w, entry] = now[w, entry] = own[entry]
        now[w, 6] = square[weak[w]]
        if not closed[w]:
            certainty[w] = 1.0 / max(doubt[w], 1e-30)
    order, rings = _outwards(start, neighbour, weak, number)
    reached = rings[-2]
    # The first sweep starts from the inside alone; an island that has none, from itself.
    known = ~closed
    known[order[:reached]] = False
    state = (now, known)
    fixed = (measured, certainty, closed, step)
    inside = (normals, tensors, square)
    for sweep in range(2 * _SWEEPS):
        for turn in range(len(rings) - 2):
            ring = turn if sweep % 2 == 0 else len(rings) - 3 - turn
            members = order[rings[ring] : rings[ring + 1]]
            _update(members, start, neighbour, weak, number, inside, fixed, state)
    for _ in range(_PASSES_ALONE):
        _update(order[reached:], start, neighbour, weak, number, inside, fixed, state)
    for w in range(len(weak)):
        if not known[w]:
            continue
        i = weak[w]
        tensors[i, 0], tensors[i, 1], tensors[i, 2] = in_tangent_plane(normals[i], now[w, :6])
        square[i] = _CAUTION * now[w, 6]


@compiled()
def _update(
    members: IndexArray,
    start: IndexArray,
    neighbour: IndexArray,
    weak: IndexArray,
    number: IndexArray,
    inside: tuple[FloatArray, FloatArray, FloatArray],
    fixed: tuple[FloatArray, FloatArray, BoolArray, float],
    state: tuple[FloatArray, BoolArray],
) -> None:
    """Join each member with its neighbours, all as they were before: their order is nothing."""
    normals, tensors, square = inside
    measured, certainty, closed, step = fixed
    now, known = state
    pull = 1.0 / step
    after = np.empty((len(members), 7))
    counts = np.zeros(len(members), np.int32)
    for m in range(len(members)):
        w = members[m]
        xx = xy = xz = yy = yz = zz = squares = 0.0
        for at in range(start[weak[w]], start[weak[w] + 1]):
            j = neighbour[at]
            other = number[j]
            if other < 0:
                a, b, c, d, e, f = in_space(normals[j], tensors[j])
                squares += square[j]
            elif known[other]:
                a, b, c = now[other, 0], now[other, 1], now[other, 2]
                d, e, f = now[other, 3], now[other, 4], now[other, 5]
                squares += now[other, 6]
            else:
                continue
            counts[m] += 1
            xx, xy, xz, yy, yz, zz = xx + a, xy + b, xz + c, yy + d, yz + e, zz + f
        own = certainty[w]
        share = 1.0 / (own + counts[m] * pull)
        for entry, total in enumerate((xx, xy, xz, yy, yz, zz)):
            after[m, entry] = share * (own * measured[w, entry] + pull * total)
        # Neighbours err alike: together they know no more than one of them does.
        after[m, 6] = 1.0 / (own + 1.0 / (squares / max(counts[m], 1) + step))
    for m in range(len(members)):
        w = members[m]
        if counts[m] > 0:
            for entry in range(7):  # a row's assignment would be slower
                now[w, entry] = after[m, entry]
        known[w] = known[w] or counts[m] > 0 or not closed[w]


@compiled()
def _outwards(
    start: IndexArray, neighbour: IndexArray, weak: IndexArray, number: IndexArray
) -> tuple[IndexArray, IndexArray]:
    """Return the places in `weak`, those beside other vertices first, then ring by ring.

    The second array says where each ring begins; the last are those that no ring reaches.
    """
    order = np.empty(len(weak), np.int32)
    rings = np.zeros(len(weak) + 3, np.int32)
    listed = np.zeros(len(weak), np.bool_)
    found = 0
    for w in range(len(weak)):
        for at in range(start[weak[w]], start[weak[w] + 1]):
            if number[neighbour[at]] < 0:
                order[found] = w
                listed[w] = True
                found += 1
                break
    ring = 0
    while rings[ring] < found:
        ring += 1
        rings[ring] = found
        for at_front in range(rings[ring - 1], rings[ring]):
            i = weak[order[at_front]]
            for at in range(start[i], start[i + 1]):
                other = number[neighbour[at]]
                if other >= 0 and not listed[other]:
                    order[found] = other
                    listed[other] = True
                    found += 1
    for w in range(len(weak)):
        if not listed[w]:
            order[found] = w
            found += 1
    rings[ring + 1] = found
    return order, rings[: ring + 2]


@compiled()
def _differences(
    start: IndexArray,
    neighbour: IndexArray,
    normals: FloatArray,
    number: IndexArray,
    tensors: FloatArray,
) -> FloatArray:
    """Return mean squared differences of vertices that are not weak from such neighbours."""
    every = 1 + len(normals) // _STARS
    found = np.empty(len(normals) // every + 1)
    count = 0
    for i in range(0, len(normals), every):
        if number[i] >= 0:
            continue
        total, pairs = 0.0, 0
        own = in_space(normals[i], tensors[i])
        for at in range(start[i], start[i + 1]):
            j = neighbour[at]
            if number[j] < 0:
                there = in_space(normals[j], tensors[j])
                xx, xy, yy = in_tangent_plane(
                    normals[i],
                    (
                        there[0] - own[0],
                        there[1] - own[1],
                        there[2] - own[2],
                        there[3] - own[3],
                        there[4] - own[4],
                        there[5] - own[5],
                    ),
                )
                total += 0.5 * (xx * xx + yy * yy) + xy * xy
                pairs += 1
        if pairs > 0:
            found[count] = total / pairs
            count += 1
    return found[:count]
