"""The walk over clusters of light that neighbouring points share; compiled.

What is done for three channels at once is written out for four, so that it becomes one vector
instruction: `one`, `two` and so on are those of the channels, the last of which is 0.
"""

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.gather.kernel import place
from lutcore.gather.near import STACK, from_patch
from lutcore.gather.octree import patches_end

# Errors of expansions about the middle of a block have one sign for all far light; those of
# clusters differ.
_JOINT = 0.1
# A cluster larger than this, in radii of the block, is opened rather than taken for so many points
# and more one by one: its parts may do for all together.
_LARGE, _MANY = 2.0, 4

# A vertex may lie on the ball around a cluster: rounding must not say which side.
_APART = 1e-6


@compiled(parallel=True)
def gates(
    ball: FloatArray, terms: NDArray[np.float32], bend: FloatArray, distance: FloatArray
) -> FloatArray:
    """Say from which distance on each cluster may stand for its parts.

    Parameters
    ----------
    ball, terms : ndarray
        Those of `lutcore.gather.octree.Octree`.
    bend, distance : ndarray
        Those of `lutcore.gather.kernel.Kernel`.

    Returns
    -------
    ndarray, shape=(k, 8)
        The centre, mm; the square of the distance, mm^2; the radius, mm; and of the channel where
        each is largest the second, first and zeroth moment.
    """
    out = np.empty((len(ball), 8))
    for node in prange(len(ball)):
        radius, reach = np.sqrt(ball[node, 3]), 0.0
        second = first = power = 0.0
        for c in range(3):
            x, y, z = terms[node, 1, c], terms[node, 2, c], terms[node, 3, c]
            spread = np.float64(terms[node, 4, c]) + terms[node, 5, c] + terms[node, 6, c]
            low, high = 0, len(distance) - 1
            while low < high:
                middle = (low + high) // 2
                # The third moment is at most the radius times the second.
                if radius * spread * bend[middle, c] <= 1.0:
                    high = middle
                else:
                    low = middle + 1
            reach = max(reach, (1.0 + _APART) * (radius + distance[low]))
            second, power = max(second, spread), max(power, np.float64(terms[node, 0, c]))
            first = max(first, np.sqrt(np.float64(x * x + y * y + z * z)))
        out[node, 0], out[node, 1], out[node, 2] = ball[node, 0], ball[node, 1], ball[node, 2]
        out[node, 3], out[node, 4], out[node, 5] = reach * reach, radius, second
        out[node, 6], out[node, 7] = first, power
    return out


@compiled(parallel=True, packed=True)
def gather_at(
    gate: FloatArray,
    terms: NDArray[np.float32],
    skip: IndexArray,
    first: IndexArray,
    corners: FloatArray,
    light: FloatArray,
    rows: FloatArray,
    per_step: FloatArray,
    bend: FloatArray,
    inner: float,
    knot: int,
    targets: FloatArray,
    start: NDArray[np.int64],
) -> FloatArray:
    """Add up what clusters and patches give (for `lutcore.gather.exitance`).

    Parameters
    ----------
    gate : ndarray
        From `gates`.
    terms, skip, first, corners, light : ndarray
        Those of `lutcore.gather.octree.Octree`.
    rows, per_step, bend, inner, knot : ndarray, float, int
        Those of `lutcore.gather.kernel.Kernel`.
    targets : ndarray, shape=(q, 3)
        Where, mm.
    start : ndarray of int64, shape=(blocks + 1,)
        Where each block of neighbouring targets begins, and where the last ends.

    Returns
    -------
    ndarray, shape=(start[-1] - start[0], 3)
        Radiant exitance.
    """
    out = np.empty((start[-1] - start[0], 3))
    for block in prange(len(start) - 1):
        begin, end = start[block], start[block + 1]
        some, count = targets[begin:end], end - begin
        total, local = np.zeros((count, 4)), np.zeros((10, 4))
        near = np.empty(count, np.int64)
        stack, shade, share = np.empty((STACK, 3, 3)), np.zeros((STACK, 3, 4)), np.empty(STACK)
        x, y, z, wide, high, deep = _box(some)
        radius = _radius(some, x, y, z)
        node, last = 0, len(skip)
        while node < last:
            dx, dy, dz = x - gate[node, 0], y - gate[node, 1], z - gate[node, 2]
            size = gate[node, 4]
            square = dx * dx + dy * dy + dz * dz
            if square >= gate[node, 3]:
                gap = max(np.sqrt(square) - size - radius, 0.0)
                at, _ = place(gap * gap, inner, knot)
                moment = gate[node, 5] + radius * (2.0 * gate[node, 6] + radius * gate[node, 7])
                if (size + radius) * moment * bend[at, 3] <= _JOINT:
                    _expand(terms, node, dx, dy, dz, rows, per_step, inner, knot, local)
                    node = skip[node]
                    continue
            if first[node] < 0:
                ax, ay, az = abs(dx) - wide, abs(dy) - high, abs(dz) - deep
                ax, ay, az = max(ax, 0.0), max(ay, 0.0), max(az, 0.0)
                large = count >= _MANY and size > _LARGE * radius
                if large or ax * ax + ay * ay + az * az < gate[node, 3]:
                    node += 1
                    continue
            close = 0
            for i in range(count):
                dx = some[i, 0] - gate[node, 0]
                dy = some[i, 1] - gate[node, 1]
                dz = some[i, 2] - gate[node, 2]
                # Where the box of all is far enough so is each, whatever is rounded.
                if first[node] < 0 or dx * dx + dy * dy + dz * dz >= gate[node, 3]:
                    _add_cluster(terms, node, dx, dy, dz, rows, per_step, inner, knot, total, i)
                else:
                    near[close] = i
                    close += 1
            if close > 0:
                for patch in range(first[node], patches_end(node, skip, first)):
                    from_patch(
                        corners[patch],
                        light[patch],
                        some,
                        near[:close],
                        rows,
                        bend,
                        inner,
                        knot,
                        stack,
                        shade,
                        share,
                        total,
                    )
            node = skip[node]
        for i in range(count):
            dx, dy, dz = some[i, 0] - x, some[i, 1] - y, some[i, 2] - z
            for c in range(3):
                # Where it is too far to matter the second order may overshoot.
                given = max(_expanded(local, c, dx, dy, dz), 0.0) + total[i, c]
                out[begin - start[0] + i, c] = given
    return out


@compiled()
def _box(points: FloatArray) -> tuple[float, float, float, float, float, float]:
    """Return the middle and half the sizes of the box around some points."""
    x = y = z = np.inf
    to_x = to_y = to_z = -np.inf
    for i in range(len(points)):
        x, to_x = min(x, points[i, 0]), max(to_x, points[i, 0])
        y, to_y = min(y, points[i, 1]), max(to_y, points[i, 1])
        z, to_z = min(z, points[i, 2]), max(to_z, points[i, 2])
    middle = 0.5 * (x + to_x), 0.5 * (y + to_y), 0.5 * (z + to_z)
    return *middle, to_x - middle[0], to_y - middle[1], to_z - middle[2]


@compiled()
def _radius(points: FloatArray, x: float, y: float, z: float) -> float:
    square = 0.0
    for i in range(len(points)):
        dx, dy, dz = points[i, 0] - x, points[i, 1] - y, points[i, 2] - z
        square = max(square, dx * dx + dy * dy + dz * dz)
    return float(np.sqrt(square))


@compiled()
def _radial(rows: FloatArray, at: int, c: int, t: float) -> tuple[float, float, float]:
    """Return R and its first two derivatives by t."""
    c1, c2, c3 = rows[at, 1, c], rows[at, 2, c], rows[at, 3, c]
    value = rows[at, 0, c] + t * (c1 + t * (c2 + t * c3))
    return value, c1 + t * (2.0 * c2 + 3.0 * t * c3), 2.0 * c2 + 6.0 * t * c3


@compiled()
def _second_order(
    terms: NDArray[np.float32],
    node: int,
    c: int,
    x: float,
    y: float,
    z: float,
    radial: tuple[float, float, float],
    step: float,
) -> float:
    """Return what a cluster gives in one channel, to the second order of its size.

    With R(r) = f(r^2), the moments W, m and Q about its centre and d = (x, y, z) from there to the
    target, that is W f - 2 f' m d + f' tr Q + 2 f'' d Q d.
    """
    value, slope, second = radial[0], step * radial[1], 2.0 * step * step * radial[2]
    qxx, qyy, qzz = terms[node, 4, c], terms[node, 5, c], terms[node, 6, c]
    across = x * terms[node, 1, c] + y * terms[node, 2, c] + z * terms[node, 3, c]
    mixed = terms[node, 7, c] * (x * y) + terms[node, 8, c] * (y * z) + terms[node, 9, c] * (x * z)
    along = qxx * (x * x) + qyy * (y * y) + qzz * (z * z) + 2.0 * mixed
    trace = np.float64(qxx) + qyy + qzz
    return float(terms[node, 0, c] * value + slope * (trace - 2.0 * across) + second * along)


@compiled()
def _add_cluster(
    terms: NDArray[np.float32],
    node: int,
    x: float,
    y: float,
    z: float,
    rows: FloatArray,
    per_step: FloatArray,
    inner: float,
    knot: int,
    total: FloatArray,
    i: int,
) -> None:
    at, t = place(x * x + y * y + z * z, inner, knot)
    step = per_step[at]
    one = _second_order(terms, node, 0, x, y, z, _radial(rows, at, 0, t), step)
    two = _second_order(terms, node, 1, x, y, z, _radial(rows, at, 1, t), step)
    three = _second_order(terms, node, 2, x, y, z, _radial(rows, at, 2, t), step)
    four = _second_order(terms, node, 3, x, y, z, _radial(rows, at, 3, t), step)
    # Where it is too far to matter the second order may overshoot; the truth is positive.
    total[i, 0] += max(one, 0.0)
    total[i, 1] += max(two, 0.0)
    total[i, 2] += max(three, 0.0)
    total[i, 3] += max(four, 0.0)


@compiled()
def _expansion(
    terms: NDArray[np.float32],
    node: int,
    c: int,
    x: float,
    y: float,
    z: float,
    radial: tuple[float, float, float],
    step: float,
) -> tuple[float, float, float, float, float, float, float, float, float, float]:
    """Return one channel of what a cluster gives about a point, to the second order of both sizes.

    Moved by e, d becomes d + e: to what `_second_order` gives are added
    2 f' (W d - m) e - 4 f'' (m d) (d e) and W (f' e e + 2 f'' (d e)^2).
    """
    power = np.float64(terms[node, 0, c])
    mx, my, mz = terms[node, 1, c], terms[node, 2, c], terms[node, 3, c]
    slope, second = step * radial[1], 2.0 * step * step * radial[2]
    along = 2.0 * (slope * power - second * (mx * x + my * y + mz * z))
    flat, steep = slope * power, second * power
    twice, double = 2.0 * slope, 2.0 * steep
    return (
        _second_order(terms, node, c, x, y, z, radial, step),
        along * x - twice * mx,
        along * y - twice * my,
        along * z - twice * mz,
        flat + steep * (x * x),
        flat + steep * (y * y),
        flat + steep * (z * z),
        double * (x * y),
        double * (y * z),
        double * (x * z),
    )


@compiled()
def _expand(
    terms: NDArray[np.float32],
    node: int,
    x: float,
    y: float,
    z: float,
    rows: FloatArray,
    per_step: FloatArray,
    inner: float,
    knot: int,
    local: FloatArray,
) -> None:
    at, t = place(x * x + y * y + z * z, inner, knot)
    step = per_step[at]
    one = _expansion(terms, node, 0, x, y, z, _radial(rows, at, 0, t), step)
    two = _expansion(terms, node, 1, x, y, z, _radial(rows, at, 1, t), step)
    three = _expansion(terms, node, 2, x, y, z, _radial(rows, at, 2, t), step)
    four = _expansion(terms, node, 3, x, y, z, _radial(rows, at, 3, t), step)
    _add(local, 0, one[0], two[0], three[0], four[0])
    _add(local, 1, one[1], two[1], three[1], four[1])
    _add(local, 2, one[2], two[2], three[2], four[2])
    _add(local, 3, one[3], two[3], three[3], four[3])
    _add(local, 4, one[4], two[4], three[4], four[4])
    _add(local, 5, one[5], two[5], three[5], four[5])
    _add(local, 6, one[6], two[6], three[6], four[6])
    _add(local, 7, one[7], two[7], three[7], four[7])
    _add(local, 8, one[8], two[8], three[8], four[8])
    _add(local, 9, one[9], two[9], three[9], four[9])


@compiled()
def _add(local: FloatArray, entry: int, one: float, two: float, three: float, four: float) -> None:
    local[entry, 0] += one
    local[entry, 1] += two
    local[entry, 2] += three
    local[entry, 3] += four


@compiled()
def _expanded(local: FloatArray, c: int, x: float, y: float, z: float) -> float:
    first = local[0, c] + local[1, c] * x + local[2, c] * y + local[3, c] * z
    second = (local[4, c] * x + local[7, c] * y + local[9, c] * z) * x
    second += (local[5, c] * y + local[8, c] * z) * y + local[6, c] * z * z
    return float(first + second)
