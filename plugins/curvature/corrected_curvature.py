"""Curvature measures of positions and normals that are interpolated apart."""

from dataclasses import dataclass

import numba
import numpy as np
from numba import prange

from lutcore.arrays import BoolArray, FloatArray, IndexArray
from lutcore.balls import BLOCK, gather_ball
from lutcore.compiled import compiled
from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.geometry import area_normals, edge, typical_spacing, vertex_corners
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress, tell
from lutcore.rings import neighbours
from lutcore.tensors import Vector, tangent_frame, write_principal
from plugins.curvature._completed import spread

_DEFAULT_SPACINGS = 3.0


@estimator_registry.register("corrected-curvature")
@dataclass(frozen=True)
class CorrectedCurvature(EstimatorParameters):
    """Measures of area and curvature over a ball, with normals interpolated over each face.

    The scale is the measure's radius r, by default three spacings. Consistent on any
    triangulation whose normals are; here these are the vertex normals by area, so noise comes
    in through them and leaves as r^-1.5 only, where a jet's leaves as r^-3. The bias grows as
    r^2. Sheets that fold back within r cancel. Where the corrected area vanishes nothing is
    estimated. The error is the spread within the ball.

    References
    ----------
    J.-O. Lachaud, P. Romon, B. Thibert, D. Coeurjolly, Interpolated corrected curvature measures
    for polygonal surfaces, Computer Graphics Forum 39 (5), 2020: mu_0 and mu_XY of a triangle.
    """

    def estimate(
        self, mesh: TriangleMesh, scale: float | None, progress: Progress
    ) -> PrincipalCurvatures:
        """Estimate the principal curvatures; see `lutcore.curvature.Estimator`."""
        spacing = typical_spacing(mesh)
        radius = _DEFAULT_SPACINGS * spacing if scale is None else scale
        corners = vertex_corners(mesh)
        links = neighbours(mesh, corners)
        along = area_normals(mesh, corners)
        measures = _measures(mesh.vertices, mesh.faces, along)
        count = len(mesh.vertices)
        normals, known = np.empty((count, 3)), np.empty(count, np.bool_)
        k, directions = np.empty((2, count)), np.empty((2, count, 3))
        chunks = numba.get_num_threads()
        seen = np.zeros((chunks, count), np.int32)
        ball = np.empty((chunks, count), np.int32)
        used = np.zeros((chunks, len(mesh.faces)), np.int32)
        for first in range(0, count, BLOCK):
            tell(progress, first / count, "adding measures")
            _add(
                first,
                min(first + BLOCK, count),
                radius,
                mesh.vertices,
                mesh.faces,
                corners.start,
                corners.corner,
                *links,
                along,
                measures,
                seen,
                ball,
                used,
                k,
                directions,
                normals,
                known,
            )
        error = np.where(known, spread(mesh, corners, k[0], k[1], known, radius / spacing), np.inf)
        return PrincipalCurvatures(
            k[0], k[1], directions[0], directions[1], normals, error, scale=radius
        )


# What is kept of a face: its curvature measure in space (3 x 3, symmetric part: xx, xy, xz, yy,
# yz, zz), its corrected area, and its mean normal times its area.
_AREA, _NORMAL, _MEASURES = 6, 7, 10


@compiled(parallel=True)
def _measures(vertices: FloatArray, faces: IndexArray, normals: FloatArray) -> FloatArray:
    out = np.empty((len(faces), _MEASURES))
    for face in prange(len(faces)):
        i, j, k = faces[face, 0], faces[face, 1], faces[face, 2]
        e1, e2 = edge(vertices, i, j), edge(vertices, i, k)
        a, b = edge(normals, i, j), edge(normals, i, k)
        mean = (
            (normals[i, 0] + normals[j, 0] + normals[k, 0]) / 3.0,
            (normals[i, 1] + normals[j, 1] + normals[k, 1]) / 3.0,
            (normals[i, 2] + normals[j, 2] + normals[k, 2]) / 3.0,
        )
        cross = _cross(e1, e2)
        # mu_0 = <u, (xj - xi) x (xk - xi)>/2 with the mean normal u.
        out[face, _AREA] = 0.5 * (mean[0] * cross[0] + mean[1] * cross[1] + mean[2] * cross[2])
        area = 0.5 * np.sqrt(cross[0] ** 2 + cross[1] ** 2 + cross[2] ** 2)
        # mu_XY = <u, <Y, uk - ui> X x (xj - xi) - <Y, uj - ui> X x (xk - xi)>/2, with
        # <u, X x e> = <X, e x u>. Theirs is negative where ours is convex.
        p, q = _cross(e2, mean), _cross(e1, mean)
        at = 0
        for x in range(3):
            out[face, _NORMAL + x] = area * mean[x]
            for y in range(x, 3):
                out[face, at] = 0.25 * (p[x] * a[y] + p[y] * a[x] - q[x] * b[y] - q[y] * b[x])
                at += 1
    return out


@compiled()
def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@compiled(parallel=True)
def _add(
    first: int,
    last: int,
    radius: float,
    vertices: FloatArray,
    faces: IndexArray,
    start: IndexArray,
    corner: IndexArray,
    link: IndexArray,
    neighbour: IndexArray,
    along: FloatArray,
    measures: FloatArray,
    seen: IndexArray,
    ball: IndexArray,
    used: IndexArray,
    k: FloatArray,
    directions: FloatArray,
    normals: FloatArray,
    known: BoolArray,
) -> None:
    chunks = len(seen)
    for chunk in prange(chunks):
        mine = ball[chunk]
        for i in range(
            first + (last - first) * chunk // chunks, first + (last - first) * (chunk + 1) // chunks
        ):
            count = gather_ball(i, radius, 1, vertices, link, neighbour, seen[chunk], mine)
            total = np.zeros(_MEASURES)
            size = 0.0
            for at in range(count):
                for slot in range(start[mine[at]], start[mine[at] + 1]):
                    face = corner[slot] // 3
                    if used[chunk, face] != i + 1:
                        used[chunk, face] = i + 1
                        share = _inclusion(vertices, faces, face, i, radius)
                        size += share * abs(measures[face, _AREA])
                        for m in range(_MEASURES):
                            total[m] += share * measures[face, m]
            x, y, z = total[_NORMAL], total[_NORMAL + 1], total[_NORMAL + 2]
            length = np.sqrt(x * x + y * y + z * z)
            n = (along[i, 0], along[i, 1], along[i, 2])
            if length > 0.1 * size:  # else the ball holds a closed part, which has no side
                n = (x / length, y / length, z / length)
            normals[i, 0], normals[i, 1], normals[i, 2] = n
            u, v = tangent_frame(n[0], n[1], n[2])
            known[i] = total[_AREA] > 1e-9 * size
            factor = 1.0 / total[_AREA] if known[i] else 0.0
            tensor = (
                factor * _product(total, u, u),
                factor * _product(total, u, v),
                factor * _product(total, v, v),
            )
            write_principal(i, n, tensor, k, directions)


@compiled()
def _inclusion(
    vertices: FloatArray, faces: IndexArray, face: int, centre: int, radius: float
) -> float:
    """Return the share of a face that is in the ball, by its corners' distances."""
    near, far = np.inf, 0.0
    for j in range(3):
        x, y, z = edge(vertices, centre, faces[face, j])
        distance = np.sqrt(x * x + y * y + z * z)
        near, far = min(near, distance), max(far, distance)
    if far <= radius:
        return 1.0
    # A ball inside the star still holds some of each of its faces.
    return max((radius - near) / (far - near), 0.0)


@compiled()
def _product(t: FloatArray, a: Vector, b: Vector) -> float:
    value: float = (
        a[0] * (t[0] * b[0] + t[1] * b[1] + t[2] * b[2])
        + a[1] * (t[1] * b[0] + t[3] * b[1] + t[4] * b[2])
        + a[2] * (t[2] * b[0] + t[4] * b[1] + t[5] * b[2])
    )
    return value
