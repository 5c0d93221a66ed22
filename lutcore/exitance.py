"""What leaves a surface by a shading model, with what is applied to it from outside."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled
from lutcore.curvature import PrincipalCurvatures
from lutcore.detail import Detail
from lutcore.diffusion import DiffusionProfile
from lutcore.lights import Light
from lutcore.materials import Material
from lutcore.mesh import TriangleMesh
from lutcore.parameters import create
from lutcore.progress import Progress, silent
from lutcore.shading import ShadingInputs, ShadingModel, model_registry, shading_inputs


def shade(
    mesh: TriangleMesh,
    curvatures: PrincipalCurvatures,
    material: Material | str,
    lights: Sequence[Light],
    model: str = "curvature-lut",
    mm_per_unit: float = 1.0,
    *,
    normals: ArrayLike | None = None,
    profile: DiffusionProfile | str = "jensen2001",
    progress: Progress = silent,
    visibility: ArrayLike | None = None,
    detail: Detail | None = None,
    **parameters: Any,
) -> FloatArray:
    """Shade a mesh as a translucent body.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface, n vertices.
    curvatures : PrincipalCurvatures
        Of the same vertices.
    material : Material or str
        A material, or the name of a built-in one.
    lights : sequence of DirectionalLight, PointLight or ConeLight
        Any number, also none.
    model : str
        One of `lutcore.shading_models`, or ``auto`` for the cheapest that suffices.
    mm_per_unit : float
        Millimetres in one mesh unit, above 0.
    normals : array_like, shape=(n, 3), optional
        Outward normals of any length to be used instead of those at the curvature's scale.
    profile : DiffusionProfile or str
        How light spreads under a flat surface: a diffusion profile, or the name of one.
    progress : callable
        Told where long work stands; see `lutcore.progress`.
    visibility : array_like, shape=(lights, n) or (lights, n, 3), optional
        Share of each light that reaches each vertex, 0 to 1: cast shadows; see
        `lutcore.visibility`. None if not given.
    detail : Detail, optional
        From `detail_seen` for this mesh, material, profile and size: local models take each
        channel's normals and curvature from it, others its bare normals.
    **parameters : object
        The model's parameters.

    Returns
    -------
    ndarray, shape=(n, 3)
        Radiant exitance, linear RGB, before the exit Fresnel factor and before any exposure; 0 at
        vertices without a normal.

    Raises
    ------
    ParameterError
        If a name is unknown, a value out of range or an array of the wrong length.
    CancelledError
        If `progress` asked to stop.
    """
    chosen = create(model_registry.get(model), f"shading model {model!r}", parameters)
    inputs = shading_inputs(
        mesh,
        curvatures,
        material,
        lights,
        mm_per_unit,
        normals=normals,
        profile=profile,
        progress=progress,
        visibility=visibility,
        detail=detail,
    )
    return exitance(chosen, inputs)


def exitance(model: ShadingModel, inputs: ShadingInputs) -> FloatArray:
    """Run a model, with the shadows that others cast and vertices without a normal dark.

    What a local model gives is a sum over lights, so that cast shadows need nothing of it: each
    light is shaded alone and multiplied by its visibility. And it does not mix channels, so that
    each is shaded alone with the surface as its light sees it, where `inputs.detail` says so. A
    model that is not local blurs detail itself, and gets the bare normals.

    Parameters
    ----------
    model : ShadingModel
        The model.
    inputs : ShadingInputs
        What it may depend on.

    Returns
    -------
    ndarray, shape=(n, 3)
        Radiant exitance, linear RGB, before the exit Fresnel factor.

    Raises
    ------
    CancelledError
        If the progress asked to stop.
    """
    model = model.settled(inputs)
    shares = inputs.shares
    if not model.local:
        out = model.shade(bared(inputs))
    elif model.joint:
        out = model.shade(inputs)
    elif shares is None:
        out = _by_channel(model, inputs)
    else:
        out = np.zeros(inputs.points.shape)
        unshadowed = without_shadows(inputs)
        for light, share in enumerate(shares):
            alone = replace(unshadowed, lights=inputs.lights[light : light + 1])
            out += _by_channel(model, alone) * (share if share.ndim == 2 else share[:, None])
    _darken(out, inputs.normals)
    return out


@compiled()
def _darken(out: FloatArray, normals: FloatArray) -> None:
    """Set to 0 where there is no normal: sooner done than other threads are woken."""
    for i in range(len(out)):
        if normals[i, 0] == 0.0 and normals[i, 1] == 0.0 and normals[i, 2] == 0.0:
            out[i] = 0.0


def bared(inputs: ShadingInputs) -> ShadingInputs:
    """Return what a model gets that blurs detail itself.

    Parameters
    ----------
    inputs : ShadingInputs
        Any.

    Returns
    -------
    ShadingInputs
        With the bare normals of the detail, if it has some.
    """
    seen = inputs.detail
    return inputs if seen is None else replace(inputs, normals=seen.bare, detail=None)


def without_shadows(inputs: ShadingInputs) -> ShadingInputs:
    """Return what a model gets where nothing casts a shadow.

    Parameters
    ----------
    inputs : ShadingInputs
        Any.

    Returns
    -------
    ShadingInputs
        Without visibility.
    """
    return replace(inputs, visibility=None, softened=None)


def _by_channel(model: ShadingModel, inputs: ShadingInputs) -> FloatArray:
    """Run a local model once, or for each channel with what that one's light sees."""
    seen = inputs.detail
    return model.shade(inputs) if seen is None else model.shade_detail(inputs, seen)
