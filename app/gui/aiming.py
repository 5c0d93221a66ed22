"""Where lights are aimed from: points of a ball, and points in the view. Knows no Qt."""

import numpy as np

from app.camera import axes
from app.gui import orbit
from app.session import Camera, Directional, Vector
from lutcore.arrays import FloatArray

# Over the whole height of the view, as the camera turns.
_TURN = np.pi


def on_ball(direction: Vector) -> tuple[float, float, bool]:
    """Return where a direction lies on a ball that is looked at.

    Parameters
    ----------
    direction : tuple of 3 floats
        To the light, in the camera's axes, any length.

    Returns
    -------
    right, up : float
        In radii, from the middle.
    front : bool
        Whether it is on the side of the ball that is seen.
    """
    x, y, z = np.asarray(direction) / max(float(np.linalg.norm(direction)), 1e-300)
    return float(x), float(y), bool(z >= 0.0)


def from_ball(right: float, up: float) -> Vector:
    """Return the direction of a point on a ball, or beside it.

    Parameters
    ----------
    right, up : float
        In radii, from the middle. Beside the ball the way goes on over the rim: a point at 1.3 is
        the one at 0.7 on the far side.

    Returns
    -------
    tuple of 3 floats
        To the light, in the camera's axes, length 1.
    """
    length = float(np.hypot(right, up))
    radius = length if length <= 1.0 else max(2.0 - length, 0.0)
    across = radius / length if length > 0.0 else 0.0
    depth = float(np.sqrt(max(1.0 - radius * radius, 0.0)))
    return right * across, up * across, depth if length <= 1.0 else -depth


def turned(direction: Vector, right: float, up: float) -> Vector:
    """Return a direction after a drag that turns it, as the front of a ball under the hand.

    Parameters
    ----------
    direction : tuple of 3 floats
        In the camera's axes.
    right, up : float
        How far the mouse moved, in heights of the view.

    Returns
    -------
    tuple of 3 floats
        Of the same length.
    """
    angle = _TURN * float(np.hypot(right, up))
    if angle == 0.0:
        return direction
    axis = np.array([-up, right, 0.0]) / np.hypot(right, up)
    d = np.asarray(direction)
    along = axis * (axis @ d) * (1.0 - np.cos(angle))
    return orbit.vector(d * np.cos(angle) + np.cross(axis, d) * np.sin(angle) + along)


def seen_by(light: Directional, camera: Camera) -> Vector:
    """Return a light's direction in the camera's axes.

    Parameters
    ----------
    light : Directional
        Of either frame.
    camera : Camera
        Who looks.

    Returns
    -------
    tuple of 3 floats
        To the light.
    """
    if light.frame == "camera":
        return light.direction
    return orbit.vector(axes(camera) @ np.asarray(light.direction))


def kept_in(light: Directional, seen: Vector, camera: Camera) -> Vector:
    """Return a direction in the frame that a light keeps it in.

    Parameters
    ----------
    light : Directional
        Its frame counts.
    seen : tuple of 3 floats
        In the camera's axes.
    camera : Camera
        Who looks.

    Returns
    -------
    tuple of 3 floats
        For `Directional.direction`.
    """
    return seen if light.frame == "camera" else orbit.vector(axes(camera).T @ np.asarray(seen))


def place_of(camera: Camera, point: Vector) -> tuple[float, float] | None:
    """Return where a point is in the view.

    Parameters
    ----------
    camera : Camera
        Who looks.
    point : tuple of 3 floats
        World coordinates.

    Returns
    -------
    tuple of 2 floats, or None
        Right and up from the middle of the view, in its heights; None behind the camera.
    """
    x, y, z = axes(camera) @ np.subtract(point, camera.position)
    if camera.height is not None:
        return float(x / camera.height), float(y / camera.height)
    if z >= 0.0:
        return None
    height = -2.0 * z * np.tan(np.radians(camera.angle / 2.0))
    return float(x / height), float(y / height)


def beside(camera: Camera, point: Vector, right: float, up: float) -> Vector:
    """Return a point moved to another place of the view, as far away as it was.

    Parameters
    ----------
    camera : Camera
        Who looks.
    point : tuple of 3 floats
        World coordinates, before the camera.
    right, up : float
        Where to, in heights of the view from its middle.

    Returns
    -------
    tuple of 3 floats
        World coordinates.
    """
    start, direction = orbit.ray(camera, right, up)
    back = axes(camera)[2]
    depth = (np.subtract(point, start) @ back) / (direction @ back)
    return orbit.vector(start + depth * direction)


def on_sphere(camera: Camera, radius: float, right: float, up: float, front: bool) -> FloatArray:
    """Return the direction from the camera's target to where a line of sight meets a sphere.

    Parameters
    ----------
    camera : Camera
        Who looks; the sphere is around its target.
    radius : float
        Mesh units.
    right, up : float
        The line of sight, in heights of the view from its middle.
    front : bool
        Whether the nearer of the two points is meant.

    Returns
    -------
    ndarray, shape=(3,)
        World axes, length 1; on the rim where the line passes the sphere by.
    """
    start, direction = orbit.ray(camera, right, up)
    offset = np.subtract(start, camera.target)
    middle = -float(offset @ direction)
    nearest = offset + middle * direction
    half = np.sqrt(max(radius * radius - float(nearest @ nearest), 0.0))
    found: FloatArray = nearest + (-half if front else half) * direction
    return found / np.linalg.norm(found)
