"""A report on one page: all that a colleague needs to judge a curvature, in one HTML file."""

import base64
import io
from dataclasses import dataclass
from pathlib import Path

from msgspec.structs import replace

from app.colormaps import PAPER, table
from app.findings import Findings
from app.pipeline import Pipeline
from app.session import Session
from app.writing import write_bytes

_PAPER_GROUND = "white"
_MAP_SIZE = (1000, 800)
_PACKAGES = ("curvelight", "numpy", "scipy", "numba", "vtk", "matplotlib")


@dataclass(frozen=True)
class Views:
    """One picture for bright surroundings and one for dark ones.

    Parameters
    ----------
    light, dark : bytes
        PNG; the same where the session says its background.
    """

    light: bytes
    dark: bytes


@dataclass(frozen=True, eq=False)
class Content:
    """What a report shows.

    Parameters
    ----------
    mesh : str
        As the session names it.
    digest : str
        SHA-256 of the file.
    vertices, faces : int
        Size of the mesh.
    diagonal : float
        Of the box around the surface, mm.
    mm_per_unit : float
        Size of a mesh unit.
    assumed : bool
        Whether nobody said that size.
    summary : str
        What the estimator is, in one line.
    remarks : tuple of str
        What is odd about the mesh or the file.
    found : Findings
        The numbers.
    quantities : Views
        Every quantity on the surface.
    disagreement : Views or None
        The estimators' disagreement on the surface.
    histograms : str
        An ``<svg>`` element.
    versions : dict of str to str
        Of the packages that took part.
    command : str
        The command line that makes the report again.
    """

    mesh: str
    digest: str
    vertices: int
    faces: int
    diagonal: float
    mm_per_unit: float
    assumed: bool
    summary: str
    remarks: tuple[str, ...]
    found: Findings
    quantities: Views
    disagreement: Views | None
    histograms: str
    versions: dict[str, str]
    command: str


def write(path: Path, session: Session, pipeline: Pipeline, found: Findings, command: str) -> None:
    """Write a report, whole or not at all.

    Parameters
    ----------
    path : Path
        The .html file.
    session : Session
        What was measured; its quantity is ``all``.
    pipeline : Pipeline
        Where arrays come from.
    found : Findings
        Of that session.
    command : str
        The command line that makes the report again.

    Raises
    ------
    WriteError
        If it cannot be written; an older file of that name is then untouched.
    DrawingError
        If this machine has no working OpenGL.
    """
    from app.report_page import page

    # A name that is no proper text, as file systems allow, must not end the writing.
    text = page(content(session, pipeline, found, command)).encode("utf-8", "replace")
    write_bytes(path, text)


def content(session: Session, pipeline: Pipeline, found: Findings, command: str) -> Content:
    """Gather what a report shows.

    Parameters
    ----------
    session, pipeline, found, command
        See `write`.

    Returns
    -------
    Content
        Pictures included.
    """
    from app.report_histograms import svg
    from lutcore.estimation import estimator_registry

    subject = pipeline.subject(session)
    size = pipeline.mm_per_unit(session)
    health = subject.loaded.health
    colors = table(session.colormap or PAPER)
    document = estimator_registry.get(session.estimator.name).__doc__ or ""
    # The disagreement has a picture of its own, beside its numbers.
    apart = replace(session, quantity="disagreement", size=_MAP_SIZE)
    return Content(
        mesh=session.mesh,
        digest=subject.loaded.digest,
        vertices=len(subject.mesh.vertices),
        faces=len(subject.mesh.faces),
        diagonal=health.diagonal * size,
        mm_per_unit=size,
        assumed=session.mm_per_unit is None and subject.mm_per_unit is None,
        summary=document.strip().partition("\n")[0],
        remarks=(*subject.warnings, *health.remarks(size)),
        found=found,
        quantities=_views(replace(session, quantity="all", peers=()), pipeline),
        disagreement=_views(apart, pipeline) if session.peers else None,
        histograms=svg(found.histograms, colors[::-1] if session.flip else colors),
        versions=_versions(),
        command=command,
    )


def _views(session: Session, pipeline: Pipeline) -> Views:
    dark = _png(session, pipeline)
    if session.background != Session().background:
        return Views(dark, dark)
    return Views(_png(replace(session, background=_PAPER_GROUND), pipeline), dark)


def _png(session: Session, pipeline: Pipeline) -> bytes:
    from PIL import Image

    from app.picture import render

    stream = io.BytesIO()
    Image.fromarray(render(session, pipeline).image).save(stream, format="PNG", optimize=True)
    return stream.getvalue()


def data_uri(png: bytes) -> str:
    """Return a picture as an address that holds it.

    Parameters
    ----------
    png : bytes
        A PNG file.

    Returns
    -------
    str
        ``data:image/png;base64,...``.
    """
    return f"data:image/png;base64,{base64.b64encode(png).decode('ascii')}"


def _versions() -> dict[str, str]:
    import platform
    from importlib.metadata import version

    packages = {name: version(name) for name in _PACKAGES}
    return packages | {"Python": platform.python_version()}
