"""An octree over patches of light: clusters that stand for all that lies in them."""

from typing import NamedTuple

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.gather.morton import LEVELS, codes
from lutcore.gather.patches import Patches
from lutcore.geometry import edge

_LEAF = 4
_STACK = 7 * LEVELS + 8
# Subtrees whose moments are found side by side hold so many patches at most.
_TOGETHER = 2048


class Octree(NamedTuple):
    """Clusters in the order of a depth-first walk.

    Parameters
    ----------
    ball : ndarray, shape=(k, 4)
        Centre of power of all channels together, mm, and the square of the radius of the ball
        around it that holds the cluster's patches, mm^2.
    terms : ndarray of float32, shape=(k, 10, 4)
        Moments of the light about that centre, mm^2, mm^3 and mm^4 times the unit of irradiance:
        the integral of the light, those of x, y and z times it, and those of xx, yy, zz, xy, yz
        and xz. Each of three channels, and a fourth of 0: vector instructions take four.
    skip : ndarray of int32, shape=(k,)
        The cluster that follows the whole subtree.
    first : ndarray of int32, shape=(k + 1,)
        Where the patches of a leaf begin, and p at the end; -1 for a cluster that is no leaf.
    corners : ndarray, shape=(p, 3, 3)
        Those of the patches, in the order of the leaves, mm.
    light : ndarray, shape=(p, 3, 3)
        Light at the corners.
    """

    ball: FloatArray
    terms: NDArray[np.float32]
    skip: IndexArray
    first: IndexArray
    corners: FloatArray
    light: FloatArray


def octree(of: Patches) -> Octree:
    """Build the octree.

    Parameters
    ----------
    of : Patches
        The patches; none are allowed.

    Returns
    -------
    Octree
        At most 4 patches in a leaf, but where more have their centres together; about 420 bytes a
        patch.
    """
    code = codes((of.corners[:, 0] + of.corners[:, 1] + of.corners[:, 2]) / 3.0)
    order = np.argsort(code, kind="stable")
    corners, light = of.corners[order], of.light[order]
    skip, first = _nodes(code[order])
    ball = np.zeros((len(skip), 4))
    terms = np.zeros((len(skip), 10, 4), np.float32)
    room = _STACK + int(np.diff(first[first >= 0]).max(initial=0))
    subtrees = _subtrees(skip, first)
    roots = _moments_below(subtrees, corners, light, skip, first, room, ball, terms)
    _moments_above(subtrees, *roots, skip, room, ball, terms)
    _enclose(corners, skip, first, ball)
    return Octree(ball, terms, skip, first, corners, light)


@compiled()
def _nodes(code: NDArray[np.int64]) -> tuple[IndexArray, IndexArray]:
    count = len(code)
    begin, end = np.empty(_STACK, np.int64), np.empty(_STACK, np.int64)
    level, parent = np.empty(_STACK, np.int64), np.empty(_STACK, np.int64)
    # Every inner node but for chains has two children; chains are passed over below.
    first = np.empty(2 * count + 1, np.int32)
    last_child = np.empty(2 * count + 1, np.int32)
    begin[0], end[0], level[0], parent[0] = 0, count, LEVELS, -1
    waiting, nodes = min(count, 1), 0
    while waiting > 0:
        waiting -= 1
        lo, hi, at = begin[waiting], end[waiting], level[waiting]
        if parent[waiting] >= 0:
            last_child[parent[waiting]] = nodes
        node, nodes = nodes, nodes + 1
        # Down to the level where its patches part.
        while at > 0 and code[lo] >> (3 * at - 3) == code[hi - 1] >> (3 * at - 3):
            at -= 1
        if hi - lo <= _LEAF or at == 0:
            first[node] = lo
            continue
        first[node] = -1
        at -= 1
        child_end, is_last = hi, True
        while child_end > lo:
            wanted = code[child_end - 1] >> (3 * at)
            child = lo + np.searchsorted(code[lo:child_end], wanted << (3 * at))
            begin[waiting], end[waiting], level[waiting] = child, child_end, at
            parent[waiting] = node if is_last else -1
            waiting += 1
            child_end, is_last = child, False
    first[nodes] = count
    skip = np.empty(nodes, np.int32)
    for node in range(nodes - 1, -1, -1):
        skip[node] = node + 1 if first[node] >= 0 else skip[last_child[node]]
    return skip, first[: nodes + 1].copy()


@compiled()
def patches_begin(node: int, first: IndexArray) -> int:
    """Return where the patches of a cluster begin (for compiled loops).

    Parameters
    ----------
    node : int
        The cluster; the number of clusters gives where all end.
    first : ndarray
        That of `Octree`.

    Returns
    -------
    int
        Where those of its first leaf begin.
    """
    leaf = np.int64(node)  # the index of a parallel loop is unsigned
    while first[leaf] < 0:
        leaf += 1
    begin: int = first[leaf]
    return begin


@compiled()
def patches_end(node: int, skip: IndexArray, first: IndexArray) -> int:
    """Return where the patches of a cluster end (for compiled loops).

    Parameters
    ----------
    node : int
        The cluster.
    skip, first : ndarray
        Those of `Octree`.

    Returns
    -------
    int
        Where those of the next leaf after it begin.
    """
    end: int = patches_begin(skip[node], first)
    return end


@compiled()
def _of_patch(
    corners: FloatArray, light: FloatArray, middle: FloatArray, terms: FloatArray
) -> None:
    """Write the mean corner of a patch and the moments of its light about that."""
    ux, uy, uz = edge(corners, 0, 1)
    vx, vy, vz = edge(corners, 0, 2)
    x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    area = 0.5 * np.sqrt(x * x + y * y + z * z)
    for axis in range(3):
        middle[axis] = (corners[0, axis] + corners[1, axis] + corners[2, axis]) / 3.0
    for channel in range(3):
        total = light[0, channel] + light[1, channel] + light[2, channel]
        terms[channel, 0] = area * total / 3.0
        # With lambda_j = 1 at corner j: int lambda_j light dA = area (light_j + total)/12;
        # int lambda_j^2 light dA = area (4 light_j + 2 total)/60, and
        # int lambda_j lambda_k light dA = area (light_j + light_k + total)/60.
        for axis in range(3):
            first = 0.0
            for j in range(3):
                first += light[j, channel] * (corners[j, axis] - middle[axis])
            terms[channel, 1 + axis] = area * first / 12.0
        for entry in range(6):
            p, q = entry % 3, (entry + entry // 3) % 3
            second = 0.0
            for j in range(3):
                k = (j + 1) % 3
                jp, jq = corners[j, p] - middle[p], corners[j, q] - middle[q]
                kp, kq = corners[k, p] - middle[p], corners[k, q] - middle[q]
                own, other = light[j, channel], light[k, channel]
                second += (4.0 * own + 2.0 * total) * jp * jq
                second += (own + other + total) * (jp * kq + kp * jq)
            terms[channel, 4 + entry] = area * second / 60.0


@compiled()
def _subtrees(skip: IndexArray, first: IndexArray) -> IndexArray:
    """Return the largest clusters of few patches, leaves at least; none lies in another."""
    found, count, node = np.empty(len(skip), np.int32), 0, 0
    while node < len(skip):
        few = patches_end(node, skip, first) - patches_begin(node, first) <= _TOGETHER
        if few or first[node] >= 0:
            found[count] = node
            node, count = skip[node], count + 1
        else:
            node += 1
    return found[:count]


@compiled(parallel=True)
def _moments_below(
    subtrees: IndexArray,
    corners: FloatArray,
    light: FloatArray,
    skip: IndexArray,
    first: IndexArray,
    room: int,
    ball: FloatArray,
    terms: NDArray[np.float32],
) -> tuple[FloatArray, FloatArray]:
    """Write the moments of the clusters of some subtrees, and return those of their roots.

    Double precision is kept on a stack: backwards, a cluster's parts are what was done last.
    """
    centres, found = np.zeros((len(subtrees), 3)), np.zeros((len(subtrees), 3, 10))
    for which in prange(len(subtrees)):
        root = np.int64(subtrees[which])
        middle, waiting = np.zeros((room, 3)), np.zeros((room, 3, 10))
        centre, whole = np.zeros(3), np.zeros((3, 10))
        top = 0
        for node in range(skip[root] - 1, root - 1, -1):
            if first[node] >= 0:
                begin, end = patches_begin(node, first), patches_end(node, skip, first)
                for patch in range(begin, end):
                    to = top + patch - begin
                    _of_patch(corners[patch], light[patch], middle[to], waiting[to])
                number = end - begin
            else:
                number = _children(node, skip)
                top -= number
            _join(middle[top : top + number], waiting[top : top + number], centre, whole)
            _write(centre, whole, ball[node], terms[node])
            _copy(centre, whole, middle[top], waiting[top])
            top += 1
        _copy(centre, whole, centres[which], found[which])
    return centres, found


@compiled()
def _moments_above(
    subtrees: IndexArray,
    centres: FloatArray,
    found: FloatArray,
    skip: IndexArray,
    room: int,
    ball: FloatArray,
    terms: NDArray[np.float32],
) -> None:
    """Write the moments of the clusters that hold the subtrees."""
    middle, waiting = np.zeros((room, 3)), np.zeros((room, 3, 10))
    centre, whole = np.zeros(3), np.zeros((3, 10))
    top, which, node = 0, len(subtrees) - 1, len(skip) - 1
    while node >= 0:
        if which >= 0 and node == skip[subtrees[which]] - 1:
            _copy(centres[which], found[which], middle[top], waiting[top])
            node, which = subtrees[which] - 1, which - 1
        else:
            number = _children(node, skip)
            top -= number
            _join(middle[top : top + number], waiting[top : top + number], centre, whole)
            _write(centre, whole, ball[node], terms[node])
            _copy(centre, whole, middle[top], waiting[top])
            node -= 1
        top += 1


@compiled()
def _copy(centre: FloatArray, whole: FloatArray, to: FloatArray, terms: FloatArray) -> None:
    """Write moments to another place; numba takes seconds to compile a slice's assignment."""
    for axis in range(3):
        to[axis] = centre[axis]
        for entry in range(10):
            terms[axis, entry] = whole[axis, entry]


@compiled()
def _children(node: int, skip: IndexArray) -> int:
    child, number = node + 1, 0
    while child < skip[node]:
        child, number = skip[child], number + 1
    return number


@compiled()
def _write(
    centre: FloatArray, whole: FloatArray, ball: FloatArray, terms: NDArray[np.float32]
) -> None:
    for axis in range(3):
        ball[axis] = centre[axis]
    for entry in range(10):
        for channel in range(3):
            terms[entry, channel] = whole[channel, entry]


@compiled()
def _join(
    centres: FloatArray,
    terms: FloatArray,
    centre: FloatArray,
    whole: FloatArray,
) -> None:
    """Write the common centre of power of several parts, and their moments about it."""
    power = 0.0
    for c in range(3):
        centre[c] = 0.0
        for entry in range(10):
            whole[c, entry] = 0.0
    for part in range(len(centres)):
        for c in range(3):
            power += terms[part, c, 0]
            for axis in range(3):
                centre[axis] += terms[part, c, 0] * centres[part, axis] + terms[part, c, 1 + axis]
    for axis in range(3):
        if power > 0.0:
            centre[axis] /= power
        else:  # triangles without an area
            centre[axis] = 0.0
            for part in range(len(centres)):
                centre[axis] += centres[part, axis] / len(centres)
    for part in range(len(centres)):
        x = centres[part, 0] - centre[0]
        y = centres[part, 1] - centre[1]
        z = centres[part, 2] - centre[2]
        for c in range(3):
            w = terms[part, c, 0]
            mx, my, mz = terms[part, c, 1], terms[part, c, 2], terms[part, c, 3]
            whole[c, 0] += w
            whole[c, 1] += mx + w * x
            whole[c, 2] += my + w * y
            whole[c, 3] += mz + w * z
            whole[c, 4] += terms[part, c, 4] + (2.0 * mx + w * x) * x
            whole[c, 5] += terms[part, c, 5] + (2.0 * my + w * y) * y
            whole[c, 6] += terms[part, c, 6] + (2.0 * mz + w * z) * z
            whole[c, 7] += terms[part, c, 7] + mx * y + my * x + w * x * y
            whole[c, 8] += terms[part, c, 8] + my * z + mz * y + w * y * z
            whole[c, 9] += terms[part, c, 9] + mx * z + mz * x + w * x * z


@compiled(parallel=True)
def _enclose(corners: FloatArray, skip: IndexArray, first: IndexArray, ball: FloatArray) -> None:
    for node in prange(len(skip)):
        largest = 0.0
        for patch in range(patches_begin(node, first), patches_end(node, skip, first)):
            for j in range(3):
                x = corners[patch, j, 0] - ball[node, 0]
                y = corners[patch, j, 1] - ball[node, 1]
                z = corners[patch, j, 2] - ball[node, 2]
                largest = max(largest, x * x + y * y + z * z)
        ball[node, 3] = largest
