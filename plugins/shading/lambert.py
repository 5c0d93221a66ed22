"""Lambert: light leaves where it entered."""

from dataclasses import dataclass

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled
from lutcore.fresnel import compiled_transmittance
from lutcore.lights import light_at
from lutcore.parameters import choice
from lutcore.prediction import Knowledge, Scene
from lutcore.shading import ShadingInputs, ShadingModel, model_registry


@model_registry.register("lambert")
@dataclass(frozen=True)
class Lambert(ShadingModel):
    """M = sum over lights of E R_d F max(N.w, 0), F being <F_t> or F_t(N.w).

    The limit of every other model on a flat surface: of the paper's models with F = <F_t>, of
    `curvature-lut` with F = F_t(N.w).
    """

    fresnel: str = choice(
        "mean",
        ("mean", "directional"),
        "Transmittance of light that enters: its mean, or that of the light's direction.",
    )

    def shade(self, inputs: ShadingInputs) -> FloatArray:
        """Compute what leaves the surface; see `ShadingModel.shade`."""
        table = inputs.table
        directional = self.fresnel == "directional"
        # Both are arrays that can be written to, which are compiled for apart from others.
        total = table.total * (1.0 if directional else table.entering)
        arguments = (inputs.points, inputs.normals, inputs.lights, total)
        return _lambert(*arguments, table.eta, directional)

    def predicted_error(self, scene: Scene) -> FloatArray:
        """Predict how wrong it is; see `ShadingModel.predicted_error`."""
        flat = scene.mean_entering if self.fresnel == "mean" else scene.entering
        return scene.error_of(Knowledge(flat, bend="none"))

    @classmethod
    def rungs(cls) -> tuple[ShadingModel, ...]:
        """Return both transmittances; see `ShadingModel.rungs`."""
        return cls(), cls(fresnel="directional")


@compiled(parallel=True)
def _lambert(
    points: FloatArray,
    normals: FloatArray,
    lights: FloatArray,
    total: FloatArray,
    eta: FloatArray,
    directional: bool,
) -> FloatArray:
    out = np.zeros((len(points), 3))
    for i in prange(len(points)):
        for light in range(len(lights)):
            x, y, z, strength = light_at(lights, light, points[i, 0], points[i, 1], points[i, 2])
            cosine = normals[i, 0] * x + normals[i, 1] * y + normals[i, 2] * z
            factor = strength * max(cosine, 0.0)
            if directional:
                entering = factor
                for channel in range(3):
                    # Most materials have one index: then its root is taken once.
                    if channel == 0 or eta[channel] != eta[channel - 1]:
                        entering = factor * compiled_transmittance(max(cosine, 0.0), eta[channel])
                    out[i, channel] += lights[light, 8 + channel] * total[channel] * entering
            else:
                for channel in range(3):
                    out[i, channel] += lights[light, 8 + channel] * total[channel] * factor
    return out
