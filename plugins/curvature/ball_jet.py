"""Polynomial height function fitted to the ball around each vertex."""

from dataclasses import dataclass

import numba
import numpy as np
from numba import prange

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.geometry import area_normals, typical_spacing, vertex_corners
from lutcore.mesh import TriangleMesh
from lutcore.parameters import param
from lutcore.progress import Progress, tell
from lutcore.tensors import Vector, tangent_frame, write_principal
from plugins.curvature._balls import BLOCK, fixed_faces, gather_ball

_DEFAULT_SPACINGS = 4.0
# Smallest pivot of the normal equations, as a share of the diagonal, that is more than rounding.
_SINGULAR = 1e-9
# Unknowns by degree. Degree 1 stands for the sphere-like 1, x, y, x^2 + y^2, which the five or
# six vertices of a speck still determine.
_TERMS = (0, 4, 6, 10)


@estimator_registry.register("ball-jet")
@dataclass(frozen=True)
class BallJet(EstimatorParameters):
    """Least squares of a height function over the vertices within a ball: a jet.

    The scale is the ball's radius r, by default four spacings. The bias of k is of order r^2;
    for degree 2 it is of order r where the ball is lopsided, as at borders, but noise is less.
    Fails where the ball holds no height function: at edges sharper than r, and at sheets closer
    than r. Neighbours whose normals point away are left out, and where too few are left the
    degree falls, to a sphere and in the end to a plane. The error bar is that of the
    coefficients, from the residuals.

    References
    ----------
    F. Cazals, M. Pouget, Estimating differential quantities using polynomial fitting of
    osculating jets, Computer Aided Geometric Design 22 (2), 2005: the fit, its conditioning by
    scaling, the order of the bias, and the curvatures from the coefficients.
    """

    degree: int = param(3, 2, 3, "", "Degree of the polynomial: 2 (quadric) or 3 (cubic).")

    def estimate(
        self, mesh: TriangleMesh, scale: float | None, progress: Progress
    ) -> PrincipalCurvatures:
        """Estimate the principal curvatures; see `lutcore.curvature.Estimator`."""
        radius = _DEFAULT_SPACINGS * typical_spacing(mesh) if scale is None else scale
        corners = vertex_corners(mesh)
        faces = fixed_faces(mesh)
        along = area_normals(mesh, corners)
        count = len(mesh.vertices)
        normals, error = np.empty((count, 3)), np.empty(count)
        k, directions = np.empty((2, count)), np.empty((2, count, 3))
        chunks = numba.get_num_threads()
        seen = np.zeros((chunks, count), np.int32)
        ball = np.empty((chunks, count), np.int32)
        for first in range(0, count, BLOCK):
            tell(progress, first / count, "fitting jets")
            _fit(
                first,
                min(first + BLOCK, count),
                radius,
                self.degree,
                mesh.vertices,
                faces,
                corners.start,
                corners.corner,
                along,
                seen,
                ball,
                k,
                directions,
                normals,
                error,
            )
        return PrincipalCurvatures(
            k[0], k[1], directions[0], directions[1], normals, error, scale=radius
        )


@compiled(parallel=True)
def _fit(
    first: int,
    last: int,
    radius: float,
    degree: int,
    vertices: FloatArray,
    faces: IndexArray,
    start: IndexArray,
    corner: IndexArray,
    along: FloatArray,
    seen: IndexArray,
    ball: IndexArray,
    k: FloatArray,
    directions: FloatArray,
    normals: FloatArray,
    error: FloatArray,
) -> None:
    chunks = len(seen)
    for chunk in prange(chunks):
        mine = ball[chunk]
        for i in range(
            first + (last - first) * chunk // chunks, first + (last - first) * (chunk + 1) // chunks
        ):
            count = gather_ball(
                i, radius, 2 * _TERMS[degree], vertices, faces, start, corner, seen[chunk], mine
            )
            n = (along[i, 0], along[i, 1], along[i, 2])
            u, v = tangent_frame(n[0], n[1], n[2])
            local = np.empty((count, 3))
            kept, size = 0, 0.0
            for at in range(count):
                j = mine[at]
                if along[j, 0] * n[0] + along[j, 1] * n[1] + along[j, 2] * n[2] <= 0.0:
                    continue
                x = y = z = 0.0
                for axis in range(3):
                    d = vertices[j, axis] - vertices[i, axis]
                    x, y, z = x + d * u[axis], y + d * v[axis], z + d * n[axis]
                local[kept, 0], local[kept, 1], local[kept, 2] = x, y, z
                size = max(size, x * x + y * y)
                kept += 1
            size = np.sqrt(size) if size > 0.0 else radius
            local = local[:kept] / size
            wanted = degree
            solved = False
            while not solved:
                solved, jet, noise = _solve(local, wanted)
                wanted -= 1
            error[i] = noise / size
            _write(i, n, u, v, jet, size, k, directions, normals)


@compiled()
def _solve(local: FloatArray, degree: int) -> tuple[bool, FloatArray, float]:
    """Return whether the fit succeeded, fx, fy, fxx, fxy, fyy at the origin, and their noise."""
    terms = _TERMS[degree]
    jet = np.zeros(5)
    if degree == 0:  # flat, as far as its size can tell
        return True, jet, 1.0
    if len(local) < terms:
        return False, jet, 0.0
    normal = np.zeros((terms, terms))
    right = np.zeros(terms)
    row = np.empty(10)
    for at in range(len(local)):
        _monomials(local[at, 0], local[at, 1], degree, row)
        for a in range(terms):
            right[a] += row[a] * local[at, 2]
            for b in range(a + 1):
                normal[a, b] += row[a] * row[b]
    if not _factor(normal):
        return False, jet, 0.0
    found = right.copy()
    _substitute(normal, found)
    jet[0], jet[1] = found[1], found[2]
    if degree == 1:
        jet[2] = jet[4] = 2.0 * found[3]
    else:
        jet[2], jet[3], jet[4] = 2.0 * found[3], found[4], 2.0 * found[5]
    square = 0.0
    for at in range(len(local)):
        _monomials(local[at, 0], local[at, 1], degree, row)
        off = local[at, 2]
        for a in range(terms):
            off -= row[a] * found[a]
        square += off * off
    spare = len(local) - terms
    if spare == 0:  # no residual to judge by: no better than the value itself
        return True, jet, np.sqrt(0.5 * (jet[2] ** 2 + jet[4] ** 2) + jet[3] ** 2)
    # Half the squared norm of the tensor's noise, as for every error bar; f_xx = 2 c_xx.
    total = 0.0
    for term, weight in ((3, 2.0 if degree > 1 else 4.0), (4, 1.0), (5, 2.0)):
        if term >= terms:
            break
        unit = np.zeros(terms)
        unit[term] = 1.0
        _substitute(normal, unit)
        total += weight * unit[term]
    return True, jet, np.sqrt(total * square / spare)


@compiled()
def _monomials(x: float, y: float, degree: int, row: FloatArray) -> None:
    row[0], row[1], row[2] = 1.0, x, y
    row[3], row[4], row[5] = x * x, x * y, y * y
    if degree == 1:
        row[3] += row[5]
    row[6], row[7], row[8], row[9] = x * x * x, x * x * y, x * y * y, y * y * y


@compiled()
def _factor(matrix: FloatArray) -> bool:
    """Replace the lower half of a matrix by its Cholesky factor; False if it is singular."""
    for a in range(len(matrix)):
        least = _SINGULAR * matrix[a, a]
        for b in range(a + 1):
            value = matrix[a, b]
            for c in range(b):
                value -= matrix[a, c] * matrix[b, c]
            if a == b:
                if value <= least:
                    return False
                matrix[a, a] = np.sqrt(value)
            else:
                matrix[a, b] = value / matrix[b, b]
    return True


@compiled()
def _substitute(factor: FloatArray, right: FloatArray) -> None:
    """Replace a right-hand side by the solution, forwards and backwards."""
    size = len(factor)
    for a in range(size):
        for b in range(a):
            right[a] -= factor[a, b] * right[b]
        right[a] /= factor[a, a]
    for a in range(size - 1, -1, -1):
        for b in range(a + 1, size):
            right[a] -= factor[b, a] * right[b]
        right[a] /= factor[a, a]


@compiled()
def _write(
    i: int,
    n: Vector,
    u: Vector,
    v: Vector,
    jet: FloatArray,
    size: float,
    k: FloatArray,
    directions: FloatArray,
    normals: FloatArray,
) -> None:
    """Store what follows from the jet: the first and second fundamental forms at the foot."""
    steepness = np.sqrt(1.0 + jet[0] ** 2 + jet[1] ** 2)
    for axis in range(3):
        normals[i, axis] = (n[axis] - jet[0] * u[axis] - jet[1] * v[axis]) / steepness
    m = (normals[i, 0], normals[i, 1], normals[i, 2])
    p, q = tangent_frame(m[0], m[1], m[2])
    # A tangent vector is a (1, 0, fx) + b (0, 1, fy): a and b are its parts along u and v.
    pa = p[0] * u[0] + p[1] * u[1] + p[2] * u[2]
    pb = p[0] * v[0] + p[1] * v[1] + p[2] * v[2]
    qa = q[0] * u[0] + q[1] * u[1] + q[2] * u[2]
    qb = q[0] * v[0] + q[1] * v[1] + q[2] * v[2]
    factor = -1.0 / (steepness * size)  # heights fall where the surface is convex
    tensor = (
        factor * (jet[2] * pa * pa + 2.0 * jet[3] * pa * pb + jet[4] * pb * pb),
        factor * (jet[2] * pa * qa + jet[3] * (pa * qb + pb * qa) + jet[4] * pb * qb),
        factor * (jet[2] * qa * qa + 2.0 * jet[3] * qa * qb + jet[4] * qb * qb),
    )
    write_principal(i, m, tensor, k, directions)
