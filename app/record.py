"""What a picture says of its own making, as plain data: enough to make it again."""

import hashlib
from typing import Literal

import msgspec

from app.backend import Backend, machine
from app.camera import axes
from app.picture import Picture
from app.pipeline import Pipeline
from app.render import Image
from app.session import Camera, Session
from app.settling import recorded, settled
from app.transparency import without_need
from app.versions import versions
from lutcore.shading import AUTO


class MeshFile(msgspec.Struct, frozen=True):
    """The mesh that was drawn.

    Parameters
    ----------
    sha256 : str
        Of the file's bytes, hexadecimal.
    vertices, faces : int
        Its size.
    """

    sha256: str
    vertices: int
    faces: int


class Resolved(msgspec.Struct, frozen=True):
    """What the session left open, as it was found for this mesh.

    Parameters
    ----------
    camera : Camera
        Where the picture was taken from.
    exposure : float or None
        See `app.picture.Picture`.
    ranges : dict of str to tuple of 2 floats
        See `app.picture.Picture`.
    mm_per_unit : float
        Size of a mesh unit.
    scale : float or None
        Length that curvature was averaged over, mesh units; None where the estimator chose it.
    model : str or None
        What the shading model `auto` took, which depends on what models cost on a machine; None
        where another was named, or none is used.
    """

    camera: Camera
    exposure: float | None
    ranges: dict[str, tuple[float, float]]
    mm_per_unit: float
    scale: float | None
    model: str | None = None


class Record(msgspec.Struct, frozen=True):
    """How a picture was made.

    It holds no time, no user and no host: the same session over the same mesh gives the same file.

    Parameters
    ----------
    session : Session
        As it was asked for, with what the shading model `auto` came to: it is what makes the
        picture again.
    resolved : Resolved
        What it came to.
    mesh : MeshFile
        What was drawn.
    versions : dict of str to str
        By package, Python included.
    machine : str
        System and kind of processor: compiled arithmetic rounds differently on another.
    backend : Backend
        The OpenGL driver.
    pixels : str
        See `pixels_digest`.
    format : int
        Of this record.
    """

    session: Session
    resolved: Resolved
    mesh: MeshFile
    versions: dict[str, str]
    machine: str
    backend: Backend
    pixels: str
    format: Literal[1] = 1


def record_of(session: Session, pipeline: Pipeline, made: Picture) -> Record:
    """Return how a picture was made.

    Parameters
    ----------
    session : Session
        What was asked for.
    pipeline : Pipeline
        The one that the picture was made with.
    made : Picture
        See `app.picture.render`.

    Returns
    -------
    Record
        For `app.provenance.write_picture`.
    """
    subject = pipeline.subject(session)
    return Record(
        recorded(session, pipeline, axes(made.camera)),
        Resolved(
            made.camera,
            made.exposure,
            made.ranges,
            pipeline.mm_per_unit(session),
            pipeline.scale(session),
            _chosen(session, pipeline, made),
        ),
        MeshFile(subject.loaded.digest, len(subject.mesh.vertices), len(subject.mesh.faces)),
        versions(session),
        machine(),
        made.backend,
        pixels_digest(made.image),
    )


def _chosen(session: Session, pipeline: Pipeline, made: Picture) -> str | None:
    if session.model.name != AUTO or session.view not in ("shade", "figure"):
        return None
    return settled(pipeline.settled(session, session.model, axes(made.camera))).label


def pixels_digest(image: Image) -> str:
    """Return the SHA-256 of a picture's size and pixels, hexadecimal.

    Parameters
    ----------
    image : ndarray of uint8, shape=(height, width, 3 or 4)
        The picture.

    Returns
    -------
    str
        However the file packs them.
    """
    image = without_need(image)
    height, width, _ = image.shape
    return hashlib.sha256(f"{width}x{height}:".encode() + image.tobytes()).hexdigest()


def elsewhere(then: Record, now: Record) -> str:
    """Say why two pictures cannot be expected to be the same, bit for bit.

    Parameters
    ----------
    then, now : Record
        How they were made.

    Returns
    -------
    str
        What drew the first and what the second; empty if driver, VTK and kind of processor agree.
    """
    if then.backend != now.backend:
        return f"drawn by {then.backend.label}, here by {now.backend.label}"
    old, new = then.versions.get("vtk"), now.versions.get("vtk")
    if old != new:
        return f"drawn with VTK {old}, here with {new}"
    if then.machine != now.machine:
        return f"made on {then.machine}, here on {now.machine}"
    return ""
