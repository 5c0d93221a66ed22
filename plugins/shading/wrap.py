"""Wrap lighting."""

from dataclasses import dataclass

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled
from lutcore.lights import light_at
from lutcore.parameters import param
from lutcore.prediction import COSINES, Knowledge, Scene
from lutcore.shading import ShadingInputs, ShadingModel, model_registry


@model_registry.register("wrap")
@dataclass(frozen=True)
class Wrap(ShadingModel):
    """M = sum over lights of E R_d <F_t> max(0, (N.w + width)/(1 + width)).

    A picture of translucency without physics: the same glow on flat and curved parts, and 1 + width
    times the light that Lambert gives out (section 16.2 of [1]_ has no normalisation). With width 0
    it is Lambert.

    References
    ----------
    .. [1] S. Green, "Real-Time Approximations to Subsurface Scattering", GPU Gems, chapter 16,
       2004.
    """

    width: float = param(0.2, 0.0, 1.0, "", "How far light reaches around: N.w at its end is -w.")

    def shade(self, inputs: ShadingInputs) -> FloatArray:
        """Compute what leaves the surface; see `ShadingModel.shade`."""
        table = inputs.table
        total = table.total * table.entering
        return _wrap(inputs.points, inputs.normals, inputs.lights, total, self.width)

    def predicted_error(self, scene: Scene) -> FloatArray:
        """Predict how wrong it is; see `ShadingModel.predicted_error`."""
        wrapped = np.maximum(0.0, (COSINES + self.width) / (1.0 + self.width))
        flat = scene.table.entering[:, None] * wrapped
        return scene.error_of(Knowledge(flat, bend="none"))


@compiled(parallel=True)
def _wrap(
    points: FloatArray, normals: FloatArray, lights: FloatArray, total: FloatArray, width: float
) -> FloatArray:
    out = np.zeros((len(points), 3))
    for i in prange(len(points)):
        for light in range(len(lights)):
            x, y, z, strength = light_at(lights, light, points[i, 0], points[i, 1], points[i, 2])
            cosine = normals[i, 0] * x + normals[i, 1] * y + normals[i, 2] * z
            factor = strength * max((cosine + width) / (1.0 + width), 0.0)  # [1], section 16.2
            for channel in range(3):
                out[i, channel] += lights[light, 8 + channel] * total[channel] * factor
    return out
