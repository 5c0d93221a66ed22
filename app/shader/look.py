"""What the fragment shader needs to know of a session: per vertex, as a table, as numbers."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from app.camera import axes as axes_of
from app.leaving import albedo
from app.lighting import world_lights
from app.pipeline import Pipeline, Subject
from app.session import Camera, Session
from lutcore.arrays import FloatArray

if TYPE_CHECKING:
    from lutcore.lut import PsiTable
    from lutcore.shading import ShadingModel

MOST_LIGHTS = 8
"""As many lights as the shader has room for."""
MODELS = ("curvature-lut", "lambert")
"""Shading models that are written as shaders."""
HALF = 2.0
"""|a|/b in the middle of the table."""
# Straight lines between are within 1e-5 of psi. The position in this table takes a division, that
# in `PsiTable.rows` a root and a logarithm more, at each pixel.
_SAMPLES = 1024
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

SingleArray = NDArray[np.float32]


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
    attributes : dict of str to ndarray of float32, shape=(n, 3)
        Per vertex: ``facingC``, the normal, and, for ``curvature-lut``, ``spreadC`` (xx, yy, zz)
        and ``twistC`` (xy, yz, xz) of S+, for each channel C or for 0 alone; ``leaving``, the
        normal that the camera sees, if not ``facing0``; ``albedo`` where there is one.
    numbers : dict of str to tuple of float
        Constants of the material and the model by the name of their uniform.
    table : ndarray of float32, shape=(3, samples), or None
        For ``curvature-lut``: psi by channel at equal steps of x = b/(b + |a|/HALF), 0 to 1.
    """

    session: Session
    model: str
    directional: bool
    by_channel: bool
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

    @property
    def hinges(self) -> int:
        """Look-ups for each light and channel."""
        return len(self.numbers.get("glowCorners", ())) // 3


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
    if session.shadows != "off":
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
    from plugins.shading.curvature_lut import CurvatureLut

    model = pipeline.settled(session, session.model, axes)
    inputs = pipeline.inputs(session, axes)
    seen, bent = inputs.detail, isinstance(model, CurvatureLut)
    attributes: dict[str, SingleArray] = {}
    if seen is None:
        attributes["facing0"] = _single(inputs.normals)
    else:
        attributes["leaving"] = _single(pipeline.curvatures(session).normals)
        attributes |= {f"facing{c}": _single(seen.normals[c]) for c in range(3)}
    if bent:
        for channel, shape in enumerate((inputs.shape,) if seen is None else seen.shape):
            attributes[f"spread{channel}"] = _single(shape[:, :3])
            attributes[f"twist{channel}"] = _single(shape[:, 3:])
    color = albedo(pipeline.subject(session)) if session.albedo else None
    if color is not None:
        attributes["albedo"] = _single(color)
    table = inputs.table
    return PixelLook(
        session,
        session.model.name,
        getattr(model, "fresnel", "") == "directional",
        seen is not None,
        attributes,
        {"glowEta": tuple(table.eta)} | _numbers(model, table),
        _table(table) if bent else None,
    )


def _single(values: FloatArray) -> SingleArray:
    return np.ascontiguousarray(values, dtype=np.float32)


def _table(table: "PsiTable") -> SingleArray:
    x = np.linspace(0.0, 1.0, _SAMPLES)
    psi = np.zeros((3, _SAMPLES))
    # Below the horizon there is the glow alone; at x = 0 it has ended.
    kappa = x[1:, None] / HALF / table.mean_free_path
    glow = table.evaluate(x[1:, None] - 1.0, kappa) / table.total
    psi[:, 1:] = HALF * np.diagonal(glow, axis1=1, axis2=2).T / x[1:]
    return _single(psi)


def _numbers(model: "ShadingModel", table: "PsiTable") -> dict[str, tuple[float, ...]]:
    from lutcore.fresnel import hinges_of
    from plugins.shading.curvature_lut import CurvatureLut
    from plugins.shading.lambert import Lambert

    if isinstance(model, CurvatureLut):
        corners, weights = hinges_of(table.eta, model.hinges)
        # E2 of the model per (2 (k1^2 + k2^2) + (k1 + k2)^2), mm^2.
        area = table.mean_square * table.mean_free_path**2 / 16.0
        return {
            "glowTotal": tuple(table.total),
            "glowArea": tuple(area if model.area == "curved" else np.zeros(3)),
            "glowLength": tuple(table.mean_free_path),
            "glowSteps": tuple(table.inverse_step),
            "glowCorners": tuple(corners.ravel()),
            "glowWeights": tuple(weights.ravel()),
        }
    assert isinstance(model, Lambert)
    entering = 1.0 if model.fresnel == "directional" else table.entering
    return {"glowTotal": tuple(table.total * entering)}


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
