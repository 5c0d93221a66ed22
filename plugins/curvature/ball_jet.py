"""Polynomial height function fitted to the ball around each vertex."""

from dataclasses import dataclass

import numba
import numpy as np
from numba import prange

from lutcore.arrays import FloatArray, IndexArray
from lutcore.balls import BLOCK, gather_ball
from lutcore.compiled import compiled
from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.geometry import area_normals, typical_spacing, vertex_corners
from lutcore.jets import TERMS, fit_jet, operator_of
from lutcore.mesh import TriangleMesh
from lutcore.parameters import param
from lutcore.progress import Progress, tell
from lutcore.rings import neighbours
from lutcore.tensors import tangent_frame, write_principal

_DEFAULT_SPACINGS = 4.0


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
        links = neighbours(mesh, corners)
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
                *links,
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
    start: IndexArray,
    neighbour: IndexArray,
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
                i, radius, 2 * TERMS[degree], vertices, start, neighbour, seen[chunk], mine
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
                solved, jet, noise = fit_jet(local, wanted)
                wanted -= 1
            error[i] = noise / size
            m, tensor = operator_of(jet, n, u, v, size)
            normals[i, 0], normals[i, 1], normals[i, 2] = m
            write_principal(i, m, tensor, k, directions)
