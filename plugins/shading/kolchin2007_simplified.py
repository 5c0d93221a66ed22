"""The paper's method as its section 4 and figure 1 used it."""

from dataclasses import dataclass

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray
from lutcore.baking import samples_parameter
from lutcore.compiled import compiled
from lutcore.convexity import invariants
from lutcore.lights import light_at
from lutcore.lut import BLOCK, even_forms
from lutcore.prediction import Knowledge, Scene
from lutcore.shading import ShadingInputs, ShadingModel, model_registry


@model_registry.register("kolchin2007-simplified")
@dataclass(frozen=True)
class Kolchin2007Simplified(ShadingModel):
    """M = sum over lights of E <F_t> p(w3, l_u sqrt((1 - w3^2)(k1^2 + k2^2)/2)): section 4 of [1]_.

    The light's azimuth is ignored; on a sphere that changes nothing. Concave curvature is 0
    (section 3), so that k1 and k2 here are those that are clamped.

    Spheres of short radius make light as with `kolchin2007`. The slips of the printed text are the
    same: "k1 l_d, k2 l_d >> 1" for "<< 1"; the factor alpha'/(4 pi^2) before p for alpha'/(4 pi);
    and convex curvature is negative there.

    References
    ----------
    .. [1] K. Kolchin, "Curvature-Based Shading of Translucent Materials, such as Human Skin",
       GRAPHITE 2007.
    """

    samples: int = samples_parameter()

    def shade(self, inputs: ShadingInputs) -> FloatArray:
        """Compute what leaves the surface; see `ShadingModel.shade`."""
        table = inputs.baked(self.samples)
        arguments = (inputs.points, inputs.normals, inputs.shape, inputs.lights)
        total = table.total * table.entering
        return _exitance(*arguments, total, table.mean_free_path, table.rows, table.inverse_step)

    def predicted_error(self, scene: Scene) -> FloatArray:
        """Predict how wrong it is; see `ShadingModel.predicted_error`."""
        return scene.error_of(Knowledge(scene.mean_entering, bend="rms", anisotropy=1.0))


@compiled(parallel=True)
def _exitance(
    points: FloatArray,
    normals: FloatArray,
    shape: FloatArray,
    lights: FloatArray,
    total: FloatArray,
    length: FloatArray,
    rows: FloatArray,
    steps: FloatArray,
) -> FloatArray:
    out = np.zeros((len(points), 3))
    corner, weight = np.zeros(1), np.ones(1)  # no Fresnel factor inside the integral
    for block in prange((len(points) + BLOCK - 1) // BLOCK):
        first = block * BLOCK
        count = min(BLOCK, len(points) - first)
        cosine, kappa, strength = np.empty(count), np.empty(count), np.empty(count)
        for light in range(len(lights)):
            for k in range(count):
                i = first + k
                x, y, z, strength[k] = light_at(
                    lights, light, points[i, 0], points[i, 1], points[i, 2]
                )
                cosine[k] = normals[i, 0] * x + normals[i, 1] * y + normals[i, 2] * z
                squares = invariants(shape, i)[1]
                kappa[k] = np.sqrt(max(1.0 - cosine[k] * cosine[k], 0.0) * 0.5 * squares)
            for c in range(3):
                if lights[light, 8 + c] == 0.0:
                    continue
                p = even_forms(weight, corner, cosine, kappa, length[c], rows, steps, c)
                for k in range(count):
                    out[first + k, c] += lights[light, 8 + c] * strength[k] * total[c] * p[k]
    return out
