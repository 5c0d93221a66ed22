"""An octree over patches of light: clusters that stand for all that lies in them."""

from typing import NamedTuple

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.gather.patches import Patches
from lutcore.geometry import edge

# Bits of a Morton code by axis.
_LEVELS = 20
_LEAF = 4
_STACK = 7 * _LEVELS + 8


class Octree(NamedTuple):
    """Clusters in the order of a depth-first walk.

    Parameters
    ----------
    ball : ndarray, shape=(k, 4)
        Centre of power of all channels together, mm, and the square of the radius of the ball
        around it that holds the cluster's patches, mm^2.
    terms : ndarray, shape=(k, 3, 10)
        Moments of the light about that centre, channel by channel, mm^2, mm^3 and mm^4 times the
        unit of irradiance: the integral of the light, those of x, y and z times it, and those of
        xx, yy, zz, xy, yz and xz.
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
    terms: FloatArray
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
        At most 2 patches in a leaf, but where more have their centres together; about 500 bytes a
        patch.
    """
    code = _codes(of.corners)
    order = np.argsort(code, kind="stable")
    corners, light = of.corners[order], of.light[order]
    skip, first = _nodes(code[order])
    ball, terms = _moments(*_of_patches(corners, light), skip, first)
    _enclose(corners, skip, first, ball)
    return Octree(ball, terms, skip, first, corners, light)


def _codes(corners: FloatArray) -> NDArray[np.int64]:
    centres = corners.mean(axis=1)
    if not len(centres):
        return np.empty(0, np.int64)
    low = centres.min(axis=0)
    extent = float((centres.max(axis=0) - low).max())
    cells = (centres - low) * ((2.0**_LEVELS - 1.0) / extent if extent > 0.0 else 0.0)
    codes: NDArray[np.int64] = _interleaved(cells.astype(np.int64))
    return codes


@compiled(parallel=True)
def _interleaved(cells: NDArray[np.int64]) -> NDArray[np.int64]:
    code = np.zeros(len(cells), np.int64)
    for i in prange(len(cells)):
        for bit in range(_LEVELS):
            for axis in range(3):
                code[i] |= ((cells[i, axis] >> bit) & 1) << (3 * bit + axis)
    return code


@compiled()
def _nodes(code: NDArray[np.int64]) -> tuple[IndexArray, IndexArray]:
    count = len(code)
    begin, end = np.empty(_STACK, np.int64), np.empty(_STACK, np.int64)
    level, parent = np.empty(_STACK, np.int64), np.empty(_STACK, np.int64)
    # Every inner node but for chains has two children; chains are passed over below.
    first = np.empty(2 * count + 1, np.int32)
    last_child = np.empty(2 * count + 1, np.int32)
    begin[0], end[0], level[0], parent[0] = 0, count, _LEVELS, -1
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


@compiled(parallel=True)
def _of_patches(corners: FloatArray, light: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the mean corner of each patch and the moments of its light about that."""
    middle, terms = np.empty((len(corners), 3)), np.empty((len(corners), 3, 10))
    for patch in prange(len(corners)):
        ux, uy, uz = edge(corners[patch], 0, 1)
        vx, vy, vz = edge(corners[patch], 0, 2)
        x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        area = 0.5 * np.sqrt(x * x + y * y + z * z)
        arm = np.empty((3, 3))
        for axis in range(3):
            a, b, c = corners[patch, 0, axis], corners[patch, 1, axis], corners[patch, 2, axis]
            mean = (a + b + c) / 3.0
            middle[patch, axis] = mean
            arm[0, axis], arm[1, axis], arm[2, axis] = a - mean, b - mean, c - mean
        for channel in range(3):
            total = light[patch, 0, channel] + light[patch, 1, channel] + light[patch, 2, channel]
            terms[patch, channel, 0] = area * total / 3.0
            # With lambda_j = 1 at corner j: int lambda_j light dA = area (light_j + total)/12;
            # int lambda_j^2 light dA = area (4 light_j + 2 total)/60, and
            # int lambda_j lambda_k light dA = area (light_j + light_k + total)/60.
            for axis in range(3):
                first = 0.0
                for j in range(3):
                    first += light[patch, j, channel] * arm[j, axis]
                terms[patch, channel, 1 + axis] = area * first / 12.0
            for entry in range(6):
                p, q = entry % 3, (entry + entry // 3) % 3
                second = 0.0
                for j in range(3):
                    k = (j + 1) % 3
                    own, other = light[patch, j, channel], light[patch, k, channel]
                    second += (4.0 * own + 2.0 * total) * arm[j, p] * arm[j, q]
                    both = arm[j, p] * arm[k, q] + arm[k, p] * arm[j, q]
                    second += (own + other + total) * both
                terms[patch, channel, 4 + entry] = area * second / 60.0
    return middle, terms


@compiled()
def _moments(
    middle: FloatArray, of_patches: FloatArray, skip: IndexArray, first: IndexArray
) -> tuple[FloatArray, FloatArray]:
    ball, terms = np.zeros((len(skip), 4)), np.zeros((len(skip), 3, 10))
    part = np.empty(8, np.int64)
    for node in range(len(skip) - 1, -1, -1):
        if first[node] >= 0:
            begin, end = patches_begin(node, first), patches_end(node, skip, first)
            _join(middle, of_patches, np.arange(begin, end), ball[node], terms[node])
        else:
            child, number = node + 1, 0
            while child < skip[node]:
                part[number] = child
                child, number = skip[child], number + 1
            _join(ball, terms, part[:number], ball[node], terms[node])
    return ball, terms


@compiled()
def _join(
    centres: FloatArray,
    terms: FloatArray,
    parts: NDArray[np.int64],
    centre: FloatArray,
    whole: FloatArray,
) -> None:
    """Write the common centre of power of several parts, and their moments about it."""
    power = 0.0
    for part in parts:
        for c in range(3):
            power += terms[part, c, 0]
            for axis in range(3):
                centre[axis] += terms[part, c, 0] * centres[part, axis] + terms[part, c, 1 + axis]
    for axis in range(3):
        if power > 0.0:
            centre[axis] /= power
        else:  # triangles without an area
            centre[axis] = centres[parts, axis].mean()
    for part in parts:
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
