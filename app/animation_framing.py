"""The camera that keeps an object in the picture as it turns."""

import numpy as np

from app import camera as cameras
from app.composition import Composition
from app.pipeline import Pipeline
from app.render import STRIP
from app.session import Camera
from lutcore.arrays import FloatArray
from lutcore.islands import main_islands
from lutcore.mesh import TriangleMesh

_BANDS = 64
_SIDES = 64


def framed(made: Composition, pipeline: Pipeline, centre: FloatArray, axis: FloatArray) -> Camera:
    """Return a camera that looks as a picture's does, from where it sees the whole turn.

    Parameters
    ----------
    made : Composition
        The picture that shall turn.
    pipeline : Pipeline
        Where its mesh comes from.
    centre : ndarray, shape=(3,)
        A point of the axis.
    axis : ndarray, shape=(3,)
        What the mesh turns about, of unit length.

    Returns
    -------
    Camera
        Nothing but stray islands leaves its picture.
    """
    points = _swept(pipeline.subject(made.session).mesh, centre, axis)
    x, y, z = (float(one) for one in np.subtract(made.camera.position, made.camera.target))
    return cameras.fit_direction((x, y, z), made.camera.up, points, _aspect(made))


def _aspect(made: Composition) -> float:
    """Width over height of each surface's part of the picture."""
    width, height = made.session.size
    share = next(panel.width for panel in made.panels if panel.camera is not None)
    return share * width / (height * (1.0 / made.rows - STRIP))


def _swept(mesh: TriangleMesh, centre: FloatArray, axis: FloatArray) -> FloatArray:
    """Return points around all places that the mesh takes as it turns."""
    points = mesh.vertices[main_islands(mesh)] - centre
    heights = points @ axis
    radii = np.linalg.norm(points - heights[:, None] * axis, axis=1)
    edges = np.linspace(heights.min(), heights.max(), _BANDS + 1)
    band = np.clip(np.searchsorted(edges, heights, side="right") - 1, 0, _BANDS - 1)
    widest = np.zeros(_BANDS)
    np.maximum.at(widest, band, radii)
    # Circles become polygons around them.
    widest /= np.cos(np.pi / _SIDES)
    side = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    side /= np.linalg.norm(side)
    angles = 2.0 * np.pi * np.arange(_SIDES) / _SIDES
    ring = np.cos(angles)[:, None] * side + np.sin(angles)[:, None] * np.cross(axis, side)
    rings = widest[:, None, None] * ring
    both = [rings + edge[:, None, None] * axis for edge in (edges[:-1], edges[1:])]
    return centre + np.concatenate(both).reshape(-1, 3)
