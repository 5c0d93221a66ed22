"""The default model's integral with the physics that the dipole leaves out at first order."""

from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray
from lutcore.baking import BETA_FLOOR, samples_parameter
from lutcore.compiled import compiled
from lutcore.convexity import bending, invariants
from lutcore.diffusion import Optics, optics
from lutcore.entering import bulging, entry_cosines, entry_factors
from lutcore.fresnel import hinges_of
from lutcore.halfspace import flat_albedo
from lutcore.lights import light_at
from lutcore.lut import BLOCK, even_forms
from lutcore.parameters import param
from lutcore.shading import ShadingInputs, ShadingModel, model_registry

# 1/rho is all but quadratic in the inner cosine m and in x: polynomials through Chebyshev's points
# are within 5e-4 of it for all built-in materials, and within 2 % at an index of one.
_COSINES, _BENDS = 3, 5


@model_registry.register("curvature-lut-physical")
@dataclass(frozen=True)
class CurvatureLutPhysical(ShadingModel):
    """`curvature-lut` with exact flat albedo, curvature gain and oblique entry.

    M = sum over lights of E D rho(c', x)/(J (1 + T E2)) sum_j w_j p(c' - c_j, T^(1/2) b)/R_d, where
    p, b, E2 and the hinges are those of `curvature-lut` [1]_ and, in units of l_u, with H the mean
    of the convex curvatures, y = beta/H, L = coth y - 1/y and the inner cosine
    m = sqrt(1 - (1 - c^2)/eta^2):

    - rho, the exact share of light that leaves a flat surface [2]_, stands for R_d.
    - Curvature raises it: in a sphere that glows evenly the fluence falls off behind the surface
      at the rate x beta, x = L, instead of beta, and rho/alpha' is that of a flat body with such a
      beta, of albedo 1 - (x beta)^2/3. By diffusion theory that is, to first order, the factor
      1 + c_H H with c_H = m/(1 + beta m) + (2A/3)/(1 + 2A beta/3).
    - Curvature spreads it: <r^2> is T = y (y/L - 2 - y L) times as large, as follows from how fast
      the fluence in a sphere falls off where the glow is even and where it goes as the cosine.
      T is 1 + 1/y for weak curvature, and y without absorption, where the body ends the glow.
    - Light scatters first at g |w_t| from where it enters, g = 1/(eta (1 + beta m)), away from
      the light. What leaves a place has entered where the normal is N + g S w_t: c' is its cosine,
      and J = (1 + g c' k1)(1 + g c' k2) by how much that displacement widens the surface.
    - Its path lies less deep under a convex surface: D = 1 + beta g^2 w_t.S w_t.

    What is left of the error against a random walk is of second order in curvature: of skin1, red,
    on spheres of 2, 5, 10 and 20 l_d it is 6.0, .6, .2 and .2 %, where the dipole itself,
    integrated over the true sphere, is 28, 15, 10 and 7 % off. Below a radius of 2 l_u, where
    there is no diffusion, a rising light may darken it: at half l_u by a third. Costs about twice
    `curvature-lut`.

    References
    ----------
    .. [1] K. Kolchin, "Curvature-Based Shading of Translucent Materials, such as Human Skin",
       GRAPHITE 2007.
    .. [2] S. Chandrasekhar, "Radiative Transfer", 1950, chapter V; see `lutcore.halfspace`.
    """

    aim: ClassVar[str] = "light transport itself, as a random walk has it"

    hinges: int = param(4, 1, 16, "", "Hinges that stand for the Fresnel transmittance.")
    samples: int = samples_parameter()

    def shade(self, inputs: ShadingInputs) -> FloatArray:
        """Compute what leaves the surface; see `ShadingModel.shade`."""
        table = inputs.baked(self.samples)
        corners, weights = hinges_of(table.eta, self.hinges)
        channels = optics(inputs.material)
        inverse = np.stack([_inverse_albedo(channel) for channel in channels])
        # As for the glow: with less absorption than the floor the two factors cancel.
        beta: FloatArray = np.maximum([channel.beta for channel in channels], BETA_FLOOR)
        area = table.mean_square * table.mean_free_path**2 / 16.0  # of E2, mm^2
        return _exitance(
            inputs.points,
            inputs.normals,
            inputs.shape,
            inputs.lights,
            corners,
            weights,
            inverse,
            beta,
            table.eta,
            area,
            table.mean_free_path,
            table.rows,
            table.inverse_step,
        )


@lru_cache(maxsize=256)
def _inverse_albedo(channel: Optics) -> FloatArray:
    """Return the coefficients of m^i x^k in 1/rho; shape (cosines, bends)."""
    lowest = np.sqrt(1.0 - 1.0 / channel.eta**2)
    inner = lowest + (1.0 - lowest) * _chebyshev(_COSINES)
    # Clipped, because without it the last may be 1e-17 short of the critical angle.
    outer = np.sqrt(np.clip(1.0 - channel.eta**2 * (1.0 - inner**2), 0.0, 1.0))
    bend = _chebyshev(_BENDS)
    values = np.empty((_COSINES, _BENDS))
    for k, x in enumerate(bend):
        flat = Optics(1.0 - (x * channel.beta) ** 2 / 3.0, channel.eta)
        values[:, k] = flat.albedo / (channel.albedo * flat_albedo(outer, flat))
    over_inner = np.linalg.solve(np.vander(inner, increasing=True), values)
    coefficients = np.linalg.solve(np.vander(bend, increasing=True), over_inner.T).T
    return np.ascontiguousarray(coefficients)


def _chebyshev(count: int) -> FloatArray:
    return 0.5 - 0.5 * np.cos(np.pi * (np.arange(count) + 0.5) / count)


@compiled()
def _curved(y: float) -> tuple[float, float]:
    # L(y) and T(y); the first terms of their series where the closed forms would cancel.
    if y < 0.01:
        return y / 3.0 * (1.0 - y * y / 15.0), y * (1.0 - 2.0 / 15.0 * y * y)
    if y > 20.0:
        return 1.0 - 1.0 / y, 1.0 + 1.0 / (y - 1.0)  # coth y is 1
    slower = 1.0 / np.tanh(y) - 1.0 / y
    return slower, y * (y / slower - 2.0 - y * slower)


@compiled()
def _bent(
    trace: FloatArray,
    length: float,
    inverse: FloatArray,
    beta: float,
    wide: FloatArray,
    lost: FloatArray,
) -> None:
    # Writes T, and the powers of x in 1/rho summed, at mean curvatures in 1/l_u.
    x = np.empty(len(trace))
    for k in range(len(trace)):
        x[k], wide[k] = _curved(beta / (0.5 * length * trace[k] + 1e-300))
    for m in range(_COSINES):
        for k in range(len(trace)):
            lost[m, k] = 0.0
        for power in range(_BENDS - 1, -1, -1):
            for k in range(len(trace)):
                lost[m, k] = lost[m, k] * x[k] + inverse[m, power]


@compiled(parallel=True)
def _exitance(
    points: FloatArray,
    normals: FloatArray,
    shape: FloatArray,
    lights: FloatArray,
    corners: FloatArray,
    weights: FloatArray,
    inverse: FloatArray,
    beta: FloatArray,
    eta: FloatArray,
    area: FloatArray,
    length: FloatArray,
    rows: FloatArray,
    steps: FloatArray,
) -> FloatArray:
    out = np.zeros((len(points), 3))
    for block in prange((len(points) + BLOCK - 1) // BLOCK):
        first = block * BLOCK
        count = min(BLOCK, len(points) - first)
        cosine, kappa, strength = np.empty(count), np.empty(count), np.empty(count)
        bulge, trace, squares = np.empty(count), np.empty(count), np.empty(count)
        bend = np.empty(count)
        for k in range(count):
            trace[k], squares[k] = invariants(shape, first + k)
        wide, lost = np.empty((3, count)), np.empty((3, _COSINES, count))
        for c in range(3):
            _bent(trace, length[c], inverse[c], beta[c], wide[c], lost[c])
        for light in range(len(lights)):
            for k in range(count):
                i = first + k
                x, y, z, strength[k] = light_at(
                    lights, light, points[i, 0], points[i, 1], points[i, 2]
                )
                cosine[k] = normals[i, 0] * x + normals[i, 1] * y + normals[i, 2] * z
                kappa[k] = bending(shape, i, x, y, z)
                bulge[k] = bulging(shape, i, x, y, z)
            for c in range(3):
                if lights[light, 8 + c] == 0.0:
                    continue
                entry = entry_cosines(cosine, kappa, bulge, squares, beta[c], eta[c], length[c])
                factor = entry_factors(
                    entry, bulge, trace, squares, lost[c], beta[c], eta[c], length[c]
                )
                for k in range(count):
                    bend[k] = np.sqrt(wide[c, k]) * kappa[k]
                glow = even_forms(weights[c], corners[c], entry, bend, length[c], rows, steps, c)
                for k in range(count):
                    rgb = lights[light, 8 + c] * strength[k]
                    out[first + k, c] += rgb * factor[k] * glow[k]
        for i in range(first, first + count):
            for c in range(3):
                k = i - first
                # 3 k1^2 + 2 k1 k2 + 3 k2^2 = 2 (k1^2 + k2^2) + (k1 + k2)^2.
                second = area[c] * (2.0 * squares[k] + trace[k] * trace[k])
                out[i, c] /= 1.0 + wide[c, k] * second
    return out
