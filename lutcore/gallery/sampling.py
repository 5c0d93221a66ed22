"""The surface as it was, badly sampled: uneven triangles, noise, too few points, bad units."""

from functools import cache

import numpy as np

from lutcore import analytic
from lutcore.arrays import FloatArray
from lutcore.gallery.case import Pair, Subject, subject
from lutcore.gallery.surfaces import VERTICES, egg, ring
from lutcore.mesh import TriangleMesh
from lutcore.tiling import delaunay_cells, grid_cells

_MAJOR, _MINOR = 1.0, 0.35  # of the torus
_JITTER = 0.3  # of the spacing
_CORRELATED = 0.1  # of the mean edge
_LENGTH = 2.0  # over which errors go together, mean edges
# The noise of a scanner, which does not depend on how densely it samples: 2 % of the mean edge
# of 1 000 vertices.
_SCANNER, _SCANNED = 0.02, 1000


def irregular(seed: int) -> Pair:
    """Place the vertices at random.

    Parameters
    ----------
    seed : int
        Where.

    Returns
    -------
    Pair
        Random triangles and the grid.
    """
    return subject(analytic.torus(VERTICES, True, seed=seed)), subject(ring())


def slivers(aspect: float, seed: int) -> Pair:
    """Draw triangles out along the tube.

    Parameters
    ----------
    aspect : float
        How many times longer than wide.
    seed : int
        How vertices are off the grid.

    Returns
    -------
    Pair
        Long triangles, and well-shaped ones off the grid by as much.
    """
    return _drawn_out(aspect, seed), _drawn_out(1.0, seed)


def white_noise(share: float, seed: int) -> Pair:
    """Move vertices along the normal, each for itself.

    Parameters
    ----------
    share : float
        One sigma as a share of the mean edge.
    seed : int
        How.

    Returns
    -------
    Pair
        Noisy and clean.
    """
    noisy = subject(ring(), mesh=ring().noisy(share, seed)) if share else subject(ring())
    return noisy, subject(ring())


def correlated_noise(seed: int) -> Pair:
    """Move vertices along the normal, neighbours together.

    Parameters
    ----------
    seed : int
        How.

    Returns
    -------
    Pair
        Correlated noise, and white noise of the same size.
    """
    from scipy.spatial import cKDTree

    exact = ring()
    points = exact.mesh.vertices
    edge = _mean_edge(exact.mesh)
    tree = cKDTree(points)
    far = tree.sparse_distance_matrix(tree, 3.0 * _LENGTH * edge, output_type="coo_matrix").tocsr()
    far.data = np.exp(-0.5 * np.square(far.data / (_LENGTH * edge)))
    wave = far @ np.random.default_rng(seed).standard_normal(len(points))
    wave *= _CORRELATED * edge / wave.std()
    mesh = TriangleMesh(points + wave[:, None] * exact.truth.normals, exact.mesh.faces)
    white = exact.noisy(_CORRELATED, seed)
    return subject(exact, mesh=mesh), subject(exact, mesh=white)


def resolution(count: int, seed: int) -> Pair:
    """Sample one shape with one scanner, more or less densely.

    Parameters
    ----------
    count : int
        Vertices.
    seed : int
        Of the noise, of one size in mesh units.

    Returns
    -------
    Pair
        The noisy mesh, and a clean one of 4 000 vertices.
    """
    exact = egg(count)
    sigma = _SCANNER * _mean_edge(egg(_SCANNED).mesh)
    mesh = exact.noisy(sigma / _mean_edge(exact.mesh), seed)
    return subject(exact, mesh=mesh), subject(egg(VERTICES))


def scaled(factor: float, seed: int) -> Pair:
    """Write the mesh in another unit.

    Parameters
    ----------
    factor : float
        Length of one before, in the new unit.
    seed : int
        Not needed: nothing is random.

    Returns
    -------
    Pair
        Scaled and not.
    """
    exact = ring()
    mesh = TriangleMesh(factor * exact.mesh.vertices, exact.mesh.faces)
    everywhere = np.ones(len(mesh.vertices), dtype=bool)
    small = Subject(mesh, exact.truth.k1 / factor, exact.truth.k2 / factor, everywhere)
    return small, subject(exact)


def far(diagonals: float, seed: int) -> Pair:
    """Move the mesh far from the origin and store it in single precision.

    Parameters
    ----------
    diagonals : float
        How far, in diagonals of the box around it.
    seed : int
        Not needed: nothing is random.

    Returns
    -------
    Pair
        Rounded and exact.
    """
    exact = ring()
    away = diagonals * exact.mesh.diagonal * np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0)
    points = (exact.mesh.vertices + away).astype(np.float32)
    return subject(exact, mesh=TriangleMesh(points, exact.mesh.faces)), subject(exact)


@cache
def _drawn_out(aspect: float, seed: int) -> Subject:
    """Return a torus whose triangles are longer along the tube than around it."""
    size = (2.0 * np.pi * _MAJOR / aspect, 2.0 * np.pi * _MINOR)
    closed = (True, True)
    uv, _ = grid_cells(VERTICES, size, closed)
    generator = np.random.default_rng(seed)
    spacing = np.sqrt(size[0] * size[1] / len(uv))
    uv = (uv + _JITTER * spacing * generator.uniform(-1.0, 1.0, uv.shape)) % size
    faces = delaunay_cells(uv, size, closed)
    u, v = uv[:, 0] * aspect / _MAJOR, uv[:, 1] / _MINOR
    around = _MAJOR + _MINOR * np.cos(v)
    points = np.stack([around * np.cos(u), around * np.sin(u), _MINOR * np.sin(v)], axis=1)
    everywhere = np.ones(len(points), dtype=bool)
    k1 = np.full(len(points), 1.0 / _MINOR)
    return Subject(TriangleMesh(points, faces), k1, np.cos(v) / around, everywhere)


def _mean_edge(mesh: TriangleMesh) -> float:
    corners: FloatArray = mesh.vertices[mesh.faces]
    return float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean())
