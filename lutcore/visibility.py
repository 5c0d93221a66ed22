"""Cast shadows: whether a light reaches a vertex, and the same softened as light spreads it.

A ray from the vertex to the light is stopped where it enters the body, that is where it meets a
face from the front. On a closed surface nothing else stops it: whatever shadows a point is entered
on the way. So no convex body shadows itself, however coarse its faces and wrong its normals, and a
vertex at the terminator is not hidden by its own neighbours. On an open surface a sheet shadows
from behind, too, but not within twice the longest edge at the vertex. Faces at the vertex
itself never do.
"""

from dataclasses import dataclass

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray, IndexArray
from lutcore.bvh import Bvh, bvh, stopped
from lutcore.compiled import compiled
from lutcore.cosmoothing import surface
from lutcore.lights import light_at
from lutcore.lowpass import low_pass
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress, part, silent, tell
from lutcore.recurrence import FIELDS
from lutcore.weld import weld

# Duplicated vertices lie in faces of their twins: hits nearer than this share of an edge are own.
_NEAR_FRONT, _NEAR_BACK = 1e-6, 2.0
# In l_u psi(0): the least error on bowls under a low light, from 2 to 3.
_SOFTENING = 2.0
_CHUNK = 1 << 14
_FORECAST = 4096
_NEEDED = 0.01


def visibility(mesh: TriangleMesh, lights: FloatArray, progress: Progress = silent) -> FloatArray:
    """Return which lights reach which vertices.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface, which casts the shadows.
    lights : ndarray, shape=(l, LIGHT_FIELDS)
        See `lutcore.lights.pack`.
    progress : callable
        Told where the work stands.

    Returns
    -------
    ndarray, shape=(l, n)
        1 where the light is seen and 0 where it is hidden, whether the vertex faces the light or
        not; 1 outside a cone, where there is nothing to hide.

    Raises
    ------
    CancelledError
        If the progress asked to stop.
    """
    tell(progress, 0.0, "building the hierarchy of boxes")
    rays = _Rays.of(mesh)
    seen = np.empty((len(lights), len(mesh.vertices)))
    every = np.arange(len(mesh.vertices), dtype=np.int32)
    for begin in range(0, len(every), _CHUNK):
        tell(part(progress, 0.1, 1.0), begin / len(every), "casting shadows")
        chunk = every[begin : begin + _CHUNK]
        seen[:, chunk] = rays.cast(chunk, lights)
    return seen


def softened(
    seen: FloatArray, mesh: TriangleMesh, glow: FloatArray, progress: Progress = silent
) -> FloatArray:
    """Return the shares of visibility that a local model needs, blurred as light spreads.

    Light carries the edge of a shadow by l_u psi(0), so that each channel is blurred along the
    surface by the filter of `low_pass` at the scale 2 l_u psi(0). A model that gathers spreads
    light itself and must be given the shares as they are.

    Parameters
    ----------
    seen : ndarray, shape=(l, n)
        What `visibility` returned.
    mesh : TriangleMesh
        The surface.
    glow : ndarray, shape=(3,)
        l_u psi(0) of each channel, mesh units; by the psi table.
    progress : callable
        Told where the work stands.

    Returns
    -------
    ndarray, shape=(l, n, 3)
        0 to 1, by channel; a light that reaches every vertex is 1 everywhere.

    Raises
    ------
    CancelledError
        If the progress asked to stop.
    """
    soft = np.repeat(seen[:, :, None], 3, axis=2)
    edged = np.flatnonzero(seen.min(axis=1, initial=1.0) != seen.max(axis=1, initial=0.0))
    welded = weld(mesh)
    if welded.mesh is None or not len(edged):
        return soft
    on = surface(welded.mesh, part(progress, 0.0, 0.2))
    scales = np.minimum(_SOFTENING * glow, welded.mesh.diagonal)
    for begin in range(0, len(edged), FIELDS):
        group = edged[begin : begin + FIELDS]
        shares = np.zeros((len(welded.mesh.vertices), FIELDS))
        for column, light in enumerate(group):
            shares[:, column] = welded.gather(seen[light])
        stage = part(progress, 0.2 + 0.8 * begin / len(edged), 1.0)
        change = low_pass(on.operator, shares, scales.tolist(), stage)
        blurred = np.clip(shares + change, 0.0, 1.0)  # the filter overshoots at an edge
        for column, light in enumerate(group):
            for channel in range(3):
                soft[light, :, channel] = welded.spread(blurred[channel, :, column], 1.0)
    return soft


@dataclass(frozen=True)
class ShadowForecast:
    """What cast shadows would change.

    Parameters
    ----------
    share : float
        Of the pairs of a light and a vertex that faces it, how many are in shadow, 0 to 1.
    change : float
        Root mean square over the vertices of the irradiance that the shadows take, over that of
        the irradiance without shadows, 0 to 1.
    """

    share: float
    change: float

    @property
    def needed(self) -> bool:
        """Whether a picture without shadows would be off by more than 1 %, root mean square."""
        return self.change > _NEEDED


def forecast(
    mesh: TriangleMesh, normals: FloatArray, lights: FloatArray, seed: int = 0
) -> ShadowForecast:
    """Tell from a sample of the vertices what cast shadows would change.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    normals : ndarray, shape=(n, 3)
        Outward unit normals.
    lights : ndarray, shape=(l, LIGHT_FIELDS)
        See `lutcore.lights.pack`.
    seed : int
        Seed of the choice of at most 4096 vertices; all are taken where there are no more.

    Returns
    -------
    ShadowForecast
        Exactly 0 for a convex body.
    """
    count = len(mesh.vertices)
    chosen = np.arange(count, dtype=np.int32)
    if count > _FORECAST:
        chosen = np.random.default_rng(seed).choice(chosen, _FORECAST, replace=False)
        chosen.sort()
    # Each light counts with its own strength: one far behind the others changes little.
    lit = _irradiance(mesh.vertices, normals, lights, chosen)
    if not lit.any():
        return ShadowForecast(0.0, 0.0)
    hidden = lit * (1.0 - _Rays.of(mesh).cast(chosen, lights))
    share = np.count_nonzero(hidden) / np.count_nonzero(lit)
    taken, all_ = np.square(hidden.sum(axis=0)).sum(), np.square(lit.sum(axis=0)).sum()
    return ShadowForecast(float(share), float(np.sqrt(taken / all_)))


@dataclass(frozen=True)
class _Rays:
    tree: Bvh
    edge: FloatArray
    closed: bool

    @classmethod
    def of(cls, mesh: TriangleMesh) -> "_Rays":
        return cls(bvh(mesh), _longest_edges(mesh.vertices, mesh.faces), _closed(mesh))

    def cast(self, chosen: IndexArray, lights: FloatArray) -> FloatArray:
        seen: FloatArray = _cast(*self.tree, self.edge, self.closed, chosen, lights)
        return seen


def _closed(mesh: TriangleMesh) -> bool:
    """Tell whether every edge is run along as often one way as the other."""
    tail = mesh.faces.astype(np.int64).ravel()
    head = mesh.faces[:, [1, 2, 0]].astype(np.int64).ravel()
    count = len(mesh.vertices)
    there, back = np.sort(tail * count + head), np.sort(head * count + tail)
    return bool(np.array_equal(there, back))


@compiled()
def _longest_edges(vertices: FloatArray, faces: IndexArray) -> FloatArray:
    longest = np.zeros(len(vertices))
    for face in range(len(faces)):
        for j in range(3):
            a, b = faces[face, j], faces[face, (j + 1) % 3]
            square = 0.0
            for axis in range(3):
                square += (vertices[a, axis] - vertices[b, axis]) ** 2
            longest[a], longest[b] = max(longest[a], square), max(longest[b], square)
    return np.sqrt(longest)


@compiled(parallel=True)
def _cast(
    box: FloatArray,
    skip: IndexArray,
    first: IndexArray,
    triangle: IndexArray,
    vertices: FloatArray,
    faces: IndexArray,
    edge: FloatArray,
    closed: bool,
    chosen: IndexArray,
    lights: FloatArray,
) -> FloatArray:
    seen = np.ones((len(lights), len(chosen)))
    for k in prange(len(chosen)):
        i = chosen[k]
        way = np.empty(3)
        for light in range(len(lights)):
            x, y, z, strength = light_at(
                lights, light, vertices[i, 0], vertices[i, 1], vertices[i, 2]
            )
            if strength == 0.0:
                continue
            way[0], way[1], way[2] = x, y, z
            # The strength of a light at a distance is 1/distance^2.
            far = np.inf if lights[light, 0] == 0.0 else 1.0 / np.sqrt(strength)
            near_back = far if closed else _NEAR_BACK * edge[i]
            if stopped(
                box,
                skip,
                first,
                vertices,
                faces,
                vertices[i],
                way,
                _NEAR_FRONT * edge[i],
                near_back,
                far,
                i,
            ):
                seen[light, k] = 0.0
    return seen


@compiled(parallel=True)
def _irradiance(
    points: FloatArray, normals: FloatArray, lights: FloatArray, chosen: IndexArray
) -> FloatArray:
    lit = np.zeros((len(lights), len(chosen)))
    for k in prange(len(chosen)):
        i = chosen[k]
        for light in range(len(lights)):
            x, y, z, strength = light_at(lights, light, points[i, 0], points[i, 1], points[i, 2])
            cosine = normals[i, 0] * x + normals[i, 1] * y + normals[i, 2] * z
            rgb = lights[light, 8] + lights[light, 9] + lights[light, 10]
            lit[light, k] = strength * max(cosine, 0.0) * rgb / 3.0
    return lit
