"""Surfaces whose curvature is known exactly, as inputs of `shade`."""

import numpy as np
from numpy.typing import NDArray

from lutcore.curvature import PrincipalCurvatures
from lutcore.mesh import TriangleMesh

FloatArray = NDArray[np.float64]


def torus(
    count: int, major: float = 20.0, minor: float = 8.0
) -> tuple[TriangleMesh, PrincipalCurvatures]:
    """Return about `count` vertices of a torus: a sphere-like outside, saddles inside."""
    columns = max(int(np.sqrt(count)), 3)
    rows = max(count // columns, 3)
    around, across = (
        grid.ravel()
        for grid in np.meshgrid(
            np.linspace(0.0, 2.0 * np.pi, columns, endpoint=False),
            np.linspace(0.0, 2.0 * np.pi, rows, endpoint=False),
        )
    )
    outward = np.stack([np.cos(around), np.sin(around), np.zeros_like(around)], axis=1)
    up = np.array([0.0, 0.0, 1.0])
    normals = np.cos(across)[:, None] * outward + np.sin(across)[:, None] * up
    along = np.stack([-np.sin(around), np.cos(around), np.zeros_like(around)], axis=1)
    meridian = np.cross(normals, along)
    k1 = np.full(len(around), 1.0 / minor)
    k2 = np.cos(across) / (major + minor * np.cos(across))
    zeros = np.zeros(len(around))
    here = np.arange(rows * columns).reshape(rows, columns)
    right, above = np.roll(here, -1, axis=1), np.roll(here, -1, axis=0)
    beyond = np.roll(above, -1, axis=1)
    faces = np.stack([[here, right, beyond], [here, beyond, above]], axis=-1).reshape(3, -1).T
    mesh = TriangleMesh(major * outward + minor * normals, faces)
    return mesh, PrincipalCurvatures(k1, k2, meridian, along, normals, zeros, 0.0)


def sphere(cosines: FloatArray, radius: float) -> tuple[TriangleMesh, PrincipalCurvatures]:
    """Return points of a sphere at the given cosines from the z axis; radius 0 < r <= inf."""
    sines = np.sqrt(1.0 - cosines**2)
    normals = np.stack([sines, np.zeros_like(sines), cosines], axis=1)
    d1 = np.stack([cosines, np.zeros_like(sines), -sines], axis=1)
    d2 = np.broadcast_to([0.0, 1.0, 0.0], normals.shape)
    k = np.full(len(cosines), 1.0 / radius)
    points = normals if np.isinf(radius) else radius * normals
    # One face makes it a mesh: local models look at vertices alone.
    mesh = TriangleMesh(points, [[0, 1, 2]])
    return mesh, PrincipalCurvatures(k, k, d1, d2, normals, np.zeros(len(k)), 0.0)


def bent(k1: FloatArray, k2: FloatArray) -> tuple[TriangleMesh, PrincipalCurvatures]:
    """Return points that differ in nothing but their curvatures, along x and y."""
    ones = np.ones(len(k1))[:, None]
    first, second = ones * [1.0, 0.0, 0.0], ones * [0.0, 1.0, 0.0]
    normals, zeros = ones * [0.0, 0.0, 1.0], np.zeros(len(k1))
    mesh = TriangleMesh(normals, [[0, 1, 2]])
    return mesh, PrincipalCurvatures(k1, k2, first, second, normals, zeros, 0.0)
