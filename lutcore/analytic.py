"""Surfaces whose curvature is known exactly: the truth that estimators are judged by.

Each is the zero set of a function F that is positive outside. Its unit normal is grad F/|grad F|
and its shape operator the Hessian of F over |grad F|, restricted to the tangent plane: positive
where convex.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lutcore.arrays import FloatArray, IndexArray
from lutcore.curvature import PrincipalCurvatures
from lutcore.mesh import TriangleMesh
from lutcore.tiling import delaunay_cells, grid_cells

Derivatives = Callable[[FloatArray], tuple[FloatArray, FloatArray]]


@dataclass(frozen=True)
class Exact:
    """A mesh with its vertices on a known surface, and the truth there.

    Parameters
    ----------
    mesh : TriangleMesh
        The mesh.
    truth : PrincipalCurvatures
        Exact values at its vertices; the error and the scale are 0.
    """

    mesh: TriangleMesh
    truth: PrincipalCurvatures

    def noisy(self, share: float, seed: int = 0) -> TriangleMesh:
        """Return the mesh with white noise along the exact normals.

        Parameters
        ----------
        share : float
            Standard deviation as a share of the mean edge.
        seed : int
            Seed of the noise.

        Returns
        -------
        TriangleMesh
            The noisy mesh.
        """
        points, faces = self.mesh.vertices, self.mesh.faces
        edges = points[faces] - points[np.roll(faces, 1, axis=1)]
        sigma = share * float(np.sqrt(np.square(edges).sum(axis=2)).mean())
        offsets = sigma * np.random.default_rng(seed).standard_normal(len(points))
        return TriangleMesh(points + offsets[:, None] * self.truth.normals, faces)


def sphere(count: int, irregular: bool = False, radius: float = 1.0, seed: int = 0) -> Exact:
    """Return a sphere.

    Parameters
    ----------
    count : int
        Vertices, nearly.
    irregular : bool
        Whether vertices are random points rather than a spiral of even density.
    radius : float
        Radius.
    seed : int
        Seed of the random points.

    Returns
    -------
    Exact
        Closed mesh; every k is 1/radius.
    """
    return ellipsoid(count, irregular, (radius, radius, radius), seed)


def ellipsoid(
    count: int,
    irregular: bool = False,
    axes: tuple[float, float, float] = (1.0, 0.7, 0.5),
    seed: int = 0,
) -> Exact:
    """Return an ellipsoid.

    Parameters
    ----------
    count : int
        Vertices, nearly.
    irregular : bool
        Whether vertices are random points rather than a spiral of even density.
    axes : tuple of float
        Half axes.
    seed : int
        Seed of the random points.

    Returns
    -------
    Exact
        Closed mesh.
    """
    from scipy.spatial import ConvexHull

    if irregular:
        unit = np.random.default_rng(seed).standard_normal((count, 3))
        unit /= np.sqrt(np.square(unit).sum(axis=1, keepdims=True))
    else:
        step = np.arange(count) + 0.5
        height = 1.0 - 2.0 * step / count
        turn = np.pi * (1.0 + np.sqrt(5.0)) * step
        ring = np.sqrt(1.0 - height**2)
        unit = np.stack([ring * np.cos(turn), ring * np.sin(turn), height], axis=1)
    faces = ConvexHull(unit).simplices
    # The Delaunay triangulation of points on a sphere is their convex hull; turn it outwards.
    a, b, c = (unit[faces[:, j]] for j in range(3))
    inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0.0
    faces[inwards] = faces[inwards, ::-1]
    weight = 1.0 / np.square(axes)

    def derivatives(p: FloatArray) -> tuple[FloatArray, FloatArray]:
        return 2.0 * p * weight, np.broadcast_to(2.0 * np.diag(weight), (len(p), 3, 3))

    return _exact(unit * np.asarray(axes), faces, derivatives)


def cylinder(
    count: int, irregular: bool = False, radius: float = 1.0, length: float = 3.0, seed: int = 0
) -> Exact:
    """Return an open cylinder around the z axis.

    Parameters
    ----------
    count : int
        Vertices, nearly.
    irregular : bool
        Whether vertices are random rather than a grid.
    radius, length : float
        Radius and length.
    seed : int
        Seed of the random points.

    Returns
    -------
    Exact
        Mesh with two circular rims; k1 = 1/radius, k2 = 0.
    """
    uv, faces = _cells(count, (2.0 * np.pi * radius, length), (True, False), irregular, seed)
    angle = uv[:, 0] / radius
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), uv[:, 1]], axis=1)

    def derivatives(p: FloatArray) -> tuple[FloatArray, FloatArray]:
        flat = np.array([1.0, 1.0, 0.0])
        return 2.0 * p * flat, np.broadcast_to(2.0 * np.diag(flat), (len(p), 3, 3))

    return _exact(points, faces, derivatives)


def torus(
    count: int, irregular: bool = False, major: float = 1.0, minor: float = 0.35, seed: int = 0
) -> Exact:
    """Return a torus around the z axis.

    Parameters
    ----------
    count : int
        Vertices, nearly.
    irregular : bool
        Whether vertices are random points of even density rather than a grid.
    major, minor : float
        Radius of the circle in its middle, and of the tube.
    seed : int
        Seed of the random points.

    Returns
    -------
    Exact
        Closed mesh; k1 = 1/minor and k2 = cos v/(major + minor cos v).
    """
    # Conformal coordinates of the torus make triangles that are Delaunay there Delaunay on it:
    # the second runs as the integral of minor/(major + minor cos v).
    angle = np.linspace(0.0, 2.0 * np.pi, 20001)
    speed = minor / (major + minor * np.cos(angle))
    conformal = np.concatenate(([0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(angle))))
    size = (2.0 * np.pi, float(conformal[-1]))
    if irregular:
        generator = np.random.default_rng(seed)
        share = major * angle + minor * np.sin(angle)
        v = np.interp(generator.random(count) * share[-1], share, angle)
        u = 2.0 * np.pi * generator.random(count)
        faces = delaunay_cells(
            np.stack([u, np.interp(v, angle, conformal)], axis=1), size, (True, True)
        )
    else:
        uv, faces = grid_cells(count, (2.0 * np.pi * major, 2.0 * np.pi * minor), (True, True))
        u, v = uv[:, 0] / major, uv[:, 1] / minor
    ring = major + minor * np.cos(v)
    points = np.stack([ring * np.cos(u), ring * np.sin(u), minor * np.sin(v)], axis=1)

    def derivatives(p: FloatArray) -> tuple[FloatArray, FloatArray]:
        around = np.hypot(p[:, 0], p[:, 1])
        x, y = p[:, 0] / around, p[:, 1] / around
        off = around - major  # F = off^2 + z^2 - minor^2
        gradient = 2.0 * np.stack([off * x, off * y, p[:, 2]], axis=1)
        hessian = np.zeros((len(p), 3, 3))
        bend = off / around
        hessian[:, 0, 0] = 2.0 * (x * x + bend * y * y)
        hessian[:, 1, 1] = 2.0 * (y * y + bend * x * x)
        hessian[:, 0, 1] = hessian[:, 1, 0] = 2.0 * (1.0 - bend) * x * y
        hessian[:, 2, 2] = 2.0
        return gradient, hessian

    return _exact(points, faces, derivatives)


def saddle(
    count: int, irregular: bool = False, k: tuple[float, float] = (1.0, -1.0), seed: int = 0
) -> Exact:
    """Return the graph z = -(k[0] x^2 + k[1] y^2)/2 over a square of side 2, outside above.

    Parameters
    ----------
    count : int
        Vertices, nearly.
    irregular : bool
        Whether vertices are random rather than a grid.
    k : tuple of float
        Curvatures along x and y at the middle; of unlike sign for a saddle.
    seed : int
        Seed of the random points.

    Returns
    -------
    Exact
        Mesh with a square rim.
    """

    def height(x: FloatArray, y: FloatArray) -> tuple[FloatArray, ...]:
        flat = np.zeros_like(x)
        z = -0.5 * (k[0] * x * x + k[1] * y * y)
        return z, -k[0] * x, -k[1] * y, flat - k[0], flat, flat - k[1]

    return _graph(count, irregular, seed, height)


def monkey_saddle(count: int, irregular: bool = False, bend: float = 0.5, seed: int = 0) -> Exact:
    """Return the graph z = bend (x^3 - 3 x y^2) over a square of side 2, outside above.

    Parameters
    ----------
    count : int
        Vertices, nearly.
    irregular : bool
        Whether vertices are random rather than a grid.
    bend : float
        Size of the third derivatives.
    seed : int
        Seed of the random points.

    Returns
    -------
    Exact
        Mesh with a square rim; flat in the middle, where the directions turn three times.
    """

    def height(x: FloatArray, y: FloatArray) -> tuple[FloatArray, ...]:
        z = bend * (x**3 - 3.0 * x * y * y)
        first = 3.0 * bend * (x * x - y * y), -6.0 * bend * x * y
        return z, *first, 6.0 * bend * x, -6.0 * bend * y, -6.0 * bend * x

    return _graph(count, irregular, seed, height)


def _graph(
    count: int,
    irregular: bool,
    seed: int,
    height: Callable[[FloatArray, FloatArray], tuple[FloatArray, ...]],
) -> Exact:
    uv, faces = _cells(count, (2.0, 2.0), (False, False), irregular, seed)
    x, y = uv[:, 0] - 1.0, uv[:, 1] - 1.0

    def derivatives(p: FloatArray) -> tuple[FloatArray, FloatArray]:
        _, zx, zy, zxx, zxy, zyy = height(p[:, 0], p[:, 1])
        hessian = np.zeros((len(p), 3, 3))  # F = z - height
        hessian[:, 0, 0], hessian[:, 1, 1] = -zxx, -zyy
        hessian[:, 0, 1] = hessian[:, 1, 0] = -zxy
        return np.stack([-zx, -zy, np.ones(len(p))], axis=1), hessian

    return _exact(np.stack([x, y, height(x, y)[0]], axis=1), faces, derivatives)


def _cells(
    count: int, size: tuple[float, float], closed: tuple[bool, bool], irregular: bool, seed: int
) -> tuple[FloatArray, IndexArray]:
    """Return points of a rectangle and their triangles: a grid, or the grid moved at random."""
    uv, faces = grid_cells(count, size, closed)
    if not irregular:
        return uv, faces
    generator = np.random.default_rng(seed)
    move = 0.45 * np.sqrt(size[0] * size[1] / count) * generator.uniform(-1.0, 1.0, uv.shape)
    for axis in range(2):
        if closed[axis]:
            uv[:, axis] = (uv[:, axis] + move[:, axis]) % size[axis]
        else:  # points of the rim stay on it
            rim = (uv[:, axis] <= 0.0) | (uv[:, axis] >= size[axis] * (1.0 - 1e-12))
            uv[~rim, axis] += move[~rim, axis]
    return uv, delaunay_cells(uv, size, closed)


def _exact(points: FloatArray, faces: IndexArray, derivatives: Derivatives) -> Exact:
    gradient, hessian = derivatives(points)
    steepness = np.sqrt(np.square(gradient).sum(axis=1, keepdims=True))
    normals = gradient / steepness
    # A frame around each normal, then the 2 x 2 problem in it.
    least = np.eye(3)[np.argmin(np.abs(normals), axis=1)]
    u = np.cross(least, normals)
    u /= np.sqrt(np.square(u).sum(axis=1, keepdims=True))
    frame = np.stack([u, np.cross(normals, u)], axis=2)
    operator = np.einsum("nia,nij,njb->nab", frame, hessian, frame, optimize=True)
    values, vectors = np.linalg.eigh(operator / steepness[:, :, None])
    d1 = np.einsum("nia,na->ni", frame, vectors[:, :, 1])
    zero = np.zeros(len(points))
    truth = PrincipalCurvatures(
        values[:, 1], values[:, 0], d1, np.cross(normals, d1), normals, zero, 0.0
    )
    return Exact(TriangleMesh(points, faces), truth)
