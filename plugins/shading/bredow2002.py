"""Wrap lighting by angle, as RenderMan shaders had it."""

from dataclasses import dataclass

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled
from lutcore.lights import light_at
from lutcore.parameters import param
from lutcore.prediction import COSINES, Knowledge, Scene
from lutcore.shading import ShadingInputs, ShadingModel, model_registry


@model_registry.register("bredow2002")
@dataclass(frozen=True)
class Bredow2002(ShadingModel):
    """M = sum over lights of E R_d <F_t> max(0, 1 - theta/angle), theta between N and w.

    Light falls off evenly with the angle and ends where the user says, beyond 90 degrees. It is
    Lambert at no angle, not at 90 degrees either. Curvature and material do not matter to it.

    The course notes [1]_, which Kolchin 2007 cites for wrap lighting, have that angle as a control
    of each light ("Falloff End (Wrap)", 90 degrees being Lambert) but print no formula; this one is
    that of the wrapped diffuse shader [2]_ of the same summer. More wrap is more light, as [1]_
    warns: a sphere gives out 2 (1 - sin(angle)/angle) times what Lambert's does, at 110 degrees
    1.02 times.

    References
    ----------
    .. [1] R. Bredow, "Renderman on Film", SIGGRAPH 2002, course 16.
    .. [2] ZJ, "Wrapped Diffuse Lighting Model", zj.deathfall.com, 24 August 2002.
    """

    angle: float = param(110.0, 90.0, 180.0, "degrees", "Angle from the light where it ends.")

    def shade(self, inputs: ShadingInputs) -> FloatArray:
        """Compute what leaves the surface; see `ShadingModel.shade`."""
        table = inputs.table
        total = table.total * table.entering
        return _wrapped(inputs.points, inputs.normals, inputs.lights, total, np.radians(self.angle))

    def predicted_error(self, scene: Scene) -> FloatArray:
        """Predict how wrong it is; see `ShadingModel.predicted_error`."""
        wrapped = np.maximum(0.0, 1.0 - np.arccos(COSINES) / np.radians(self.angle))
        flat = scene.table.entering[:, None] * wrapped
        return scene.error_of(Knowledge(flat, bend="none"))


@compiled(parallel=True)
def _wrapped(
    points: FloatArray, normals: FloatArray, lights: FloatArray, total: FloatArray, angle: float
) -> FloatArray:
    out = np.zeros((len(points), 3))
    for i in prange(len(points)):
        for light in range(len(lights)):
            x, y, z, strength = light_at(lights, light, points[i, 0], points[i, 1], points[i, 2])
            cosine = normals[i, 0] * x + normals[i, 1] * y + normals[i, 2] * z
            theta = np.arccos(min(max(cosine, -1.0), 1.0))
            factor = strength * max(1.0 - theta / angle, 0.0)
            for channel in range(3):
                out[i, channel] += lights[light, 8 + channel] * total[channel] * factor
    return out
