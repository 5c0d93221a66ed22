"""The sound surfaces that get damaged, and shapes that are hard without any damage."""

from functools import cache

import numpy as np

from lutcore import analytic
from lutcore.analytic import Exact
from lutcore.arrays import BoolArray
from lutcore.gallery.case import Pair, Subject, subject

VERTICES = 4000
"""Vertices of a sound surface, nearly: some seconds for all estimators, 37 around the tube."""

# Farther from a rim than the widest neighbourhood that an estimator takes at this size.
_INSIDE = 0.7


@cache
def ring() -> Exact:
    """Return the torus that most defects are done to.

    Its grid is as good as a mesh gets, so that what fails fails by the defect.

    Returns
    -------
    Exact
        Closed mesh; always the same object, so that it is measured once.
    """
    return analytic.torus(VERTICES)


@cache
def ball() -> Exact:
    """Return a sphere.

    Returns
    -------
    Exact
        Closed mesh; always the same object.
    """
    return analytic.sphere(VERTICES)


@cache
def egg(count: int) -> Exact:
    """Return an ellipsoid.

    Parameters
    ----------
    count : int
        Vertices.

    Returns
    -------
    Exact
        Closed mesh; for one count always the same object.
    """
    return analytic.ellipsoid(count)


@cache
def sheet(kind: str) -> Exact:
    """Return a sheet over a square.

    Parameters
    ----------
    kind : str
        ``saddle``, ``bowl`` (the same, bent down both ways) or ``monkey``.

    Returns
    -------
    Exact
        Mesh with a square rim; for one kind always the same object.
    """
    if kind == "monkey":
        return analytic.monkey_saddle(VERTICES)
    return analytic.saddle(VERTICES, k=(1.0, -1.0 if kind == "saddle" else 1.0))


def saddle(seed: int) -> Pair:
    """Bend a bowl up along one axis.

    Parameters
    ----------
    seed : int
        Not needed: nothing is random.

    Returns
    -------
    Pair
        Saddle and bowl, judged away from their rims.
    """
    return _sheet("saddle"), _sheet("bowl")


def monkey_saddle(seed: int) -> Pair:
    """Take a surface that is flat at one point and has no directions there.

    Parameters
    ----------
    seed : int
        Not needed: nothing is random.

    Returns
    -------
    Pair
        Monkey saddle and saddle, judged away from their rims.
    """
    return _sheet("monkey"), _sheet("saddle")


def umbilic(seed: int) -> Pair:
    """Make both curvatures equal everywhere.

    Parameters
    ----------
    seed : int
        Not needed: nothing is random.

    Returns
    -------
    Pair
        Sphere, and an ellipsoid with the same triangles.
    """
    return subject(ball()), subject(egg(VERTICES))


def thin(seed: int) -> Pair:
    """Make the tube so thin that 14 vertices go around it.

    Parameters
    ----------
    seed : int
        Not needed: nothing is random.

    Returns
    -------
    Pair
        Thin torus and thick one.
    """
    return subject(analytic.torus(VERTICES, minor=0.05)), subject(ring())


def _sheet(kind: str) -> Subject:
    exact = sheet(kind)
    return subject(exact, _inside(exact))


def _inside(exact: Exact) -> BoolArray:
    inside: BoolArray = np.abs(exact.mesh.vertices[:, :2]).max(axis=1) < _INSIDE
    return inside
