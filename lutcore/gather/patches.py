"""The light that enters a mesh, linear over patches of its triangles."""

from typing import NamedTuple

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import BoolArray, FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.fresnel import transmittances
from lutcore.lights import light_at
from lutcore.shading import ShadingInputs

# A triangle is cut in four where the light in the middle of an edge is off the mean of its ends
# by this share of the mean light, at most so often.
_DEVIATION = 5e-3
_DEEPEST = 5
_STACK = 3 * _DEEPEST + 4


class Patches(NamedTuple):
    """Triangles over which the light that enters is linear; dark ones are left out.

    Parameters
    ----------
    corners : ndarray, shape=(p, 3, 3)
        Positions of the corners, mm, corner by corner.
    light : ndarray, shape=(p, 3, 3)
        Linear RGB at each corner: sum over lights of E F_t(N.w) max(N.w, 0) V.
    """

    corners: FloatArray
    light: FloatArray


class _Surface(NamedTuple):
    points: FloatArray
    normals: FloatArray
    faces: IndexArray
    lights: FloatArray
    visible: FloatArray
    eta: FloatArray


def patches(inputs: ShadingInputs) -> Patches:
    """Sample the light that enters a mesh.

    Positions are those of the flat triangles; normals are interpolated between the corners, as
    local models are given them there, and made unit; so are the shares of visibility. Triangles
    are cut until the light is linear to .5 % of its mean, at most into 1024.

    Parameters
    ----------
    inputs : ShadingInputs
        Geometry, lights, material and visibility.

    Returns
    -------
    Patches
        In the order of the faces.
    """
    visible = np.ones((len(inputs.lights), 1, 3))
    if inputs.visibility is not None:
        visible = np.empty((*inputs.visibility.shape[:2], 3))
        visible[:] = np.atleast_3d(inputs.visibility)
    eta = np.array(inputs.material.eta)
    on = _Surface(inputs.points, inputs.normals, inputs.faces, inputs.lights, visible, eta)
    light = _at_vertices(on)
    limit = _DEVIATION * light.sum(axis=0) / np.maximum(np.count_nonzero(light, axis=0), 1)
    whole, count = _count(on, limit, light)
    start = np.cumsum(count) - count
    corners, light_of = np.empty((count.sum(), 3, 3)), np.empty((count.sum(), 3, 3))
    _fill(on, limit, light, whole, start, count, inputs.mm_per_unit, corners, light_of)
    return Patches(corners, light_of)


@compiled()
def _entering(on: _Surface, face: int, u: float, v: float) -> tuple[float, float, float]:
    """Return what enters at the barycentric coordinates 1 - u - v, u, v of a face."""
    a, b, c = on.faces[face, 0], on.faces[face, 1], on.faces[face, 2]
    w = 1.0 - u - v
    nx = w * on.normals[a, 0] + u * on.normals[b, 0] + v * on.normals[c, 0]
    ny = w * on.normals[a, 1] + u * on.normals[b, 1] + v * on.normals[c, 1]
    nz = w * on.normals[a, 2] + u * on.normals[b, 2] + v * on.normals[c, 2]
    red = green = blue = 0.0
    square = nx * nx + ny * ny + nz * nz
    if square == 0.0:
        return red, green, blue
    inverse = 1.0 / np.sqrt(square)
    px, py, pz = _position(on, face, u, v)
    for light in range(len(on.lights)):
        x, y, z, factor = light_at(on.lights, light, px, py, pz)
        cosine = min((nx * x + ny * y + nz * z) * inverse, 1.0)
        if cosine <= 0.0:
            continue
        let_in = transmittances(cosine, on.eta)
        reds, greens, blues = on.lights[light, 8], on.lights[light, 9], on.lights[light, 10]
        if on.visible.shape[1] > 1:
            share = on.visible[light]
            reds *= w * share[a, 0] + u * share[b, 0] + v * share[c, 0]
            greens *= w * share[a, 1] + u * share[b, 1] + v * share[c, 1]
            blues *= w * share[a, 2] + u * share[b, 2] + v * share[c, 2]
        red += factor * (cosine * let_in[0]) * reds
        green += factor * (cosine * let_in[1]) * greens
        blue += factor * (cosine * let_in[2]) * blues
    return red, green, blue


@compiled()
def _position(on: _Surface, face: int, u: float, v: float) -> tuple[float, float, float]:
    a, b, c = on.faces[face, 0], on.faces[face, 1], on.faces[face, 2]
    w = 1.0 - u - v
    return (
        w * on.points[a, 0] + u * on.points[b, 0] + v * on.points[c, 0],
        w * on.points[a, 1] + u * on.points[b, 1] + v * on.points[c, 1],
        w * on.points[a, 2] + u * on.points[b, 2] + v * on.points[c, 2],
    )


@compiled(parallel=True)
def _at_vertices(on: _Surface) -> FloatArray:
    """Return what enters at each vertex."""
    light = np.zeros((len(on.points), 3))
    for i in prange(len(on.points)):
        for one in range(len(on.lights)):
            x, y, z, factor = light_at(
                on.lights, one, on.points[i, 0], on.points[i, 1], on.points[i, 2]
            )
            cosine = on.normals[i, 0] * x + on.normals[i, 1] * y + on.normals[i, 2] * z
            if cosine <= 0.0:
                continue
            cosine = min(cosine, 1.0)
            let_in = transmittances(cosine, on.eta)
            vertex = min(np.int64(i), on.visible.shape[1] - 1)
            for channel in range(3):
                share = on.visible[one, vertex, channel]
                light[i, channel] += (
                    factor * (cosine * let_in[channel]) * share * on.lights[one, 8 + channel]
                )
    return light


@compiled()
def _bends(on: _Surface, face: int, part: FloatArray, limit: FloatArray, light: FloatArray) -> bool:
    """Tell whether light bends over a part; `part` holds u and v of its corners."""
    bends = False
    for j in range(3):
        k = (j + 1) % 3
        u, v = 0.5 * (part[j, 0] + part[k, 0]), 0.5 * (part[j, 1] + part[k, 1])
        between = _entering(on, face, u, v)
        for channel in range(3):
            mean = 0.5 * (light[j, channel] + light[k, channel])
            bends = bends or abs(between[channel] - mean) > limit[channel]
    return bends


@compiled()
def _quarter(whole: FloatArray, which: int, out: FloatArray) -> None:
    """Make one of the four quarters: three at the corners, and that between them."""
    for j in range(3):
        # The corner itself and the middles of its edges; the last has the middles alone.
        other = which if which < 3 else (j + 1) % 3
        for axis in range(whole.shape[1]):
            out[j, axis] = 0.5 * (whole[j, axis] + whole[other, axis])


@compiled()
def _cut(
    on: _Surface,
    face: int,
    limit: FloatArray,
    mm_per_unit: float,
    corners: FloatArray,
    light: FloatArray,
) -> int:
    """Cut a face until light is linear, and write the lit parts if there is room for them."""
    waiting, depth = np.zeros((_STACK, 3, 2)), np.zeros(_STACK, np.int64)
    part, found = np.empty((3, 2)), np.empty((3, 3))
    waiting[0, 1, 0] = waiting[0, 2, 1] = 1.0
    top, count = 1, 0
    while top > 0:
        top -= 1
        part[:], deep = waiting[top], depth[top]
        lit = False
        for j in range(3):
            found[j, 0], found[j, 1], found[j, 2] = _entering(on, face, part[j, 0], part[j, 1])
            lit = lit or found[j, 0] + found[j, 1] + found[j, 2] > 0.0
        if deep < _DEEPEST and _bends(on, face, part, limit, found):
            for which in range(4):
                _quarter(part, which, waiting[top])
                depth[top] = deep + 1
                top += 1
        elif lit:
            if len(corners) > 0:
                light[count] = found
                for j in range(3):
                    x, y, z = _position(on, face, part[j, 0], part[j, 1])
                    corners[count, j, 0] = mm_per_unit * x
                    corners[count, j, 1] = mm_per_unit * y
                    corners[count, j, 2] = mm_per_unit * z
            count += 1
    return count


@compiled(parallel=True)
def _count(
    on: _Surface, limit: FloatArray, light: FloatArray
) -> tuple[BoolArray, NDArray[np.int64]]:
    """Return which faces need no cut, and the number of patches of each."""
    whole, count = np.zeros(len(on.faces), np.bool_), np.zeros(len(on.faces), np.int64)
    nothing = np.empty((0, 3, 3))
    for face in prange(len(on.faces)):
        part, found = np.zeros((3, 2)), np.empty((3, 3))
        part[1, 0] = part[2, 1] = 1.0
        for j in range(3):
            for channel in range(3):
                found[j, channel] = light[on.faces[face, j], channel]
        whole[face] = not _bends(on, face, part, limit, found)
        if whole[face]:
            count[face] = 1 if found.max() > 0.0 else 0
        else:
            count[face] = _cut(on, face, limit, 1.0, nothing, nothing)
    return whole, count


@compiled(parallel=True)
def _fill(
    on: _Surface,
    limit: FloatArray,
    light: FloatArray,
    whole: BoolArray,
    start: NDArray[np.int64],
    count: NDArray[np.int64],
    mm_per_unit: float,
    corners: FloatArray,
    light_of: FloatArray,
) -> None:
    for face in prange(len(on.faces)):
        to = start[face]
        if count[face] == 0:
            continue
        if not whole[face]:
            end = to + count[face]
            _cut(on, face, limit, mm_per_unit, corners[to:end], light_of[to:end])
            continue
        for j in range(3):
            for axis in range(3):
                corners[to, j, axis] = mm_per_unit * on.points[on.faces[face, j], axis]
                light_of[to, j, axis] = light[on.faces[face, j], axis]
