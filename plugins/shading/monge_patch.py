"""The exact quadratic patch."""

from dataclasses import dataclass

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray
from lutcore.baking import glowing
from lutcore.compiled import compiled
from lutcore.convexity import bending, invariants
from lutcore.diffusion import optics
from lutcore.lights import light_at
from lutcore.lut import BLOCK
from lutcore.monge import LIMIT, bake_monge, round_at, set_powers, terms_at
from lutcore.prediction import Knowledge, Scene
from lutcore.shading import ShadingInputs, ShadingModel, model_registry


@model_registry.register("monge-patch")
@dataclass(frozen=True)
class MongePatch(ShadingModel):
    """M = sum over lights of E int R(|x - y|) c(y) F_t(c(y)) dA(y) over z = -(k1 x^2 + k2 y^2)/2.

    Eq. 10 of [1]_ over the patch of its eq. 1, with the true normal, area and distance in space
    where [1]_ goes on with their first order, and with F_t inside. Concave curvature is 0 as in
    section 3 of [1]_: without occlusion a bowl would glow like a bump.

    The integral is a table of four arguments (`lutcore.monge`): within 1e-4 R_d of it where
    sqrt((k1^2 + k2^2)/2) is below .1/l_d, 2e-3 below .5/l_d, 1e-2 beyond, and constant from 2/l_u
    on; on umbilics within 1e-5 everywhere. It takes about a second a channel to bake, once. Holds
    for radii above 3 l_d: where light goes further, a parabola is no longer the surface. Costs some
    25 times Lambert with F_t(N.w).

    References
    ----------
    .. [1] K. Kolchin, "Curvature-Based Shading of Translucent Materials, such as Human Skin",
       GRAPHITE 2007.
    """

    def shade(self, inputs: ShadingInputs) -> FloatArray:
        """Compute what leaves the surface; see `ShadingModel.shade`."""
        tables = [bake_monge(inputs.profile, glowing(c)) for c in optics(inputs.material)]
        table = inputs.table
        return _exitance(
            inputs.points,
            inputs.normals,
            inputs.shape,
            inputs.lights,
            table.total,
            table.mean_free_path,
            table.eta,
            np.stack([channel.round_.coefficients for channel in tables]),
            np.array([channel.round_.scale for channel in tables]),
            tables[0].round_.limit,
            np.stack([channel.terms for channel in tables]),
            np.array([channel.scale for channel in tables]),
        )

    def predicted_error(self, scene: Scene) -> FloatArray:
        """Predict how wrong it is; see `ShadingModel.predicted_error`."""
        return scene.error_of(Knowledge(scene.entering, second=0.0, higher=1.5, residue=0.03))


@compiled(parallel=True)
def _exitance(
    points: FloatArray,
    normals: FloatArray,
    shape: FloatArray,
    lights: FloatArray,
    total: FloatArray,
    length: FloatArray,
    eta: FloatArray,
    round_: FloatArray,
    round_scale: FloatArray,
    round_limit: float,
    terms: FloatArray,
    scale: FloatArray,
) -> FloatArray:
    out = np.zeros((len(points), 3))
    for block in prange((len(points) + BLOCK - 1) // BLOCK):
        powers = np.empty(terms.shape[3])
        for i in range(block * BLOCK, min((block + 1) * BLOCK, len(points))):
            trace, squares = invariants(shape, i)
            curvature = np.sqrt(0.5 * squares)
            # The tiny numbers only decide 0/0, where the terms are 0.
            p = min(max(2.0 - trace * trace / (squares + 1e-300), 0.0), 1.0)
            for light in range(len(lights)):
                x, y, z, strength = light_at(
                    lights, light, points[i, 0], points[i, 1], points[i, 2]
                )
                a = normals[i, 0] * x + normals[i, 1] * y + normals[i, 2] * z
                bend = bending(shape, i, x, y, z)
                sine = np.sqrt(max(1.0 - a * a, 0.0))
                set_powers(p, min(bend / (curvature * sine + 1e-300), np.sqrt(2.0)), powers)
                reach = np.sqrt(bend * bend + (a * curvature) ** 2)
                for c in range(3):
                    if lights[light, 8 + c] == 0.0:
                        continue
                    s = min(length[c] * curvature, LIMIT)
                    e = reach * (s / (curvature + 1e-300))
                    value = round_at(a, e, round_[c], round_scale[c], round_limit, eta[c])
                    value += terms_at(a, s, terms[c], scale[c], powers)
                    out[i, c] += lights[light, 8 + c] * strength * total[c] * max(value, 0.0)
    return out
