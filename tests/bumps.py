"""Surfaces with bumps finer than light reaches."""

import numpy as np
from numpy.typing import NDArray

from lutcore import analytic
from lutcore.curvature import PrincipalCurvatures
from lutcore.geometry import area_normals, vertex_corners
from lutcore.mesh import TriangleMesh

FloatArray = NDArray[np.float64]
_WAVES = 60


def bumpy(count: int, seed: int = 0) -> TriangleMesh:
    """Return an ellipsoid of 40 x 28 x 20 with bumps 1.5 to 8 long, .3 steep root mean square."""
    exact = analytic.ellipsoid(count, axes=(20.0, 14.0, 10.0))
    points, generator = exact.mesh.vertices, np.random.default_rng(seed)
    heights = np.zeros(len(points))
    for _ in range(_WAVES):
        along = generator.standard_normal(3)
        along /= np.linalg.norm(along)
        length = np.exp(generator.uniform(np.log(1.5), np.log(8.0)))
        phase = generator.uniform(0.0, 2.0 * np.pi)
        heights += length * np.cos(2.0 * np.pi * (points @ along) / length + phase)
    heights *= 0.05 / np.sqrt(0.5 * _WAVES)
    return TriangleMesh(points + heights[:, None] * exact.truth.normals, exact.mesh.faces)


def bare(mesh: TriangleMesh) -> PrincipalCurvatures:
    """Return no curvature and the normals with all detail, which the gathered reference needs."""
    normals = area_normals(mesh, vertex_corners(mesh))
    zero, axes = np.zeros(len(normals)), np.eye(3)
    first, second = (np.tile(axis, (len(normals), 1)) for axis in axes[:2])
    return PrincipalCurvatures(zero, zero, first, second, normals, zero, 0.0)
