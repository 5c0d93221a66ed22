"""What a case of the gallery is made of."""

from dataclasses import dataclass

import numpy as np

from lutcore.analytic import Exact
from lutcore.arrays import BoolArray, FloatArray
from lutcore.mesh import TriangleMesh


@dataclass(frozen=True, eq=False)
class Subject:
    """A mesh with the truth at its vertices, and those of them that are judged.

    Parameters
    ----------
    mesh : TriangleMesh
        The mesh, n vertices.
    k1, k2 : ndarray, shape=(n,)
        Exact principal curvatures, k1 >= k2, 1/mesh unit; 0 where nothing is known.
    judged : ndarray of bool, shape=(n,)
        Vertices whose error counts: those that the defect can harm and where there is a truth.
    """

    mesh: TriangleMesh
    k1: FloatArray
    k2: FloatArray
    judged: BoolArray


Pair = tuple[Subject, Subject]
"""A subject with its defect, and the same without it."""


@dataclass(frozen=True, eq=False)
class Case:
    """One defect.

    Parameters
    ----------
    name : str
        What users type.
    title : str
        What a person reads.
    why : str
        What is broken, and why that is hard, in one sentence.
    broken, sound : Subject
        The mesh with the defect, and the same without it.
    """

    name: str
    title: str
    why: str
    broken: Subject
    sound: Subject


def subject(
    exact: Exact, judged: BoolArray | None = None, mesh: TriangleMesh | None = None
) -> Subject:
    """Return a known surface as a subject.

    Parameters
    ----------
    exact : Exact
        Mesh and truth.
    judged : ndarray of bool, shape=(n,), optional
        Vertices whose error counts; all if not given.
    mesh : TriangleMesh, optional
        Mesh of the same vertices that takes the place of the exact one.

    Returns
    -------
    Subject
        The subject.
    """
    if judged is None:
        judged = np.ones(len(exact.mesh.vertices), dtype=bool)
    return Subject(mesh or exact.mesh, exact.truth.k1, exact.truth.k2, judged)


def within(points: FloatArray, centres: FloatArray, reach: float) -> BoolArray:
    """Mark the points that lie near one of some places.

    Parameters
    ----------
    points : ndarray, shape=(n, 3)
        Positions.
    centres : ndarray, shape=(c, 3)
        The places.
    reach : float
        Distance that is near.

    Returns
    -------
    ndarray of bool, shape=(n,)
        True where the nearest place is closer than the reach.
    """
    from scipy.spatial import cKDTree

    distance, _ = cKDTree(centres).query(points, distance_upper_bound=reach)
    near: BoolArray = np.isfinite(distance)
    return near


def part(whole: Exact, kept: BoolArray) -> tuple[TriangleMesh, BoolArray]:
    """Cut a part out of a mesh, along its edges.

    Parameters
    ----------
    whole : Exact
        The surface.
    kept : ndarray of bool, shape=(m,)
        Faces of the part.

    Returns
    -------
    mesh : TriangleMesh
        The part, with its own vertices only.
    used : ndarray of bool, shape=(n,)
        The whole's vertices that it has, in their order.
    """
    faces = whole.mesh.faces[kept]
    used = np.zeros(len(whole.mesh.vertices), dtype=bool)
    used[faces.ravel()] = True
    number = np.cumsum(used) - 1
    return TriangleMesh(whole.mesh.vertices[used], number[faces]), used
