"""The compiled steps of a Chebyshev recurrence of a mesh's Laplacian, on six fields at once.

With x = 2 y - 1 and y = L/bound, T_{k+1} = 2 x T_k - T_{k-1}. Everywhere `start`, `neighbour` and
`rate` are those of `lutcore.laplacian.Laplacian`; indices are unsigned, for loops that need not ask
whether one counts from the end. Fields are arrays of float32, shape=(n, 6), `change` has one for
each polynomial, and a weight is that of a term in each of them.
"""

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import FloatArray, IndexArray, SingleArray
from lutcore.compiled import compiled

Unsigned = NDArray[np.uint32]
FIELDS = 6
"""Fields smoothed together: three of positions and three of normals, or a tensor's six."""

_TWO = np.float32(2.0)
# Pieces of a mesh that are shared out among the threads.
_CHUNKS = 256


@compiled(parallel=True)
def begin(
    first: SingleArray,
    second: SingleArray,
    weight: SingleArray,
    weight_after: SingleArray,
    change: SingleArray,
) -> None:
    """Write the first two terms, each by its weight, to all changes."""
    for i in prange(len(first)):
        for scale in range(len(weight)):
            for field in range(FIELDS):
                change[scale, i, field] = (
                    weight[scale] * first[i, field] + weight_after[scale] * second[i, field]
                )


@compiled(parallel=True)
def apply(
    start: Unsigned,
    neighbour: Unsigned,
    rate: SingleArray,
    f: FloatArray,
    factor: float,
    out: SingleArray,
) -> None:
    """Write 2 factor y f of fields in double precision."""
    for i in prange(len(start) - 1):
        s0 = s1 = s2 = s3 = s4 = s5 = 0.0
        for at in range(start[i], start[i + 1]):
            j, w = neighbour[at], factor * rate[at]
            s0 += w * (f[i, 0] - f[j, 0])
            s1 += w * (f[i, 1] - f[j, 1])
            s2 += w * (f[i, 2] - f[j, 2])
            s3 += w * (f[i, 3] - f[j, 3])
            s4 += w * (f[i, 4] - f[j, 4])
            s5 += w * (f[i, 5] - f[j, 5])
        out[i, 0], out[i, 1], out[i, 2] = s0, s1, s2
        out[i, 3], out[i, 4], out[i, 5] = s3, s4, s5


@compiled(packed=True)
def _step_rows(
    first: int,
    last: int,
    start: Unsigned,
    neighbour: Unsigned,
    rate: SingleArray,
    now: SingleArray,
    before: SingleArray,
    half: np.float32,
) -> None:
    """Do what `step` does at the vertices from `first` to `last`."""
    double = _TWO * half
    keep = double - np.float32(1.0)
    for i in range(np.uint64(first), np.uint64(last)):
        r = np.float32(0.0)
        s0 = s1 = s2 = s3 = s4 = s5 = np.float32(0.0)
        for at in range(start[i], start[i + 1]):
            j, w = neighbour[at], rate[at]
            r += w
            s0 += w * now[j, 0]
            s1 += w * now[j, 1]
            s2 += w * now[j, 2]
            s3 += w * now[j, 3]
            s4 += w * now[j, 4]
            s5 += w * now[j, 5]
        r -= np.float32(1.0)
        t0 = double * (r * now[i, 0] - s0) - keep * before[i, 0]
        t1 = double * (r * now[i, 1] - s1) - keep * before[i, 1]
        t2 = double * (r * now[i, 2] - s2) - keep * before[i, 2]
        t3 = double * (r * now[i, 3] - s3) - keep * before[i, 3]
        t4 = double * (r * now[i, 4] - s4) - keep * before[i, 4]
        t5 = double * (r * now[i, 5] - s5) - keep * before[i, 5]
        # All read before any is written, or the one could be the other for all LLVM knows.
        before[i, 0], before[i, 1], before[i, 2] = t0, t1, t2
        before[i, 3], before[i, 4], before[i, 5] = t3, t4, t5


@compiled(packed=True)
def _add_step_rows(
    first: int,
    last: int,
    start: Unsigned,
    neighbour: Unsigned,
    rate: SingleArray,
    now: SingleArray,
    before: SingleArray,
    change: SingleArray,
    weight: SingleArray,
    weight_after: SingleArray,
) -> None:
    """Do what `add_step` does at the vertices from `first` to `last`."""
    for i in range(np.uint64(first), np.uint64(last)):
        r = np.float32(0.0)
        s0 = s1 = s2 = s3 = s4 = s5 = np.float32(0.0)
        for at in range(start[i], start[i + 1]):
            j, w = neighbour[at], rate[at]
            r += w
            s0 += w * now[j, 0]
            s1 += w * now[j, 1]
            s2 += w * now[j, 2]
            s3 += w * now[j, 3]
            s4 += w * now[j, 4]
            s5 += w * now[j, 5]
        r -= np.float32(1.0)
        n0, n1, n2 = now[i, 0], now[i, 1], now[i, 2]
        n3, n4, n5 = now[i, 3], now[i, 4], now[i, 5]
        t0 = _TWO * (r * n0 - s0) - before[i, 0]
        t1 = _TWO * (r * n1 - s1) - before[i, 1]
        t2 = _TWO * (r * n2 - s2) - before[i, 2]
        t3 = _TWO * (r * n3 - s3) - before[i, 3]
        t4 = _TWO * (r * n4 - s4) - before[i, 4]
        t5 = _TWO * (r * n5 - s5) - before[i, 5]
        before[i, 0], before[i, 1], before[i, 2] = t0, t1, t2
        before[i, 3], before[i, 4], before[i, 5] = t3, t4, t5
        for scale in range(len(change)):
            c, d = weight[scale], weight_after[scale]
            if c != np.float32(0.0) or d != np.float32(0.0):
                change[scale, i, 0] += c * n0 + d * t0
                change[scale, i, 1] += c * n1 + d * t1
                change[scale, i, 2] += c * n2 + d * t2
                change[scale, i, 3] += c * n3 + d * t3
                change[scale, i, 4] += c * n4 + d * t4
                change[scale, i, 5] += c * n5 + d * t5


@compiled(parallel=True)
def step(
    start: Unsigned,
    neighbour: Unsigned,
    rate: SingleArray,
    now: SingleArray,
    before: SingleArray,
    half: np.float32,
) -> None:
    """Replace T_{k-1} f, `before`, by 2 half x T_k f - (2 half - 1) T_{k-1} f; `now` is T_k f."""
    count = len(now)
    for chunk in prange(_CHUNKS):
        first, last = count * chunk // _CHUNKS, count * (chunk + 1) // _CHUNKS
        _step_rows(first, last, start, neighbour, rate, now, before, half)


@compiled(parallel=True)
def add_step(
    start: Unsigned,
    neighbour: Unsigned,
    rate: SingleArray,
    now: SingleArray,
    before: SingleArray,
    change: SingleArray,
    weight: SingleArray,
    weight_after: SingleArray,
) -> None:
    """Do the same with half = 1, and add the shares of T_k and T_{k+1} to the changes."""
    count = len(now)
    for chunk in prange(_CHUNKS):
        first, last = count * chunk // _CHUNKS, count * (chunk + 1) // _CHUNKS
        _add_step_rows(
            first, last, start, neighbour, rate, now, before, change, weight, weight_after
        )


@compiled(parallel=True)
def go_on(
    parts: IndexArray,
    start: Unsigned,
    neighbour: Unsigned,
    rate: SingleArray,
    now: SingleArray,
    before: SingleArray,
    change: SingleArray,
    weights: SingleArray,
) -> None:
    """Do all steps from the third term on, part by part; for the parts see `Laplacian`.

    On few vertices the threads would take longer to wake for each step than to do it.
    """
    for part in prange(len(parts) - 1):
        first, last = parts[part], parts[part + 1]
        for term in range(2, len(weights), 2):
            _step_rows(first, last, start, neighbour, rate, now, before, np.float32(1.0))
            _add_step_rows(
                first,
                last,
                start,
                neighbour,
                rate,
                before,
                now,
                change,
                weights[term],
                weights[term + 1],
            )
