"""Curvature from positions and normals that were smoothed alike.

Positions X and normals N go through one filter; then dN = S dX over a star gives the shape
operator S. That is exact wherever N is affine in X (plane, sphere, cylinder) on any triangulation
and at any scale, because both sides were averaged with the same weights.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import FloatArray, SingleArray
from lutcore.compiled import compiled
from lutcore.geometry import median_vertex_area, vertex_corners
from lutcore.laplacian import Laplacian, laplacian
from lutcore.lowpass import low_pass
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress, part, silent, tell
from lutcore.stars import stars
from lutcore.tensors import Vector, symmetric_fit, tangent_frame

# A star narrower than this, in spacings, is a point to single precision.
_POINT = 1e-4
# Pairs of a star count by 1/(distance^2 + this, in spacings): as directions, but for those so close
# that their noise would be multiplied. Counted alike, the far ends of long triangles would tell how
# curvature changes in place of what it is: k1 of a tube of 8:1 triangles came out 28 % too small.
_NEAR = 0.1


@dataclass(frozen=True)
class Surface:
    """What the smoothing of one mesh needs, whatever the scales.

    Parameters
    ----------
    points : ndarray, shape=(n, 3)
        Positions of the vertices.
    fields : ndarray, shape=(n, 6)
        Mean positions and unit normals of their stars.
    areas : ndarray, shape=(n,)
        Vertex areas, mesh units squared.
    operator : Laplacian
        What smooths the fields.
    spacing : float
        Square root of the median vertex area, mesh units.
    """

    points: FloatArray
    fields: FloatArray
    areas: FloatArray
    operator: Laplacian
    spacing: float


@dataclass(frozen=True)
class Smoothed:
    """Shape operators of a mesh at several scales, in one tangent frame for each vertex.

    Parameters
    ----------
    scales : tuple of float
        The scales, mesh units, growing; the first is 0, the star as it is.
    normals : ndarray, shape=(n, 3)
        Unit normals at the base scale; tensors are in their `tangent_frame`.
    tensors : ndarray of float32, shape=(n, S, 3)
        Entries xx, xy, yy of the shape operator, 1/mesh unit.
    stretch : ndarray of float32, shape=(n, S)
        How far smoothing left the star open: the ratio of its least extent to that before; 0 for
        one that is no more than a point.
    """

    scales: tuple[float, ...]
    normals: FloatArray
    tensors: SingleArray
    stretch: SingleArray


def surface(mesh: TriangleMesh, progress: Progress = silent) -> Surface:
    """Return what `smooth` needs of a mesh.

    Parameters
    ----------
    mesh : TriangleMesh
        Centred, every vertex used by a face with an area.
    progress : callable
        Told where the work stands.

    Returns
    -------
    Surface
        Its fields and Laplacian.
    """
    tell(progress, 0.0, "reading the neighbourhoods")
    corners = vertex_corners(mesh)
    tell(progress, 0.1, "averaging over stars")
    areas, fields = stars(mesh, corners)
    typical = median_vertex_area(areas)
    tell(progress, 0.4, "weighing neighbours")
    operator = laplacian(mesh, corners, areas, typical)
    return Surface(mesh.vertices, fields, areas, operator, float(np.sqrt(typical)))


def smooth(
    on: Surface, scales: Sequence[float], base: int = 0, progress: Progress = silent
) -> Smoothed:
    """Return the shape operators at several scales, from one recurrence.

    Parameters
    ----------
    on : Surface
        The mesh.
    scales : sequence of float
        Scales of the smoothing as `low_pass` counts them, mesh units, positive and growing.
    base : int
        Which of them gives the normals.
    progress : callable
        Told where the work stands.

    Returns
    -------
    Smoothed
        Tensors of scale 0 and of all scales given.
    """
    change = low_pass(on.operator, on.fields, scales, part(progress, 0.0, 0.7))
    tell(progress, 0.7, "fitting shape operators")
    normals, tensors, stretch = shape_operators(
        *on.operator.links, on.fields, change, base, on.spacing
    )
    return Smoothed((0.0, *scales), normals, tensors, stretch)


@compiled()
def _normal(fields: FloatArray, change: SingleArray, base: int, i: int) -> Vector:
    """Return the unit normal of a vertex after one of the smoothings."""
    nx = fields[i, 3] + change[base, i, 3]
    ny = fields[i, 4] + change[base, i, 4]
    nz = fields[i, 5] + change[base, i, 5]
    length = np.sqrt(nx * nx + ny * ny + nz * nz)
    if length < 0.1:  # smoothed over a closed blob: no side is outside any more
        nx, ny, nz, length = fields[i, 3], fields[i, 4], fields[i, 5], 1.0
    return nx / length, ny / length, nz / length


def smoothed_normals(fields: FloatArray, change: SingleArray, base: int) -> FloatArray:
    """Return the normals after one smoothing, where nothing else of it is wanted.

    Parameters
    ----------
    fields : ndarray, shape=(n, 6)
        `Surface.fields`.
    change : ndarray of float32, shape=(S, n, 6)
        How far each smoothing moves them; see `lutcore.lowpass`.
    base : int
        Which of them.

    Returns
    -------
    ndarray, shape=(n, 3)
        Unit normals, to the last bit those of `shape_operators`.
    """
    normals = np.empty((len(fields), 3))
    _write_normals(fields, change, base, normals)
    return normals


@compiled(parallel=True)
def _write_normals(fields: FloatArray, change: SingleArray, base: int, normals: FloatArray) -> None:
    for i in prange(len(fields)):
        normals[i, 0], normals[i, 1], normals[i, 2] = _normal(fields, change, base, i)


def shape_operators(
    start: NDArray[np.uint32],
    neighbour: NDArray[np.uint32],
    fields: FloatArray,
    change: SingleArray,
    base: int,
    spacing: float,
    first: int = 0,
) -> tuple[FloatArray, SingleArray, SingleArray]:
    """Fit the shape operators of all stars, unsmoothed and after each smoothing.

    Parameters
    ----------
    start, neighbour : ndarray of uint32
        `Laplacian.links`.
    fields : ndarray, shape=(n, 6)
        `Surface.fields`.
    change : ndarray of float32, shape=(S, n, 6)
        How far each smoothing moves them; see `lutcore.lowpass`.
    base : int
        Which of them gives the normals.
    spacing : float
        `Surface.spacing`.
    first : int
        The smoothing to begin with; 0 is none.

    Returns
    -------
    tuple of ndarray
        `Smoothed.normals`, and `tensors` and `stretch` of the smoothings from `first` to S.
    """
    count, scales = change.shape[1], change.shape[0] + 1 - first
    normals = np.empty((count, 3))
    tensors = np.empty((count, scales, 3), np.float32)
    stretch = np.empty((count, scales), np.float32)
    fit_shape_operators(
        start, neighbour, fields, change, base, spacing, first, normals, tensors, stretch
    )
    return normals, tensors, stretch


@compiled(parallel=True, packed=True)
def fit_shape_operators(
    start: NDArray[np.uint32],
    neighbour: NDArray[np.uint32],
    fields: FloatArray,
    change: SingleArray,
    base: int,
    spacing: float,
    first: int,
    normals: FloatArray,
    tensors: SingleArray,
    stretch: SingleArray,
) -> None:
    """Do what `shape_operators` does, into arrays that are there."""
    count, scales = change.shape[1], change.shape[0]
    unit = spacing * spacing
    point, near = _POINT * _POINT * unit, _NEAR * unit
    widest = 0
    for i in range(count):
        widest = max(widest, int(np.int64(start[i + 1]) - np.int64(start[i])))
    for i in prange(count):
        n = _normal(fields, change, base, i)
        normals[i, 0], normals[i, 1], normals[i, 2] = n
        u, v = tangent_frame(n[0], n[1], n[2])
        # What no smoothing changes of a pair: its weight, and where it was.
        pairs = np.empty((widest, 5))
        begin, size = start[i], start[i + 1] - start[i]
        cxx = cxy = cyy = 0.0
        for at in range(size):
            weight, xu, xv, nu, nv = _pair(fields, i, neighbour[begin + at], u, v, unit, near)
            pairs[at, 0], pairs[at, 1], pairs[at, 2] = weight, xu, xv
            pairs[at, 3], pairs[at, 4] = nu, nv
            pu, pv = weight * xu, weight * xv
            cxx, cxy, cyy = cxx + pu * xu, cxy + pu * xv, cyy + pv * xv
        open_before = max(_least(cxx, cxy, cyy), 1e-12 * (cxx + cyy))
        for scale in range(first, scales + 1):
            cxx = cxy = cyy = bxx = bxy = byy = 0.0
            for at in range(size):
                weight, xu, xv = pairs[at, 0], pairs[at, 1], pairs[at, 2]
                nu, nv = pairs[at, 3], pairs[at, 4]
                if scale > 0:
                    j = neighbour[begin + at]
                    for axis in range(3):
                        dx = change[scale - 1, j, axis] - change[scale - 1, i, axis]
                        dn = change[scale - 1, j, axis + 3] - change[scale - 1, i, axis + 3]
                        xu, xv = xu + dx * u[axis], xv + dx * v[axis]
                        nu, nv = nu + dn * u[axis], nv + dn * v[axis]
                pu, pv = weight * xu, weight * xv
                cxx, cxy, cyy = cxx + pu * xu, cxy + pu * xv, cyy + pv * xv
                bxx, bxy, byy = bxx + nu * pu, bxy + 0.5 * (nu * pv + nv * pu), byy + nv * pv
            to = scale - first
            stretch[i, to] = np.sqrt(max(_least(cxx, cxy, cyy), 0.0) / open_before)
            if cxx + cyy < point:
                stretch[i, to] = 0.0
                cxx = cxy = cyy = 0.0
            s = symmetric_fit(cxx, cxy, cyy, bxx, bxy, byy)
            tensors[i, to, 0], tensors[i, to, 1], tensors[i, to, 2] = s


@compiled()
def _pair(
    fields: FloatArray, i: int, j: int, u: Vector, v: Vector, unit: float, near: float
) -> tuple[float, float, float, float, float]:
    """Return the weight of an unsmoothed pair, and its dx and dN in the tangent plane."""
    xu = xv = nu = nv = 0.0
    weight = near
    for axis in range(3):
        dx = fields[j, axis] - fields[i, axis]
        dn = fields[j, axis + 3] - fields[i, axis + 3]
        weight += dx * dx
        xu, xv = xu + dx * u[axis], xv + dx * v[axis]
        nu, nv = nu + dn * u[axis], nv + dn * v[axis]
    return unit / weight, xu, xv, nu, nv


@compiled()
def _least(xx: float, xy: float, yy: float) -> float:
    """Return the smaller eigenvalue of a symmetric tensor."""
    half = 0.5 * (xx - yy)
    return 0.5 * (xx + yy) - np.sqrt(half * half + xy * xy)
