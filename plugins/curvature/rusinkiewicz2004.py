"""Curvature of each face from its corners' normals, averaged over the faces of a vertex."""

from dataclasses import dataclass

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.geometry import edge, vertex_corners, vertex_normals
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress, tell
from lutcore.tensors import Vector, symmetric_fit, tangent_frame, write_principal


@estimator_registry.register("rusinkiewicz2004")
@dataclass(frozen=True)
class Rusinkiewicz2004(EstimatorParameters):
    """One-ring estimator: the fastest, exact on clean, regular meshes, useless on noisy ones.

    Irregular triangles alone bring some per cent. The scale is ignored: the method knows only the
    ring. The error is the spread of the tensors of the faces around a vertex.

    References
    ----------
    S. Rusinkiewicz, Estimating curvatures and their derivatives on triangle meshes, 3DPVT 2004.
    Vertex normals by N. Max (`lutcore.geometry.vertex_normals`), areas by M. Meyer et al.,
    Discrete differential-geometry operators for triangulated 2-manifolds, Visualization and
    Mathematics III, 2003, figure 4. The least squares of each face are solved in closed form
    (`lutcore.tensors.symmetric_fit`).
    """

    def estimate(
        self, mesh: TriangleMesh, scale: float | None, progress: Progress
    ) -> PrincipalCurvatures:
        """Estimate the principal curvatures; see `lutcore.curvature.Estimator`."""
        corners = vertex_corners(mesh)
        normals = vertex_normals(mesh, corners)
        tell(progress, 0.5, "one-ring tensors")
        records = _face_records(mesh.vertices, mesh.faces, normals)
        k, directions, error = _vertex_tensors(corners.start, corners.corner, normals, records)
        return PrincipalCurvatures(
            k[0], k[1], directions[0], directions[1], normals, error, scale=0.0
        )


# What is kept of a face: its tensor in space (xx, xy, xz, yy, yz, zz), its unit normal, and the
# areas of its three corners. Single precision halves the memory that the second pass reads.
_NORMAL, _AREA, _RECORD = 6, 9, 12


@compiled(parallel=True)
def _face_records(
    vertices: FloatArray, faces: IndexArray, normals: FloatArray
) -> NDArray[np.float32]:
    """Return tensor (least squares over its three edges), normal and areas of each face."""
    records = np.empty((len(faces), _RECORD), np.float32)
    for face in prange(len(faces)):
        a, b, c = faces[face, 0], faces[face, 1], faces[face, 2]
        e0, e1, e2 = edge(vertices, a, b), edge(vertices, b, c), edge(vertices, c, a)
        d0, d1, d2 = edge(normals, a, b), edge(normals, b, c), edge(normals, c, a)
        n = _cross(e0, e1)
        doubled = np.sqrt(_dot(n, n))
        n = (n[0] / doubled, n[1] / doubled, n[2] / doubled)
        length = np.sqrt(_dot(e0, e0))
        u = (e0[0] / length, e0[1] / length, e0[2] / length)
        v = _cross(n, u)
        cxx = cxy = cyy = bxx = bxy = byy = 0.0
        for e, d in ((e0, d0), (e1, d1), (e2, d2)):
            eu, ev, du, dv = _dot(e, u), _dot(e, v), _dot(d, u), _dot(d, v)
            cxx, cxy, cyy = cxx + eu * eu, cxy + eu * ev, cyy + ev * ev
            bxx, bxy, byy = bxx + du * eu, bxy + 0.5 * (du * ev + dv * eu), byy + dv * ev
        sxx, sxy, syy = symmetric_fit(cxx, cxy, cyy, bxx, bxy, byy)
        at = 0
        for i in range(3):
            records[face, _NORMAL + i] = n[i]
            for j in range(i, 3):
                records[face, at] = (
                    sxx * u[i] * u[j] + sxy * (u[i] * v[j] + v[i] * u[j]) + syy * v[i] * v[j]
                )
                at += 1
        l0, l1, l2 = _dot(e0, e0), _dot(e1, e1), _dot(e2, e2)
        records[face, _AREA] = _corner_area(l0, l2, l1, doubled)
        records[face, _AREA + 1] = _corner_area(l1, l0, l2, doubled)
        records[face, _AREA + 2] = _corner_area(l2, l1, l0, doubled)
    return records


@compiled()
def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled()
def _cross(a: Vector, b: Vector) -> Vector:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


@compiled()
def _corner_area(one: float, other: float, opposite: float, doubled: float) -> float:
    """Return the area of a corner from the squared sides (Meyer et al. 2003, figure 4)."""
    if opposite >= one + other:
        return 0.25 * doubled
    if one >= opposite + other or other >= opposite + one:
        return 0.125 * doubled
    # cot = (sum of the two sides that meet there - the third)/(2 doubled), times the side's square
    return ((opposite + other - one) * one + (opposite + one - other) * other) / (16.0 * doubled)


@compiled(parallel=True)
def _vertex_tensors(
    start: IndexArray, corner: IndexArray, normals: FloatArray, records: NDArray[np.float32]
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return k, directions and errors at the vertices (faces' tensors, turned and averaged)."""
    count = len(normals)
    k = np.empty((2, count))
    directions = np.empty((2, count, 3))
    error = np.empty(count)
    for vertex in prange(count):
        n = (normals[vertex, 0], normals[vertex, 1], normals[vertex, 2])
        p, q = tangent_frame(n[0], n[1], n[2])
        sxx = sxy = syy = squares = total = 0.0
        for at in range(start[vertex], start[vertex + 1]):
            face = corner[at] // 3
            txx, txy, txz = records[face, 0], records[face, 1], records[face, 2]
            tyy, tyz, tzz = records[face, 3], records[face, 4], records[face, 5]
            m = (
                np.float64(records[face, _NORMAL]),
                np.float64(records[face, _NORMAL + 1]),
                np.float64(records[face, _NORMAL + 2]),
            )
            # The vertex's frame turned with its plane into the face's plane.
            turn = 1.0 / max(1.0 + _dot(m, n), 1e-6)
            w = (turn * (m[0] + n[0]), turn * (m[1] + n[1]), turn * (m[2] + n[2]))
            pm, qm = _dot(p, m), _dot(q, m)
            a0, a1, a2 = p[0] - pm * w[0], p[1] - pm * w[1], p[2] - pm * w[2]
            b0, b1, b2 = q[0] - qm * w[0], q[1] - qm * w[1], q[2] - qm * w[2]
            t0 = txx * a0 + txy * a1 + txz * a2
            t1 = txy * a0 + tyy * a1 + tyz * a2
            t2 = txz * a0 + tyz * a1 + tzz * a2
            fxx = a0 * t0 + a1 * t1 + a2 * t2
            fxy = b0 * t0 + b1 * t1 + b2 * t2
            fyy = (
                b0 * (txx * b0 + 2.0 * (txy * b1 + txz * b2))
                + b1 * (tyy * b1 + 2.0 * tyz * b2)
                + b2 * tzz * b2
            )
            weight = np.float64(records[face, _AREA + corner[at] - 3 * face])
            sxx, sxy, syy = sxx + weight * fxx, sxy + weight * fxy, syy + weight * fyy
            squares += weight * (fxx * fxx + 2.0 * fxy * fxy + fyy * fyy)
            total += weight
        sxx, sxy, syy = sxx / total, sxy / total, syy / total
        write_principal(vertex, n, (sxx, sxy, syy), k, directions)
        spread = squares / total - (sxx * sxx + 2.0 * sxy * sxy + syy * syy)
        # One face has no spread to judge by: nothing finer than its own size is known.
        alone = start[vertex + 1] - start[vertex] == 1
        error[vertex] = 1.0 / np.sqrt(total) if alone else np.sqrt(max(spread, 0.0))
    return k, directions, error
