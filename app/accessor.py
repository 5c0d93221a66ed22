"""``mesh.curvelight`` on every `pyvista.PolyData`, found by PyVista through its entry point."""

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, get_args

import numpy as np
import pyvista

from app import export
from app.session import FIGURE_LIGHTS, Shadows
from lutcore.arrays import FloatArray, finite
from lutcore.color import auto_exposure
from lutcore.diffusion import DiffusionProfile
from lutcore.errors import ParameterError
from lutcore.lights import DirectionalLight, Light
from lutcore.materials import Material
from lutcore.mesh import TriangleMesh

if TYPE_CHECKING:
    from lutcore.shading import ShadingInputs


@pyvista.register_dataset_accessor("curvelight", pyvista.PolyData)
class CurvelightAccessor:
    """Curvature and translucent shading of a PyVista surface.

    Parameters
    ----------
    data : pyvista.PolyData
        The surface. Polygons are triangulated for computing; points keep their order.

    Examples
    --------
    >>> import pyvista
    >>> ball = pyvista.Sphere(radius=10.0)
    >>> curved = ball.curvelight.curvature()
    >>> bool(abs(curved["mean_curvature"].mean() - 0.1) < 0.002)
    True
    """

    def __init__(self, data: pyvista.PolyData) -> None:
        self._data = data

    def curvature(
        self, method: str = "auto", scale: float | FloatArray | None = None, **parameters: Any
    ) -> pyvista.PolyData:
        """Return a copy of the surface with its curvature as point data.

        Parameters
        ----------
        method : str
            A curvature estimator; see `lutcore.estimators`.
        scale : float or ndarray, shape=(n,), optional
            Length to average over, mesh units, for all points or for each; chosen by the
            estimator if not given.
        **parameters : object
            Parameters of the estimator.

        Returns
        -------
        pyvista.PolyData
            With k1, k2, d1, d2, mean_curvature, gauss_curvature, shape_index, curvedness,
            curvature_error (of both), k1_error and k2_error, in 1/mesh unit: convex is positive,
            k1 >= k2; and curvature_scale, mesh units.

        Raises
        ------
        lutcore.MeshError
            If there is no surface.
        lutcore.ParameterError
            If a name or a value is not accepted.
        """
        from lutcore.estimation import principal_curvatures

        curvatures = principal_curvatures(self._mesh(), method, scale, **parameters)
        return self._with(export.curvature_arrays(curvatures))

    def shade(
        self,
        material: Material | str = "skin1",
        lights: Sequence[Light] | None = None,
        model: str = "curvature-lut",
        mm_per_unit: float = 1.0,
        *,
        profile: DiffusionProfile | str = "jensen2001",
        shadows: Shadows | None = None,
        method: str = "auto",
        scale: float | None = None,
        exposure: float | None = None,
        **parameters: Any,
    ) -> pyvista.PolyData:
        """Return a copy of the surface shaded as a translucent material.

        Parameters
        ----------
        material : Material or str
            A material, or the name of one; see `lutcore.materials`.
        lights : sequence of lights, optional
            Those of the paper's Figure 1 if not given: strong from the right (+x), weak from the
            left, for a mesh that faces +z.
        model : str
            A shading model, see `lutcore.shading_models`, or ``auto`` for the cheapest that
            suffices.
        mm_per_unit : float
            Size of a mesh unit, mm.
        profile : DiffusionProfile or str
            How light spreads in the material, or its name; see `lutcore.diffusion_profiles`.
        shadows : {"off", "on", "auto"}, optional
            Whether the surface casts shadows on itself, ``auto`` where they change much; if not
            given, ``auto`` for the model ``auto`` and ``off`` for others.
        method : str
            A curvature estimator.
        scale : float, optional
            Length that curvature is averaged over, mesh units, for all channels; if not given,
            `auto` gives each channel the detail that its light sees (`lutcore.detail_seen`).
        exposure : float, optional
            Factor before encoding; brings the brightest parts near white if not given.
        **parameters : object
            Parameters of the shading model.

        Returns
        -------
        pyvista.PolyData
            With shading (float32, linear radiant exitance) and shading_srgb (uint8): draw it with
            ``plot(scalars="shading_srgb", rgb=True, lighting=False)``.

        Raises
        ------
        lutcore.MeshError
            If there is no surface.
        lutcore.ParameterError
            If a name or a value is not accepted.
        """
        from app.costs import measured
        from lutcore.detail import detail_seen
        from lutcore.estimation import principal_curvatures
        from lutcore.exitance import exitance
        from lutcore.parameters import create
        from lutcore.shading import AUTO, model_registry, shading_inputs

        if shadows is None:
            shadows = "auto" if model == AUTO else "off"
        if shadows not in get_args(Shadows):
            raise ParameterError.unknown("shadows", shadows, get_args(Shadows))
        mesh = self._mesh()
        per_unit = float(finite("mm_per_unit", mm_per_unit, ()))
        if per_unit <= 0.0:
            raise ParameterError(f"mm_per_unit = {mm_per_unit!r} must be above 0")
        plugin = create(model_registry.get(model), f"shading model {model!r}", parameters)
        detail = None
        if scale is None and method == "auto":
            detail = detail_seen(mesh, material, per_unit, profile=profile)
            scale = detail.scale
        curvatures = principal_curvatures(mesh, method, scale)
        chosen = _default_lights() if lights is None else lights
        if model == AUTO:
            measured()
        inputs = shading_inputs(
            mesh, curvatures, material, chosen, per_unit, profile=profile, detail=detail
        )
        if shadows != "off" and len(inputs.lights):
            inputs = _shadowed(mesh, inputs, shadows, plugin.local)
        light = exitance(plugin, inputs)
        factor = auto_exposure(light) if exposure is None else exposure
        return self._with(export.shading_arrays(light, factor))

    def _mesh(self) -> TriangleMesh:
        triangles = self._data if self._data.is_all_triangles else self._data.triangulate()
        faces = triangles.regular_faces if triangles.n_cells else np.empty((0, 3), dtype=int)
        return TriangleMesh(triangles.points, faces)

    def _with(self, arrays: export.Arrays) -> pyvista.PolyData:
        result = self._data.copy()
        result.point_data.update(arrays)
        return result


def _shadowed(
    mesh: TriangleMesh, inputs: "ShadingInputs", shadows: Shadows, local: bool
) -> "ShadingInputs":
    """Return the scene with the lights that reach each vertex, softened if a model may be local."""
    from lutcore.visibility import forecast, softened, visibility

    # As `app.steps.visibility`, which keeps each step.
    assert inputs.curvatures is not None
    normals = inputs.curvatures.normals
    if shadows == "auto" and not forecast(mesh, normals, inputs.lights).needed:
        return inputs
    seen = visibility(mesh, inputs.lights)
    table = inputs.table
    glow = table.mean_free_path * table.psi[:, 0] / inputs.mm_per_unit
    return replace(inputs, visibility=seen, softened=softened(seen, mesh, glow) if local else None)


def _default_lights() -> list[Light]:
    return [DirectionalLight(light.direction, light.irradiance) for light in FIGURE_LIGHTS]
