"""The surface as it was, badly written down: order, orientation, repetition, unmerged corners."""

import numpy as np

from lutcore.analytic import Exact
from lutcore.arrays import AnyArray
from lutcore.gallery.case import Pair, Subject, subject
from lutcore.gallery.surfaces import ring
from lutcore.geometry import typical_spacing
from lutcore.mesh import TriangleMesh

_SHARE = 0.05
# Corners of one vertex that were rounded apart, in spacings: a transform in single precision.
_CRACK = 1e-6
_SEAM = 6.0  # spacings


def flipped_all(seed: int) -> Pair:
    """Turn every face over: convex becomes concave.

    Parameters
    ----------
    seed : int
        Not needed: nothing is random.

    Returns
    -------
    Pair
        The truth is turned too: the faces' order says where outside is.
    """
    exact = ring()
    mesh = TriangleMesh(exact.mesh.vertices, exact.mesh.faces[:, ::-1])
    everywhere = np.ones(len(mesh.vertices), dtype=bool)
    turned = Subject(mesh, -exact.truth.k2, -exact.truth.k1, everywhere)
    return turned, subject(exact)


def flipped_half(seed: int) -> Pair:
    """Turn the faces of one half over.

    Parameters
    ----------
    seed : int
        Not needed: nothing is random.

    Returns
    -------
    Pair
        The truth is turned in that half; judged away from the seam between the halves.
    """
    exact, truth = ring(), ring().truth
    points, faces = exact.mesh.vertices, exact.mesh.faces.copy()
    left = points[:, 0] < 0.0
    turned = left[faces].all(axis=1)
    faces[turned] = faces[turned][:, ::-1]
    judged = np.abs(points[:, 0]) > _SEAM * typical_spacing(exact.mesh)
    k1, k2 = np.where(left, -truth.k2, truth.k1), np.where(left, -truth.k1, truth.k2)
    return Subject(TriangleMesh(points, faces), k1, k2, judged), subject(exact, judged)


def flipped_some(seed: int) -> Pair:
    """Turn one face in twenty over.

    Parameters
    ----------
    seed : int
        Which ones.

    Returns
    -------
    Pair
        The truth is that of the others.
    """
    exact = ring()
    faces = exact.mesh.faces.copy()
    turned = _some(len(faces), seed)
    faces[turned] = faces[turned][:, ::-1]
    return subject(exact, mesh=TriangleMesh(exact.mesh.vertices, faces)), subject(exact)


def soup(seed: int) -> Pair:
    """Give every face corners of its own, as an STL file does.

    Parameters
    ----------
    seed : int
        Not needed: nothing is random.

    Returns
    -------
    Pair
        Soup and joined mesh.
    """
    return _soup(ring(), 0.0, seed), subject(ring())


def cracked_soup(seed: int) -> Pair:
    """Give every face corners of its own that do not quite meet.

    Parameters
    ----------
    seed : int
        How each corner is off.

    Returns
    -------
    Pair
        Soup and joined mesh.
    """
    return _soup(ring(), _CRACK * typical_spacing(ring().mesh), seed), subject(ring())


def repeated_faces(seed: int) -> Pair:
    """Add faces a second time, and faces without area.

    Parameters
    ----------
    seed : int
        Which ones.

    Returns
    -------
    Pair
        One face in twenty is repeated; as many have a corner twice.
    """
    exact = ring()
    faces = exact.mesh.faces
    again = faces[_some(len(faces), seed)]
    thin = faces[_some(len(faces), seed + 1)][:, [0, 1, 1]]
    mesh = TriangleMesh(exact.mesh.vertices, np.concatenate([faces, again, thin]))
    return subject(exact, mesh=mesh), subject(exact)


def isolated(seed: int) -> Pair:
    """Add vertices that no face uses, some of them far away.

    Parameters
    ----------
    seed : int
        Where, and at which places of the list.

    Returns
    -------
    Pair
        Judged at the surface's vertices.
    """
    exact = ring()
    generator = np.random.default_rng(seed)
    count = len(exact.mesh.vertices)
    total = count + round(_SHARE * count)
    used = np.zeros(total, dtype=bool)
    used[generator.choice(total, count, replace=False)] = True
    points = generator.standard_normal((total, 3)) * generator.choice([1.0, 1e3], (total, 1))
    k1, k2 = np.zeros(total), np.zeros(total)
    points[used], k1[used], k2[used] = exact.mesh.vertices, exact.truth.k1, exact.truth.k2
    mesh = TriangleMesh(points, np.flatnonzero(used)[exact.mesh.faces])
    return Subject(mesh, k1, k2, used), subject(exact)


def random_order(seed: int) -> Pair:
    """Shuffle vertices and faces.

    Parameters
    ----------
    seed : int
        How.

    Returns
    -------
    Pair
        Shuffled and in order.
    """
    exact = ring()
    generator = np.random.default_rng(seed)
    order = generator.permutation(len(exact.mesh.vertices))
    faces = generator.permutation(np.argsort(order)[exact.mesh.faces])
    mesh = TriangleMesh(exact.mesh.vertices[order], faces)
    everywhere = np.ones(len(order), dtype=bool)
    shuffled = Subject(mesh, exact.truth.k1[order], exact.truth.k2[order], everywhere)
    return shuffled, subject(exact)


def _soup(exact: Exact, crack: float, seed: int) -> Subject:
    corner = exact.mesh.faces.ravel()
    points = exact.mesh.vertices[corner]
    if crack:
        points = points + crack * np.random.default_rng(seed).standard_normal(points.shape)
    mesh = TriangleMesh(points, np.arange(len(corner)).reshape(-1, 3))
    everywhere = np.ones(len(corner), dtype=bool)
    return Subject(mesh, exact.truth.k1[corner], exact.truth.k2[corner], everywhere)


def _some(count: int, seed: int) -> AnyArray:
    return np.random.default_rng(seed).choice(count, round(_SHARE * count), replace=False)
