"""Cameras: named views fitted to a mesh, and what a person types for one."""

import numpy as np

from app.session import Camera, Vector
from app.steps.subject import Subject
from lutcore.arrays import FloatArray
from lutcore.errors import ParameterError
from lutcore.islands import main_islands

# Name: direction from the mesh to the camera, and what is up. +z is the front, +y is up.
VIEWS: dict[str, tuple[Vector, Vector]] = {
    "front": ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
    "back": ((0.0, 0.0, -1.0), (0.0, 1.0, 0.0)),
    "right": ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    "left": ((-1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    "top": ((0.0, 1.0, 0.0), (0.0, 0.0, -1.0)),
    "bottom": ((0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
    "oblique": ((1.0, 0.7, 1.4), (0.0, 1.0, 0.0)),
}
_MARGIN = 1.06
_ANGLE = 30.0


def parse(text: str) -> str | Camera:
    """Return the camera that a person typed.

    Parameters
    ----------
    text : str
        ``auto``, a view's name, or nine numbers: position, target, up; a tenth is the angle of
        view in degrees.

    Returns
    -------
    str or Camera
        For `Session.camera`.

    Raises
    ------
    ParameterError
        If it is neither.
    """
    if text == "auto" or text in VIEWS:
        return text
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        raise ParameterError.unknown("camera", text, ["auto", *VIEWS]) from None
    if len(numbers) not in (9, 10) or not np.isfinite(numbers).all():
        raise ParameterError(
            f"camera {text!r} has {len(numbers)} numbers, expected 9 (position, target, up) or 10"
        )
    position, target, up = (tuple(numbers[i : i + 3]) for i in (0, 3, 6))
    angle = numbers[9] if len(numbers) == 10 else _ANGLE
    return Camera(position, target, up, angle)  # type: ignore[arg-type]


def camera_of(chosen: str | Camera, subject: Subject, aspect: float, whole: bool = False) -> Camera:
    """Return the camera that a session's choice means for its mesh.

    Parameters
    ----------
    chosen : str or Camera
        `Session.camera`.
    subject : Subject
        The mesh, and the sample it came from: that knows its best side.
    aspect : float
        Width over height of the picture.
    whole : bool
        Whether stray islands count too: to tell them takes compiled code.

    Returns
    -------
    Camera
        The camera itself, or one that just shows the mesh.

    Raises
    ------
    ParameterError
        If there is no such view.
    """
    if isinstance(chosen, Camera):
        return chosen
    mesh = subject.mesh
    # Stray islands do not shrink the view.
    seen = np.unique(mesh.faces) if whole else main_islands(mesh)
    every = not whole and seen.all()  # then a copy would only take time
    points = mesh.vertices if every else mesh.vertices[seen]
    if chosen == "auto" and subject.sample is not None:
        return fit_direction(subject.sample.view, subject.sample.up, points, aspect)
    return fit("front" if chosen == "auto" else chosen, points, aspect)


def axes(camera: Camera) -> FloatArray:
    """Return the camera's axes in world coordinates.

    Parameters
    ----------
    camera : Camera
        Any camera.

    Returns
    -------
    ndarray, shape=(3, 3)
        Rows: right, up, and back towards the viewer; orthonormal.

    Raises
    ------
    ParameterError
        If position and target coincide, or `up` is along the line of sight.
    """
    back = np.subtract(camera.position, camera.target)
    right = np.cross(camera.up, back)
    if np.linalg.norm(right) <= 1e-9 * np.linalg.norm(back) * np.linalg.norm(camera.up):
        raise ParameterError("camera: position, target and up do not define a view")
    back = back / np.linalg.norm(back)
    right = right / np.linalg.norm(right)
    return np.array([right, np.cross(back, right), back])


def fit(view: str, points: FloatArray, aspect: float) -> Camera:
    """Return the camera of a named view that just shows all points.

    Parameters
    ----------
    view : str
        A key of `VIEWS`.
    points : ndarray, shape=(n, 3)
        What must be seen, n > 0.
    aspect : float
        Width over height of the picture.

    Returns
    -------
    Camera
        A perspective camera with a small margin.

    Raises
    ------
    ParameterError
        If there is no such view.
    """
    if view not in VIEWS:
        raise ParameterError.unknown("camera", view, ["auto", *VIEWS])
    direction, up = VIEWS[view]
    return fit_direction(direction, up, points, aspect)


def fit_direction(direction: Vector, up: Vector, points: FloatArray, aspect: float) -> Camera:
    """Return the camera that looks along a direction and just shows all points.

    Parameters
    ----------
    direction : tuple of 3 floats
        From the mesh to the camera, any length.
    up : tuple of 3 floats
        What is up in the picture.
    points : ndarray, shape=(n, 3)
        What must be seen, n > 0.
    aspect : float
        Width over height of the picture.

    Returns
    -------
    Camera
        A perspective camera with a small margin.
    """
    frame = axes(Camera(direction, (0.0, 0.0, 0.0), up))
    centre = points.mean(axis=0)
    x, y, z = frame @ (points - centre).T
    slope = np.tan(np.radians(_ANGLE / 2.0)) / _MARGIN
    middle = np.zeros(2)
    distance = float(z.max()) + 1e-6 * (float(np.ptp(z)) + 1e-12)
    # A point is seen if |x - middle| <= s (distance - z): both sides bind at the best middle.
    for axis, (offset, s) in enumerate(((x, slope * aspect), (y, slope))):
        above, below = float((s * z + offset).max()), float((s * z - offset).max())
        middle[axis] = 0.5 * (above - below)
        distance = max(distance, 0.5 * (above + below) / s)
    target = centre + middle @ frame[:2]
    position = target + distance * frame[2]
    return Camera(_vector(position), _vector(target), up, _ANGLE)


def _vector(array: FloatArray) -> Vector:
    return float(array[0]), float(array[1]), float(array[2])
