"""The light that enters a mesh, linear over patches of its triangles."""

from typing import NamedTuple

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.gather.entering import Surface, at_vertices, entering, position, surface
from lutcore.geometry import edge
from lutcore.shading import ShadingInputs

# A triangle is cut in four where the light in the middle of an edge is off the mean of its ends
# by this share of the mean light, at most so often.
_DEVIATION = 5e-3
_DEEPEST = 5
# Over a triangle whose longest edge is as long as the shortest l_u light may bend by so much more
# than the error allowed: its power is kept, and the profile tells little more there.
_BLURRED = 64.0
# l_u counts up to this share of the mesh's diagonal.
_WIDE = 0.1
_STACK = 3 * _DEEPEST + 4
_CHUNK = 256
_BITS = 64
_ONE = np.uint64(1)


class Patches(NamedTuple):
    """Triangles over which the light that enters is linear; dark ones are left out.

    Parameters
    ----------
    corners : ndarray, shape=(p, 3, 3)
        Positions of the corners, mm, corner by corner.
    light : ndarray, shape=(p, 3, 3)
        Linear RGB at each corner: sum over lights of E F_t(N.w) max(N.w, 0) V, and what makes
        the power that of the patch.
    """

    corners: FloatArray
    light: FloatArray


class _Rule(NamedTuple):
    """When a part of a face is cut: see `_allowed`."""

    limit: FloatArray
    blurred: float


def patches(inputs: ShadingInputs, tolerance: float = 0.0) -> Patches:
    """Sample the light that enters a mesh.

    Positions are those of the flat triangles; normals are interpolated between the corners, as
    local models are given them there, and made unit; so are the shares of visibility. Triangles
    are cut until the light is linear to .5 % of its mean, at most into 1024. A patch has the power
    that the middles of its edges tell, exact where light is of the second order.

    Parameters
    ----------
    inputs : ShadingInputs
        Geometry, lights, material and visibility.
    tolerance : float
        Error allowed for what is gathered, relative, 0 or more: light may bend by 64 times as much
        over a patch whose longest edge is as long as the shortest l_u, by four times that over one
        half as long and so on.

    Returns
    -------
    Patches
        In the order of the faces.
    """
    on = surface(inputs)
    light = at_vertices(on)
    mean = light.sum(axis=0) / np.maximum(np.count_nonzero(light, axis=0), 1)
    shortest = float(inputs.material.mean_free_path.min()) / inputs.mm_per_unit
    # Where light crosses the body, its shape tells more than the profile.
    shortest = min(shortest, _WIDE * float(np.linalg.norm(np.ptp(inputs.points, axis=0))))
    rule = _Rule(_DEVIATION * mean, _BLURRED * tolerance / _DEVIATION * shortest**2)
    cuts, count, added = _count(on, rule, light)
    start = np.cumsum(count) - count
    corners, light_of = np.empty((count.sum(), 3, 3)), np.empty((count.sum(), 3, 3))
    _fill(on, rule, light, cuts, added, start, count, inputs.mm_per_unit, corners, light_of)
    return Patches(corners, light_of)


@compiled()
def power_of(corners: FloatArray, light: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Integrate over patches (in one order, whatever the number of threads).

    Parameters
    ----------
    corners, light : ndarray, shape=(p, 3, 3)
        Those of `Patches`.

    Returns
    -------
    tuple of ndarray, each shape=(3,)
        Of each channel, the integral of the light, and of the squares of the patches' means.
    """
    power, squares = np.zeros(3), np.zeros(3)
    for patch in range(len(corners)):
        ux, uy, uz = edge(corners[patch], 0, 1)
        vx, vy, vz = edge(corners[patch], 0, 2)
        x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        area = 0.5 * np.sqrt(x * x + y * y + z * z)
        for c in range(3):
            mean = (light[patch, 0, c] + light[patch, 1, c] + light[patch, 2, c]) / 3.0
            power[c] += area * mean
            squares[c] += area * mean * mean
    return power, squares


@compiled()
def _allowed(on: Surface, face: int, rule: _Rule) -> float:
    """Return how many times the limit light may bend by over a whole face, 1 or more."""
    longest = 0.0
    for j in range(3):
        a, b = on.faces[face, j], on.faces[face, (j + 1) % 3]
        x = on.points[a, 0] - on.points[b, 0]
        y = on.points[a, 1] - on.points[b, 1]
        z = on.points[a, 2] - on.points[b, 2]
        longest = max(longest, x * x + y * y + z * z)
    return rule.blurred / longest if longest > 0.0 else np.inf


@compiled()
def _middles(on: Surface, face: int, part: FloatArray, middle: FloatArray) -> None:
    """Write u, v and the light of the middles of a part's edges."""
    for j in range(3):
        k = (j + 1) % 3
        u, v = 0.5 * (part[j, 0] + part[k, 0]), 0.5 * (part[j, 1] + part[k, 1])
        middle[j, 0], middle[j, 1] = u, v
        middle[j, 2], middle[j, 3], middle[j, 4] = entering(on, face, u, v)


@compiled()
def _bends(part: FloatArray, middle: FloatArray, limit: FloatArray, allowed: float) -> bool:
    """Tell whether the light in a middle is too far off the mean of its ends."""
    for j in range(3):
        for entry in range(2, 5):
            mean = 0.5 * (part[j, entry] + part[(j + 1) % 3, entry])
            if abs(middle[j, entry] - mean) > max(allowed, 1.0) * limit[entry - 2]:
                return True
    return False


@compiled()
def _missing(part: FloatArray, middle: FloatArray, added: FloatArray) -> None:
    """Write what light over a part lacks of that in the middles of its edges, in the mean."""
    for c in range(3):
        ends = part[0, 2 + c] + part[1, 2 + c] + part[2, 2 + c]
        added[c] = (middle[0, 2 + c] + middle[1, 2 + c] + middle[2, 2 + c] - ends) / 3.0


@compiled()
def _lift(part: FloatArray, added: FloatArray) -> bool:
    """Add light to a part, nowhere to less than 0; tell whether any enters."""
    lit = False
    for c in range(2, 5):
        mean = (part[0, c] + part[1, c] + part[2, c]) / 3.0
        whole, least = mean + added[c - 2], min(part[0, c], part[1, c], part[2, c])
        share = 1.0
        if whole <= 0.0:  # dark but for a corner
            whole = share = 0.0
        elif least + added[c - 2] < 0.0:
            share = whole / (mean - least)
        for j in range(3):
            part[j, c] = max(whole + share * (part[j, c] - mean), 0.0)
        lit = lit or whole > 0.0
    return lit


@compiled()
def _whole(face: int, faces: IndexArray, light: FloatArray, part: FloatArray) -> None:
    """Write u, v and the light of a face's corners."""
    for j in range(3):
        part[j, 0] = part[j, 1] = 0.0
        for channel in range(3):
            part[j, 2 + channel] = light[faces[face, j], channel]
    part[1, 0] = part[2, 1] = 1.0


@compiled()
def _copy(part: FloatArray, to: FloatArray) -> None:
    """Write a part to another place; numba takes seconds to compile a slice's assignment."""
    for j in range(3):
        for entry in range(5):
            to[j, entry] = part[j, entry]


@compiled()
def _cut(
    on: Surface,
    face: int,
    rule: _Rule,
    mm_per_unit: float,
    waiting: FloatArray,
    depth: NDArray[np.int64],
    cuts: np.uint64,
    known: int,
    added: FloatArray,
    corners: FloatArray,
    light: FloatArray,
) -> tuple[int, np.uint64]:
    """Cut the face that waits until light is linear; write the lit parts if there is room for them.

    Returns how many are lit, and a bit for each of the first 64 parts, set where it is cut. As many
    of those in `cuts` as are `known` are taken for granted. So is, of a whole face that is not cut,
    what is `added`; it is written where nothing is known.
    """
    part, middle, more = np.empty((3, 5)), np.empty((3, 5)), np.empty(3)
    depth[0], top, count, seen = 0, 1, 0, 0
    allowed = _allowed(on, face, rule)
    while top > 0:
        top -= 1
        deep = depth[top]
        _copy(waiting[top], part)
        told = seen < known
        bends = told and bool((cuts >> np.uint64(seen)) & _ONE)
        if bends or not told or deep > 0:
            _middles(on, face, part, middle)
            _missing(part, middle, more)
        else:
            more[0], more[1], more[2] = added[0], added[1], added[2]
        if not told and deep < _DEEPEST:
            bends = _bends(part, middle, rule.limit, allowed * 4.0**deep)
            if bends and seen < _BITS:
                cuts |= _ONE << np.uint64(seen)
        seen += 1
        if bends:
            for which in range(3):
                for entry in range(5):
                    waiting[top, 0, entry] = part[which, entry]
                    waiting[top, 1, entry] = middle[which, entry]
                    waiting[top, 2, entry] = middle[(which + 2) % 3, entry]
                depth[top] = deep + 1
                top += 1
            _copy(middle, waiting[top])
            depth[top] = deep + 1
            top += 1
            continue
        if deep == 0 and not told:
            added[0], added[1], added[2] = more[0], more[1], more[2]
        if _lift(part, more):
            if len(corners) > 0:
                for j in range(3):
                    for c in range(3):
                        light[count, j, c] = part[j, 2 + c]
                    x, y, z = position(on, face, part[j, 0], part[j, 1])
                    corners[count, j, 0] = mm_per_unit * x
                    corners[count, j, 1] = mm_per_unit * y
                    corners[count, j, 2] = mm_per_unit * z
            count += 1
    return count, cuts


@compiled(parallel=True)
def _count(
    on: Surface, rule: _Rule, light: FloatArray
) -> tuple[NDArray[np.uint64], NDArray[np.int64], FloatArray]:
    """Return how each face is cut and what is added, see `_cut`, and the number of its patches."""
    cuts, count = np.zeros(len(on.faces), np.uint64), np.zeros(len(on.faces), np.int64)
    added = np.zeros((len(on.faces), 3))
    for chunk in prange((len(on.faces) + _CHUNK - 1) // _CHUNK):
        waiting, depth = np.empty((_STACK, 3, 5)), np.empty(_STACK, np.int64)
        nothing = np.empty((0, 3, 3))
        for face in range(chunk * _CHUNK, min((chunk + 1) * _CHUNK, len(on.faces))):
            _whole(face, on.faces, light, waiting[0])
            count[face], cuts[face] = _cut(
                on, face, rule, 1.0, waiting, depth, cuts[face], 0, added[face], nothing, nothing
            )
    return cuts, count, added


@compiled(parallel=True)
def _fill(
    on: Surface,
    rule: _Rule,
    light: FloatArray,
    cuts: NDArray[np.uint64],
    added: FloatArray,
    start: NDArray[np.int64],
    count: NDArray[np.int64],
    mm_per_unit: float,
    corners: FloatArray,
    light_of: FloatArray,
) -> None:
    for chunk in prange((len(on.faces) + _CHUNK - 1) // _CHUNK):
        waiting, depth = np.empty((_STACK, 3, 5)), np.empty(_STACK, np.int64)
        for face in range(chunk * _CHUNK, min((chunk + 1) * _CHUNK, len(on.faces))):
            if count[face] > 0:
                _whole(face, on.faces, light, waiting[0])
                begin, end = start[face], start[face] + count[face]
                some, lit = corners[begin:end], light_of[begin:end]
                more, cut = added[face], cuts[face]
                _cut(on, face, rule, mm_per_unit, waiting, depth, cut, _BITS, more, some, lit)
