"""The light that enters a mesh, linear over patches of its triangles."""

from typing import NamedTuple

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.fresnel import transmittances
from lutcore.geometry import edge
from lutcore.lights import light_at
from lutcore.shading import ShadingInputs

# A triangle is cut in four where the light in the middle of an edge is off the mean of its ends
# by this share of the mean light, at most so often.
_DEVIATION = 5e-3
_DEEPEST = 5
_STACK = 3 * _DEEPEST + 4
_CHUNK = 256
_BITS = 64
_NONE, _ONE = np.uint64(0), np.uint64(1)


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
    cuts, count = _count(on, limit, light)
    start = np.cumsum(count) - count
    corners, light_of = np.empty((count.sum(), 3, 3)), np.empty((count.sum(), 3, 3))
    _fill(on, limit, light, cuts, start, count, inputs.mm_per_unit, corners, light_of)
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
def _middles(
    on: _Surface, face: int, part: FloatArray, limit: FloatArray, middle: FloatArray
) -> bool:
    """Write u, v and the light of the middles of a part's edges; tell whether light bends there."""
    bends = False
    for j in range(3):
        k = (j + 1) % 3
        u, v = 0.5 * (part[j, 0] + part[k, 0]), 0.5 * (part[j, 1] + part[k, 1])
        middle[j, 0], middle[j, 1] = u, v
        middle[j, 2], middle[j, 3], middle[j, 4] = _entering(on, face, u, v)
        for entry in range(2, 5):
            mean = 0.5 * (part[j, entry] + part[k, entry])
            bends = bends or abs(middle[j, entry] - mean) > limit[entry - 2]
    return bends


@compiled()
def _whole(face: int, faces: IndexArray, light: FloatArray, part: FloatArray) -> None:
    """Write u, v and the light of a face's corners."""
    part[:, :2] = 0.0
    part[1, 0] = part[2, 1] = 1.0
    for j in range(3):
        for channel in range(3):
            part[j, 2 + channel] = light[faces[face, j], channel]


@compiled()
def _cut(
    on: _Surface,
    face: int,
    limit: FloatArray,
    mm_per_unit: float,
    waiting: FloatArray,
    depth: NDArray[np.int64],
    cuts: np.uint64,
    known: int,
    corners: FloatArray,
    light: FloatArray,
) -> tuple[int, np.uint64]:
    """Cut the face that waits until light is linear; write the lit parts if there is room for them.

    Returns how many are lit, and a bit for each of the first 64 parts, set where it is cut. As many
    of those in `cuts` as are `known` are taken for granted: light is looked up only where needed.
    """
    part, middle = np.empty((3, 5)), np.empty((3, 5))
    depth[0], top, count, seen = 0, 1, 0, 0
    while top > 0:
        top -= 1
        part[:], deep = waiting[top], depth[top]
        bends = deep < _DEEPEST
        if seen < known:
            bends = bool((cuts >> np.uint64(seen)) & _ONE)
        if bends:
            bends = _middles(on, face, part, limit, middle)
        if bends and known <= seen < _BITS:
            cuts |= _ONE << np.uint64(seen)
        seen += 1
        if bends:
            for which in range(3):
                waiting[top, 0] = part[which]
                waiting[top, 1] = middle[which]
                waiting[top, 2] = middle[(which + 2) % 3]
                depth[top] = deep + 1
                top += 1
            waiting[top], depth[top] = middle, deep + 1
            top += 1
        elif part[:, 2:].max() > 0.0:
            if len(corners) > 0:
                light[count] = part[:, 2:]
                for j in range(3):
                    x, y, z = _position(on, face, part[j, 0], part[j, 1])
                    corners[count, j, 0] = mm_per_unit * x
                    corners[count, j, 1] = mm_per_unit * y
                    corners[count, j, 2] = mm_per_unit * z
            count += 1
    return count, cuts


@compiled(parallel=True)
def _count(
    on: _Surface, limit: FloatArray, light: FloatArray
) -> tuple[NDArray[np.uint64], NDArray[np.int64]]:
    """Return how each face is cut, see `_cut`, and the number of its patches."""
    cuts, count = np.zeros(len(on.faces), np.uint64), np.zeros(len(on.faces), np.int64)
    for chunk in prange((len(on.faces) + _CHUNK - 1) // _CHUNK):
        waiting, depth = np.empty((_STACK, 3, 5)), np.empty(_STACK, np.int64)
        nothing = np.empty((0, 3, 3))
        for face in range(chunk * _CHUNK, min((chunk + 1) * _CHUNK, len(on.faces))):
            _whole(face, on.faces, light, waiting[0])
            count[face], cuts[face] = _cut(
                on, face, limit, 1.0, waiting, depth, _NONE, 0, nothing, nothing
            )
    return cuts, count


@compiled(parallel=True)
def _fill(
    on: _Surface,
    limit: FloatArray,
    light: FloatArray,
    cuts: NDArray[np.uint64],
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
                some = corners[start[face] : start[face] + count[face]]
                lit = light_of[start[face] : start[face] + count[face]]
                _cut(on, face, limit, mm_per_unit, waiting, depth, cuts[face], _BITS, some, lit)
