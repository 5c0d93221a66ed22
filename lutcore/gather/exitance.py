"""Radiant exitance gathered from clusters of light, or from every patch of it."""

import numpy as np
from numba import prange
from numpy.typing import ArrayLike

from lutcore.arrays import FloatArray, IndexArray, finite
from lutcore.compiled import compiled
from lutcore.gather.kernel import Kernel, Radial, kernel, place, radial
from lutcore.gather.octree import Octree, octree, patches_end
from lutcore.gather.patches import Patches, patches
from lutcore.geometry import edge
from lutcore.progress import part as stage
from lutcore.progress import tell
from lutcore.shading import ShadingInputs

_CHUNK = 4096
# A patch is cut in four so often at most: down to a thousandth of l_u from a thousand l_u.
_STACK = 3 * 24 + 4
_BLOCK = 64
# The bound on a cluster's error at a tolerance of 1. Found, with a margin: large clusters near by
# are bounded so badly that the error grows as the bound to the power of two thirds.
_LOOSE = 2e5
_TINY = 1e-3
# Single triangles are less symmetric than clusters: their squares must be smaller.
_FINER = 0.2


def gathered(inputs: ShadingInputs, tolerance: float) -> FloatArray:
    """Gather at every vertex, far light by clusters.

    A cluster stands for its parts, by its moments up to the second, where it is off by less than
    `tolerance` of what it gives or of its share of the mean exitance. All are positive, so that
    the same holds for the sum. The bound on what a cluster is off by supposes that all its parts
    err alike and as much as any; it is taken at a share that makes the error found, root mean
    square, some two thirds of the tolerance at most (`tests/bench/gather.py`).

    Time grows as n log n. Memory is about 1 kB for each vertex.

    Parameters
    ----------
    inputs : ShadingInputs
        Geometry, lights, material, profile, visibility and progress.
    tolerance : float
        Relative error wanted, above 0.

    Returns
    -------
    ndarray, shape=(n, 3)
        Radiant exitance, linear RGB, before the exit Fresnel factor.

    Raises
    ------
    CancelledError
        If the progress asked to stop.

    References
    ----------
    H. W. Jensen and J. Buhler, A rapid hierarchical rendering technique for translucent materials,
    SIGGRAPH 2002: the octree. Their clusters are judged by their solid angle.
    """
    tell(inputs.progress, 0.0, "sampling the light that enters")
    of = patches(inputs)
    tell(inputs.progress, 0.05, "building the octree")
    tree = octree(of)
    known = _known(inputs)
    chosen = kernel(known, _LOOSE * tolerance**1.5, _negligible(known, of))
    return _in_chunks(inputs, inputs.points, tree, chosen)


def exact(inputs: ShadingInputs, points: ArrayLike, bound: float = 0.1) -> FloatArray:
    """Gather at some points from every patch, each cut until it is small enough.

    Parameters
    ----------
    inputs : ShadingInputs
        As for `gathered`.
    points : array_like, shape=(q, 3)
        Where, mesh units.
    bound : float
        Bound on the error of each part, above 0, relative to what it gives or to a thousandth of
        its share of the mean exitance. Errors found are below a thousandth of the bound.

    Returns
    -------
    ndarray, shape=(q, 3)
        Radiant exitance, linear RGB, before the exit Fresnel factor.

    Raises
    ------
    CancelledError
        If the progress asked to stop.
    """
    tell(inputs.progress, 0.0, "sampling the light that enters")
    targets = finite("points", points, (len(np.asarray(points)), 3))
    of, known = patches(inputs), _known(inputs)
    chosen = kernel(known, bound, _TINY * _negligible(known, of))
    return _in_chunks(inputs, targets, _row(of), chosen)


def _known(inputs: ShadingInputs) -> Radial:
    extent = np.ptp(inputs.points, axis=0) * inputs.mm_per_unit
    return radial(inputs.profile, inputs.material, float(np.linalg.norm(extent)))


def _negligible(known: Radial, of: Patches) -> FloatArray:
    """Return the R that, everywhere, would give all the light that enters the mean exitance.

    The mean is that of the flat limit R_d H, weighted by the light H: as the eye weights it.
    """
    crosses = np.cross(of.corners[:, 1] - of.corners[:, 0], of.corners[:, 2] - of.corners[:, 0])
    areas = 0.5 * np.sqrt(np.square(crosses).sum(axis=1))
    mean = of.light.mean(axis=1)
    power, squares = areas @ mean, areas @ np.square(mean)
    # R_d by the trapezoidal rule: int R dA = pi int R dv.
    total = np.pi * np.trapezoid(known.values, known.v, axis=0)
    floor: FloatArray = np.divide(total * squares, power**2, out=np.zeros(3), where=power > 0.0)
    return floor


def _row(of: Patches) -> Octree:
    """Return the patches as a tree of leaves alone, none of which may stand for its patch."""
    count = len(of.corners)
    ball, index = np.zeros((count, 4)), np.arange(count + 1, dtype=np.int32)
    ball[:, 3] = np.inf
    return Octree(ball, np.zeros((count, 3, 10)), index[1:], index, of.corners, of.light)


def _in_chunks(
    inputs: ShadingInputs, points: FloatArray, tree: Octree, chosen: Kernel
) -> FloatArray:
    targets = points * inputs.mm_per_unit
    out = np.empty((len(targets), 3))
    progress = stage(inputs.progress, 0.1, 1.0)
    for begin in range(0, len(targets), _CHUNK):
        tell(progress, begin / len(targets), "gathering light")
        out[begin : begin + _CHUNK] = _gather(*tree, *chosen, targets[begin : begin + _CHUNK])
    return out


@compiled(parallel=True)
def _gather(
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
