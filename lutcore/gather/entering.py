"""The light that enters a mesh, at its vertices and within its triangles; compiled."""

from typing import NamedTuple

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.fresnel import transmittances
from lutcore.lights import light_at
from lutcore.shading import ShadingInputs


class Surface(NamedTuple):
    """What light enters, for compiled loops.

    Parameters
    ----------
    points, normals : ndarray, shape=(n, 3)
        Vertices, mesh units, and their unit normals; 0 where unknown.
    faces : ndarray of int, shape=(m, 3)
        Indices of corners.
    lights : ndarray, shape=(l, LIGHT_FIELDS)
        What `lutcore.lights.pack` returned.
    visible : ndarray, shape=(l, 1, 3) or (l, n, 3)
        The share of each light that is seen.
    eta : ndarray, shape=(3,)
        Refractive index of each channel.
    """

    points: FloatArray
    normals: FloatArray
    faces: IndexArray
    lights: FloatArray
    visible: FloatArray
    eta: FloatArray


def surface(inputs: ShadingInputs) -> Surface:
    """Collect what light enters.

    Parameters
    ----------
    inputs : ShadingInputs
        Geometry, lights, material and visibility.

    Returns
    -------
    Surface
        The same in arrays.
    """
    visible = np.ones((len(inputs.lights), 1, 3))
    if inputs.visibility is not None:
        visible = np.empty((*inputs.visibility.shape[:2], 3))
        visible[:] = np.atleast_3d(inputs.visibility)
    eta = np.array(inputs.material.eta)
    return Surface(inputs.points, inputs.normals, inputs.faces, inputs.lights, visible, eta)


@compiled()
def entering(on: Surface, face: int, u: float, v: float) -> tuple[float, float, float]:
    """Return what enters at a point of a face (for compiled loops).

    Normals are interpolated between the corners and made unit; so are the shares of visibility.

    Parameters
    ----------
    on : Surface
        The surface.
    face : int
        Which triangle.
    u, v : float
        The point: barycentric coordinates 1 - u - v, u, v.

    Returns
    -------
    tuple of 3 floats
        Linear RGB: sum over lights of E F_t(N.w) max(N.w, 0) V.
    """
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
    px, py, pz = position(on, face, u, v)
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
def position(on: Surface, face: int, u: float, v: float) -> tuple[float, float, float]:
    """Return where a point of a face lies (for compiled loops).

    Parameters
    ----------
    on : Surface
        The surface.
    face : int
        Which triangle.
    u, v : float
        The point: barycentric coordinates 1 - u - v, u, v.

    Returns
    -------
    tuple of 3 floats
        Mesh units.
    """
    a, b, c = on.faces[face, 0], on.faces[face, 1], on.faces[face, 2]
    w = 1.0 - u - v
    return (
        w * on.points[a, 0] + u * on.points[b, 0] + v * on.points[c, 0],
        w * on.points[a, 1] + u * on.points[b, 1] + v * on.points[c, 1],
        w * on.points[a, 2] + u * on.points[b, 2] + v * on.points[c, 2],
    )


@compiled(parallel=True)
def at_vertices(on: Surface) -> FloatArray:
    """Return what enters at each vertex.

    Parameters
    ----------
    on : Surface
        The surface.

    Returns
    -------
    ndarray, shape=(n, 3)
        Linear RGB, as `entering` gives it.
    """
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
