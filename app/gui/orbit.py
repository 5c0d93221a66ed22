"""How a camera moves: turned about what it looks at, shifted, brought nearer. Knows no Qt."""

import numpy as np
from msgspec.structs import replace

from app.camera import axes
from app.session import Camera, Vector
from lutcore.arrays import FloatArray

_NEAREST = 1e-6
# A drag over the whole height of the view turns by this much, as in other viewers.
_TURN = np.pi


def turned(camera: Camera, right: float, up: float) -> Camera:
    """Return the camera after a drag that turns the mesh, as a ball under the hand.

    Parameters
    ----------
    camera : Camera
        Before.
    right, up : float
        How far the mouse moved, in heights of the view.

    Returns
    -------
    Camera
        Turned about its target.
    """
    frame = axes(camera)
    turn = _rotation(frame[1], -_TURN * right) @ _rotation(frame[0], _TURN * up)
    back = turn @ np.subtract(camera.position, camera.target)
    return replace(camera, position=vector(np.add(camera.target, back)), up=vector(turn @ frame[1]))


def rolled(camera: Camera, angle: float) -> Camera:
    """Return the camera turned about its line of sight.

    Parameters
    ----------
    camera : Camera
        Before.
    angle : float
        Radians; the picture turns anticlockwise.

    Returns
    -------
    Camera
        After.
    """
    frame = axes(camera)
    return replace(camera, up=vector(_rotation(frame[2], -angle) @ frame[1]))


def shifted(camera: Camera, right: float, up: float) -> Camera:
    """Return the camera after a drag that shifts the mesh with the mouse.

    Parameters
    ----------
    camera : Camera
        Before.
    right, up : float
        How far the mouse moved, in heights of the view.

    Returns
    -------
    Camera
        Shifted, so that what lies at the target's depth stays under the mouse.
    """
    frame = axes(camera)
    step = -(right * frame[0] + up * frame[1]) * height_at_target(camera)
    return replace(
        camera,
        position=vector(np.add(camera.position, step)),
        target=vector(np.add(camera.target, step)),
    )


def nearer(camera: Camera, factor: float) -> Camera:
    """Return the camera brought nearer to what it looks at.

    Parameters
    ----------
    camera : Camera
        Before.
    factor : float
        How many times larger things become.

    Returns
    -------
    Camera
        After.
    """
    back = np.subtract(camera.position, camera.target)
    length = float(np.linalg.norm(back))
    least = _NEAREST * (length + float(np.linalg.norm(camera.target)))
    back = back * (max(length / factor, least) / length)
    height = None if camera.height is None else camera.height / factor
    return replace(camera, position=vector(np.add(camera.target, back)), height=height)


def parallel(camera: Camera, on: bool) -> Camera:
    """Return the camera with parallel or perspective projection, what it looks at as large.

    Parameters
    ----------
    camera : Camera
        Before.
    on : bool
        Whether the projection is parallel.

    Returns
    -------
    Camera
        After.
    """
    if on == (camera.height is not None):
        return camera
    if on:
        return replace(camera, height=height_at_target(camera))
    # As far away as makes the picture as high as it was.
    distance = camera.height / 2.0 / np.tan(np.radians(camera.angle / 2.0))  # type: ignore[operator]
    back = axes(camera)[2]
    return replace(camera, position=vector(np.add(camera.target, distance * back)), height=None)


def height_at_target(camera: Camera) -> float:
    """Return how much of the scene the height of the view shows, at the target's depth.

    Parameters
    ----------
    camera : Camera
        Any camera.

    Returns
    -------
    float
        Mesh units.
    """
    if camera.height is not None:
        return camera.height
    distance = float(np.linalg.norm(np.subtract(camera.position, camera.target)))
    return float(2.0 * distance * np.tan(np.radians(camera.angle / 2.0)))


def ray(camera: Camera, right: float, up: float) -> tuple[FloatArray, FloatArray]:
    """Return the line of sight through a point of the view.

    Parameters
    ----------
    camera : Camera
        Any camera.
    right, up : float
        From the middle of the view, in heights of the view.

    Returns
    -------
    start, direction : ndarray, shape=(3,)
        World coordinates; the direction has length 1 and points into the scene.
    """
    frame = axes(camera)
    aside = right * frame[0] + up * frame[1]
    if camera.height is not None:
        return np.add(camera.position, aside * camera.height), -frame[2]
    direction = 2.0 * np.tan(np.radians(camera.angle / 2.0)) * aside - frame[2]
    return np.array(camera.position), direction / np.linalg.norm(direction)


def vector(array: FloatArray) -> Vector:
    """Return three numbers as a session keeps them.

    Parameters
    ----------
    array : ndarray, shape=(3,)
        Any.

    Returns
    -------
    tuple of 3 floats
        The same.
    """
    return float(array[0]), float(array[1]), float(array[2])


def _rotation(axis: FloatArray, angle: float) -> FloatArray:
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    # Rodrigues' formula.
    matrix: FloatArray = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    return matrix
