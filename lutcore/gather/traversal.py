"""The walk over clusters of light, from each point of a chunk; compiled."""

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.gather.kernel import place
from lutcore.gather.octree import patches_end
from lutcore.geometry import edge

# A patch is cut in four so often at most: down to a thousandth of l_u from a thousand l_u.
_STACK = 3 * 24 + 4
_BLOCK = 64
# Single triangles are less symmetric than clusters: their squares must be smaller.
_FINER = 0.2


@compiled(parallel=True)
def gather_at(
    ball: FloatArray,
    terms: FloatArray,
    skip: IndexArray,
    first: IndexArray,
    corners: FloatArray,
    light: FloatArray,
    rows: FloatArray,
    per_step: FloatArray,
    allowed: FloatArray,
    inner: float,
    knot: int,
    targets: FloatArray,
) -> FloatArray:
    """Add up what clusters and patches give (for `lutcore.gather.exitance`).

    Parameters
    ----------
    ball, terms, skip, first, corners, light : ndarray
        Those of `lutcore.gather.octree.Octree`.
    rows, per_step, allowed, inner, knot : ndarray, float, int
        Those of `lutcore.gather.kernel.Kernel`.
    targets : ndarray, shape=(q, 3)
        Where, mm.

    Returns
    -------
    ndarray, shape=(q, 3)
        Radiant exitance.
    """
    out = np.empty((len(targets), 3))
    for block in prange((len(targets) + _BLOCK - 1) // _BLOCK):
        stack, shade, share = np.empty((_STACK, 3, 3)), np.empty((_STACK, 3, 3)), np.empty(_STACK)
        total = np.empty(3)
        for i in range(block * _BLOCK, min((block + 1) * _BLOCK, len(targets))):
            x, y, z = targets[i, 0], targets[i, 1], targets[i, 2]
            red = green = blue = 0.0
            total[:] = 0.0
            node, last = 0, len(skip)
            while node < last:
                dx, dy, dz = x - ball[node, 0], y - ball[node, 1], z - ball[node, 2]
                at, _ = place(dx * dx + dy * dy + dz * dz, inner, knot)
                if ball[node, 3] <= allowed[at]:
                    r, g, b = _cluster(terms, node, dx, dy, dz, rows, per_step, inner, knot)
                    red, green, blue = red + r, green + g, blue + b
                    node = skip[node]
                elif first[node] >= 0:
                    for patch in range(first[node], patches_end(node, skip, first)):
                        _open(
                            corners[patch],
                            light[patch],
                            x,
                            y,
                            z,
                            rows,
                            allowed,
                            inner,
                            knot,
                            stack,
                            shade,
                            share,
                            total,
                        )
                    node = skip[node]
                else:
                    node += 1
            out[i, 0], out[i, 1], out[i, 2] = red + total[0], green + total[1], blue + total[2]
    return out


@compiled(packed=True)
def _cluster(
    terms: FloatArray,
    node: int,
    x: float,
    y: float,
    z: float,
    rows: FloatArray,
    per_step: FloatArray,
    inner: float,
    knot: int,
) -> tuple[float, float, float]:
    """Return what a cluster gives, to the second order of its size.

    With R(r) = f(r^2), the moments W, m and Q about its centre and d = (x, y, z) from there to the
    target, that is W f - 2 f' m d + f' tr Q + 2 f'' d Q d.
    """
    xx, yy, zz, xy, yz, xz = x * x, y * y, z * z, 2.0 * x * y, 2.0 * y * z, 2.0 * x * z
    at, t = place(xx + yy + zz, inner, knot)
    step = per_step[at]
    double = 2.0 * step * step
    out = (0.0, 0.0, 0.0)
    for c in range(3):
        c1, c2, c3 = rows[at, c, 1], rows[at, c, 2], rows[at, c, 3]
        value = rows[at, c, 0] + t * (c1 + t * (c2 + t * c3))
        slope = step * (c1 + t * (2.0 * c2 + 3.0 * t * c3))
        second = double * (2.0 * c2 + 6.0 * t * c3)
        qxx, qyy, qzz = terms[node, c, 4], terms[node, c, 5], terms[node, c, 6]
        across = x * terms[node, c, 1] + y * terms[node, c, 2] + z * terms[node, c, 3]
        along = qxx * xx + qyy * yy + qzz * zz
        along += terms[node, c, 7] * xy + terms[node, c, 8] * yz + terms[node, c, 9] * xz
        given = terms[node, c, 0] * value + slope * (qxx + qyy + qzz - 2.0 * across)
        given += second * along
        # Where it is too far to matter the second order may overshoot; the truth is positive.
        out = (out[1], out[2], max(given, 0.0))
    return out


@compiled()
def _open(
    corners: FloatArray,
    light: FloatArray,
    x: float,
    y: float,
    z: float,
    rows: FloatArray,
    allowed: FloatArray,
    inner: float,
    knot: int,
    stack: FloatArray,
    shade: FloatArray,
    share: FloatArray,
    total: FloatArray,
) -> None:
    """Add what a patch gives, cut until its parts are small enough.

    A part is integrated by the middles of its edges, which is exact to the second order.
    """
    ux, uy, uz = edge(corners, 0, 1)
    vx, vy, vz = edge(corners, 0, 2)
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    # A third of the area by each middle, and half of the light at each end.
    stack[0], shade[0], share[0] = corners, light, np.sqrt(nx * nx + ny * ny + nz * nz) / 12.0
    top = 1
    while top > 0:
        top -= 1
        mx = (stack[top, 0, 0] + stack[top, 1, 0] + stack[top, 2, 0]) / 3.0
        my = (stack[top, 0, 1] + stack[top, 1, 1] + stack[top, 2, 1]) / 3.0
        mz = (stack[top, 0, 2] + stack[top, 1, 2] + stack[top, 2, 2]) / 3.0
        at, _ = place((mx - x) ** 2 + (my - y) ** 2 + (mz - z) ** 2, inner, knot)
        if _farthest(stack, top, mx, my, mz) <= _FINER * allowed[at] or top > _STACK - 5:
            for j in range(3):
                k = (j + 1) % 3
                dx = 0.5 * (stack[top, j, 0] + stack[top, k, 0]) - x
                dy = 0.5 * (stack[top, j, 1] + stack[top, k, 1]) - y
                dz = 0.5 * (stack[top, j, 2] + stack[top, k, 2]) - z
                at, t = place(dx * dx + dy * dy + dz * dz, inner, knot)
                for c in range(3):
                    bend = rows[at, c, 2] + t * rows[at, c, 3]
                    value = rows[at, c, 0] + t * (rows[at, c, 1] + t * bend)
                    total[c] += share[top] * value * (shade[top, j, c] + shade[top, k, c])
            continue
        # The three quarters at the corners, and then that of the middles in place of the whole.
        for which in range(1, 4):
            share[top + which] = 0.25 * share[top]
            for j in range(3):
                for k in range(3):
                    stack[top + which, j, k] = 0.5 * (stack[top, j, k] + stack[top, which - 1, k])
                    shade[top + which, j, k] = 0.5 * (shade[top, j, k] + shade[top, which - 1, k])
        share[top] *= 0.25
        for k in range(3):
            a, b, c = stack[top, 0, k], stack[top, 1, k], stack[top, 2, k]
            stack[top, 0, k], stack[top, 1, k] = 0.5 * (a + b), 0.5 * (b + c)
            stack[top, 2, k] = 0.5 * (c + a)
            a, b, c = shade[top, 0, k], shade[top, 1, k], shade[top, 2, k]
            shade[top, 0, k], shade[top, 1, k] = 0.5 * (a + b), 0.5 * (b + c)
            shade[top, 2, k] = 0.5 * (c + a)
        top += 4


@compiled()
def _farthest(stack: FloatArray, top: int, x: float, y: float, z: float) -> float:
    largest = 0.0
    for j in range(3):
        dx, dy, dz = stack[top, j, 0] - x, stack[top, j, 1] - y, stack[top, j, 2] - z
        largest = max(largest, dx * dx + dy * dy + dz * dz)
    return largest
