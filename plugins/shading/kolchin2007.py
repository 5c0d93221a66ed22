"""The paper's method in full, as its section 5 asks for."""

from dataclasses import dataclass

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray
from lutcore.baking import samples_parameter
from lutcore.compiled import compiled
from lutcore.convexity import bending
from lutcore.lights import light_at
from lutcore.lut import BLOCK, even_forms
from lutcore.prediction import Knowledge, Scene
from lutcore.shading import ShadingInputs, ShadingModel, model_registry


@model_registry.register("kolchin2007")
@dataclass(frozen=True)
class Kolchin2007(ShadingModel):
    """M = sum over lights of E <F_t> p(w3, l_u sqrt(w1^2 k1^2 + w2^2 k2^2)): eq. 11 of [1]_.

    <F_t> stands outside the integral as printed. Concave curvature is 0 (section 3). The radicand
    is |S+ w_t|^2, so that no principal direction is needed.

    A first order has its end: a sphere whose radius is well below l_u gives out pi psi(0)
    l_u/radius times what Lambert's does, all of it glow, and is dark where the light stands
    overhead. A large one gives out 1 + E2 times as much; see `curvature-lut`.

    Read around these slips of the printed text:

    - "k1 l_d, k2 l_d >> 1" before eq. 10 must be "<< 1": the radii are much greater than l_d.
    - The factor of p must be alpha'/(4 pi): with the 1/pi of eq. 6 it gives the alpha'/(4 pi^2) of
      eq. 11. The alpha'/(4 pi^2) printed before p counts 1/pi twice.
    - Convex curvature is negative in the paper; here it is positive, and min(k, 0) is max(k, 0).

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
        return scene.error_of(Knowledge(scene.mean_entering))


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
                kappa[k] = bending(shape, i, x, y, z)
            for c in range(3):
                if lights[light, 8 + c] == 0.0:
                    continue
                p = even_forms(weight, corner, cosine, kappa, length[c], rows, steps, c)
                for k in range(count):
                    out[first + k, c] += lights[light, 8 + c] * strength[k] * total[c] * p[k]
    return out
