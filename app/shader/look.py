"""What the fragment shader needs to know of a session: per vertex, as a table, as numbers."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from app.camera import axes as axes_of
from app.leaving import albedo
from app.lighting import world_lights
from app.pipeline import Pipeline
from app.session import Camera, Session
from app.shader.packing import Packing
from app.shader.vertices import forms, rows, second
from app.steps.subject import Subject
from lutcore.arrays import FloatArray, SingleArray
from lutcore.response_table import halfway, response

if TYPE_CHECKING:
    from lutcore.lut import PsiTable
    from lutcore.shading import ShadingModel

MOST_LIGHTS = 8
"""As many lights as the shader has room for."""
MODELS = ("curvature-lut", "lambert")
"""Shading models that are written as shaders."""
_VIEWS = ("shade", "figure")

# What attributes, table and numbers follow from.
_FIXED = (
    "mesh",
    "volume",
    "repairs",
    "mm_per_unit",
    "material",
    "profile",
    "model",
    "estimator",
    "scale",
    "albedo",
)


@dataclass(frozen=True, eq=False)
class PixelLook:
    """A shading model on a surface, as a fragment shader takes it.

    Parameters
    ----------
    session : Session
        What it was made of.
    model : str
        One of `MODELS`.
    directional : bool
        Whether light enters by F_t(N.w), for ``lambert``.
    by_channel : bool
        Whether each channel has normals and curvature of its own.
    parts : Packing
        Where the numbers of a vertex lie in the attributes: ``facingC``, the normal, and, for
        ``curvature-lut``, ``formC``, S+ in its tangent plane (see `app.shader.vertices.forms`),
        for each channel C or for 0 alone; ``leaving``, the normal that the camera sees, if not
        ``facing0``; ``kept``, what the light is multiplied by, if it is not the same everywhere.
    attributes : dict of str to ndarray of float32, shape=(n, 4)
        By the names that `parts` gives.
    numbers : dict of str to tuple of float
        Constants of the material and the model by the name of their uniform.
    table : ndarray of float32, or None
        For ``curvature-lut``: see `lutcore.response_table.response`.
    """

    session: Session
    model: str
    directional: bool
    by_channel: bool
    parts: Packing
    attributes: dict[str, SingleArray]
    numbers: dict[str, tuple[float, ...]]
    table: SingleArray | None

    def fits(self, session: Session) -> bool:
        """Tell whether it stands for another session too, on the same file.

        Parameters
        ----------
        session : Session
            What is to be shown.

        Returns
        -------
        bool
            True if they differ in nothing that the shader is not told by uniforms.
        """
        return all(getattr(session, name) == getattr(self.session, name) for name in _FIXED)


def unsupported(session: Session, subject: Subject) -> str:
    """Say why a session cannot be shaded per pixel.

    Parameters
    ----------
    session : Session
        What is shown.
    subject : Subject
        Its mesh.

    Returns
    -------
    str
        What keeps it at vertices; empty if nothing does.
    """
    if session.view not in _VIEWS:
        return f"the view {session.view} is not shaded per pixel"
    if session.model.name not in MODELS:
        return f"the model {session.model.name} has no shader"
    if len(session.lights) > MOST_LIGHTS:
        return f"the shader has room for {MOST_LIGHTS} lights"
    if session.casts != "off":
        return "shadows are cast on vertices"
    if session.albedo and subject.loaded.texture is not None:
        return "a texture is drawn under light at vertices"
    return ""


def look_of(session: Session, pipeline: Pipeline, axes: FloatArray) -> PixelLook:
    """Return what the shader needs for a session that `unsupported` has nothing against.

    Parameters
    ----------
    session : Session
        Everything but its lights, exposure and camera is used.
    pipeline : Pipeline
        Where arrays come from.
    axes : ndarray, shape=(3, 3)
        Of any camera.

    Returns
    -------
    PixelLook
        Good for all lights, exposures and cameras.

    Raises
    ------
    MeshError, ParameterError
        If the mesh or a parameter does not allow it.
    """
    from lutcore.fresnel import hinges_of
    from plugins.shading.curvature_lut import CurvatureLut

    model = pipeline.settled(session, session.model, axes)
    inputs = pipeline.inputs(session, axes)
    seen = inputs.detail
    bent = model if isinstance(model, CurvatureLut) else None
    table = inputs.table if bent is None else inputs.baked(bent.samples)
    facing = (inputs.normals,) if seen is None else tuple(seen.normals)
    shapes = (inputs.shape,) if seen is None else tuple(seen.shape)
    vectors = {f"facing{channel}": normals for channel, normals in enumerate(facing)}
    if bent is not None:
        for channel, (normals, shape) in enumerate(zip(facing, shapes, strict=True)):
            vectors[f"form{channel}"] = forms(normals, shape)
    if seen is not None:
        vectors["leaving"] = pipeline.facing(session)
    total, kept = _total(model, table), None
    if bent is not None and bent.area == "curved":
        kept = total / (1.0 + second(table, shapes))
    if session.albedo and (color := albedo(pipeline.subject(session))) is not None:
        kept = color * (total if kept is None else kept)
    if kept is not None:
        vectors["kept"] = kept
    parts = Packing("glowGiven", dict.fromkeys(vectors, 3))
    return PixelLook(
        session,
        session.model.name,
        getattr(model, "fresnel", "") == "directional",
        seen is not None,
        parts,
        rows(parts, list(vectors.values())),
        {
            "glowEta": tuple(table.eta),
            "glowTotal": tuple(total),
            "glowLength": tuple(table.mean_free_path),
            "glowHalfway": tuple(halfway(table) / np.sqrt(table.mean_free_path)),
        },
        None if bent is None else response(table, *hinges_of(table.eta, bent.hinges)),
    )


def _total(model: "ShadingModel", table: "PsiTable") -> FloatArray:
    from plugins.shading.lambert import Lambert

    mean = isinstance(model, Lambert) and model.fresnel == "mean"
    return table.total * table.entering if mean else table.total


def packed(session: Session, camera: Camera) -> FloatArray:
    """Return a session's lights as rows of numbers, room for `MOST_LIGHTS` of them.

    Parameters
    ----------
    session : Session
        Its lights, no more than there is room for.
    camera : Camera
        Which lights of the camera's frame move with.

    Returns
    -------
    ndarray, shape=(MOST_LIGHTS, LIGHT_FIELDS)
        See `lutcore.lights.pack`; black where there is none.
    """
    from lutcore.lights import LIGHT_FIELDS, pack

    rows = np.zeros((MOST_LIGHTS, LIGHT_FIELDS))
    rows[: len(session.lights)] = pack(world_lights(session, axes_of(camera)))
    return rows
