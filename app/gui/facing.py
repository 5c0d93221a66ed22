"""A camera that faces a point of the surface. Knows no Qt."""

import numpy as np
from msgspec.structs import replace

from app.camera import axes
from app.gui.orbit import vector
from app.session import Camera
from lutcore.arrays import FloatArray

# Closer than this to the line of sight, up says nothing.
_ALONG = 0.95


def facing(camera: Camera, point: FloatArray, normal: FloatArray) -> Camera:
    """Return the camera turned to look straight at a point of the surface.

    Parameters
    ----------
    camera : Camera
        Before: how far it is, and what is up, stay.
    point : ndarray, shape=(3,)
        World coordinates.
    normal : ndarray, shape=(3,)
        Outward there; zero where there is none: the camera then shifts and does not turn.

    Returns
    -------
    Camera
        Its target is the point.
    """
    frame = axes(camera)
    distance = float(np.linalg.norm(np.subtract(camera.position, camera.target)))
    length = float(np.linalg.norm(normal))
    back = normal / length if length > 0.0 else frame[2]
    steep = abs(float(frame[1] @ back)) > _ALONG
    # Seen from above what was away from the viewer is up, seen from below what was towards.
    up = -np.sign(frame[1] @ back) * frame[2] if steep else frame[1]
    up = up - (up @ back) * back
    return replace(
        camera,
        position=vector(point + distance * back),
        target=vector(point),
        up=vector(up / np.linalg.norm(up)),
    )
