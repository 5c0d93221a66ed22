"""Which share of the light that leaves a surface goes to the camera.

A window imports this before its first picture: compiled code is imported where it is used.
"""

from collections.abc import Hashable

import numpy as np

from app.camera import axes
from app.pipeline import Pipeline
from app.session import Camera, Session
from app.steps.subject import Subject
from lutcore.arrays import FloatArray
from lutcore.mesh import TriangleMesh


def leaving(
    session: Session, pipeline: Pipeline, camera: Camera, textured: bool = True
) -> FloatArray:
    """Return the factor from exitance to the light towards the camera, times pi.

    Kept while nothing but lights and exposure change.

    Parameters
    ----------
    session : Session
        Its mesh, what its curvature follows from, its material and `albedo` are used.
    pipeline : Pipeline
        Where arrays come from.
    camera : Camera
        Where it is seen from.
    textured : bool
        Whether the albedo of a texture counts, as it is at the vertices.

    Returns
    -------
    ndarray, shape=(n, 1) or (n, 3)
        The exit Fresnel factor (Kolchin 2007, eq. 6) times the albedo, where there is one.
    """
    subject = pipeline.subject(session)
    normals = pipeline.facing(session)
    eta = pipeline.material(session).eta
    # Normals are kept too, so an array that is the same object has the same content.
    key = ("leaving", subject.key, id(normals), eta, camera, session.albedo, textured)

    def compute() -> tuple[FloatArray, FloatArray]:
        factor = exit_transmittance(subject.mesh, normals, camera, eta)
        if session.albedo and (color := albedo(subject, textured)) is not None:
            factor = factor * color
        return factor, normals  # held, so that no other array gets its id

    return pipeline.once(key, compute)[0]


def albedo(subject: Subject, textured: bool = True) -> FloatArray | None:
    """Return the linear albedo at each vertex.

    Parameters
    ----------
    subject : Subject
        A mesh with what its file says of its colour.
    textured : bool
        Whether its texture counts.

    Returns
    -------
    ndarray, shape=(n, 3), or None
        Of its vertices' colours and its texture; None where the file has neither.
    """
    colors, texture = subject.loaded.colors, subject.loaded.texture
    from lutcore.color import srgb_decode

    found = None if colors is None else srgb_decode(colors)
    if texture is None or not textured:
        return found
    own = texture.albedo(len(subject.mesh.vertices))
    return own if found is None else found * own


def exit_transmittance(
    mesh: TriangleMesh, normals: FloatArray, camera: Camera, eta: tuple[float, float, float]
) -> FloatArray:
    """Return the Fresnel factor of light that leaves each vertex for the camera.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    normals : ndarray, shape=(n, 3)
        Unit normals.
    camera : Camera
        Where it is seen from.
    eta : tuple of 3 floats
        Refractive index by channel.

    Returns
    -------
    ndarray, shape=(n, 1) or (n, 3)
        0 to 1; one column where the channels have one index.
    """
    from lutcore.fresnel import leaving_along, leaving_to

    indices = np.array(eta if len(set(eta)) > 1 else eta[:1])
    if camera.height is None:
        return leaving_to(np.asarray(camera.position), mesh.vertices, normals, indices)
    return leaving_along(axes(camera)[2], normals, indices)


def view_of(session: Session, pipeline: Pipeline, aspect: float) -> Camera:
    """Return the camera of a session's picture, kept for a named view.

    Parameters
    ----------
    session : Session
        Its camera and mesh are used.
    pipeline : Pipeline
        Where arrays come from.
    aspect : float
        Width over height of the picture.

    Returns
    -------
    Camera
        See `app.camera.camera_of`.

    Raises
    ------
    ParameterError
        If there is no such view.
    """
    from app.camera import camera_of

    subject, chosen = pipeline.subject(session), session.camera
    if isinstance(chosen, Camera):
        return chosen
    key: tuple[Hashable, ...] = ("view", subject.key, session.mesh, chosen, aspect)
    return pipeline.once(key, lambda: camera_of(chosen, subject, aspect))
