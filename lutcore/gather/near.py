"""What a patch gives to the points near it, cut until its parts are small enough; compiled."""

import numpy as np
from numpy.typing import NDArray

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled
from lutcore.gather.kernel import place
from lutcore.geometry import edge

# A patch is cut in four so often at most: down to a thousandth of l_u from a thousand l_u.
STACK = 3 * 24 + 4
"""Parts that may wait."""
# The third moment of an even triangle is at most 1/4 of its power times the cube of its radius,
# that of the middles of its edges 1/8.
_THIRD = 0.375


@compiled(packed=True)
def from_patch(
    corners: FloatArray,
    light: FloatArray,
    targets: FloatArray,
    near: NDArray[np.int64],
    rows: FloatArray,
    bend: FloatArray,
    inner: float,
    knot: int,
    stack: FloatArray,
    shade: FloatArray,
    share: FloatArray,
    total: FloatArray,
) -> None:
    """Add what a patch gives to some targets (for compiled loops).

    A part is integrated by the middles of its edges, which is exact to the second order.

    Parameters
    ----------
    corners, light : ndarray, shape=(3, 3)
        Those of the patch, see `lutcore.gather.patches.Patches`.
    targets : ndarray, shape=(q, 3)
        Where, mm.
    near : ndarray of int64
        Which of them.
    rows, bend, inner, knot : ndarray, float, int
        Those of `lutcore.gather.kernel.Kernel`.
    stack, shade, share : ndarray, shapes=((STACK, 3, 3), (STACK, 3, 4), (STACK,))
        Room for corners, light and areas of parts; the fourth channel of the light is 0.
    total : ndarray, shape=(q, 4)
        Added to.
    """
    ux, uy, uz = edge(corners, 0, 1)
    vx, vy, vz = edge(corners, 0, 2)
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    # A third of the area by each middle, and half of the light at each end.
    share[0] = np.sqrt(nx * nx + ny * ny + nz * nz) / 12.0
    for j in range(3):
        for k in range(3):
            stack[0, j, k], shade[0, j, k] = corners[j, k], light[j, k]
    top = 1
    while top > 0:
        top -= 1
        if top > STACK - 5 or _small(stack, shade, share, top, targets, near, bend, inner, knot):
            for j in range(3):
                _middle(stack, shade, share, top, j, targets, near, rows, inner, knot, total)
        else:
            _quarter(stack, shade, share, top)
            top += 4


@compiled()
def _small(
    stack: FloatArray,
    shade: FloatArray,
    share: FloatArray,
    top: int,
    targets: FloatArray,
    near: NDArray[np.int64],
    bend: FloatArray,
    inner: float,
    knot: int,
) -> bool:
    """Tell whether a part need not be cut for any of the targets."""
    x = (stack[top, 0, 0] + stack[top, 1, 0] + stack[top, 2, 0]) / 3.0
    y = (stack[top, 0, 1] + stack[top, 1, 1] + stack[top, 2, 1]) / 3.0
    z = (stack[top, 0, 2] + stack[top, 1, 2] + stack[top, 2, 2]) / 3.0
    square = 0.0
    for j in range(3):
        dx, dy, dz = stack[top, j, 0] - x, stack[top, j, 1] - y, stack[top, j, 2] - z
        square = max(square, dx * dx + dy * dy + dz * dz)
    nearest = np.inf
    for i in near:
        dx, dy, dz = targets[i, 0] - x, targets[i, 1] - y, targets[i, 2] - z
        nearest = min(nearest, dx * dx + dy * dy + dz * dz)
    radius = np.sqrt(square)
    gap = max(np.sqrt(nearest) - radius, 0.0)
    at, _ = place(gap * gap, inner, knot)
    third = 2.0 * _THIRD * share[top] * square * radius
    for c in range(3):
        if third * (shade[top, 0, c] + shade[top, 1, c] + shade[top, 2, c]) * bend[at, c] > 1.0:
            return False
    return True


@compiled()
def _middle(
    stack: FloatArray,
    shade: FloatArray,
    share: FloatArray,
    top: int,
    j: int,
    targets: FloatArray,
    near: NDArray[np.int64],
    rows: FloatArray,
    inner: float,
    knot: int,
    total: FloatArray,
) -> None:
    """Add what the middle of an edge gives, with its share of a part's light."""
    k = (j + 1) % 3
    x = 0.5 * (stack[top, j, 0] + stack[top, k, 0])
    y = 0.5 * (stack[top, j, 1] + stack[top, k, 1])
    z = 0.5 * (stack[top, j, 2] + stack[top, k, 2])
    red = share[top] * (shade[top, j, 0] + shade[top, k, 0])
    green = share[top] * (shade[top, j, 1] + shade[top, k, 1])
    blue = share[top] * (shade[top, j, 2] + shade[top, k, 2])
    none = share[top] * (shade[top, j, 3] + shade[top, k, 3])
    for i in near:
        dx, dy, dz = targets[i, 0] - x, targets[i, 1] - y, targets[i, 2] - z
        at, t = place(dx * dx + dy * dy + dz * dz, inner, knot)
        one = red * _value(rows, at, 0, t)
        two = green * _value(rows, at, 1, t)
        three = blue * _value(rows, at, 2, t)
        four = none * _value(rows, at, 3, t)
        total[i, 0] += one
        total[i, 1] += two
        total[i, 2] += three
        total[i, 3] += four


@compiled()
def _value(rows: FloatArray, at: int, c: int, t: float) -> float:
    bend = rows[at, 2, c] + t * rows[at, 3, c]
    return float(rows[at, 0, c] + t * (rows[at, 1, c] + t * bend))


@compiled()
def _quarter(stack: FloatArray, shade: FloatArray, share: FloatArray, top: int) -> None:
    """Put the three quarters at the corners above a part, and that of the middles in its place."""
    for which in range(1, 4):
        share[top + which] = 0.25 * share[top]
        for j in range(3):
            for k in range(3):
                stack[top + which, j, k] = 0.5 * (stack[top, j, k] + stack[top, which - 1, k])
                shade[top + which, j, k] = 0.5 * (shade[top, j, k] + shade[top, which - 1, k])
    share[top] *= 0.25
    for k in range(3):
        a, b, c = stack[top, 0, k], stack[top, 1, k], stack[top, 2, k]
        stack[top, 0, k], stack[top, 1, k], stack[top, 2, k] = _middles(a, b, c)
        a, b, c = shade[top, 0, k], shade[top, 1, k], shade[top, 2, k]
        shade[top, 0, k], shade[top, 1, k], shade[top, 2, k] = _middles(a, b, c)


@compiled()
def _middles(a: float, b: float, c: float) -> tuple[float, float, float]:
    return 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
