"""What leaves the apex of a quadratic patch, by quadrature of any diffusion profile."""

from dataclasses import dataclass

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled
from lutcore.diffusion import DiffusionProfile, Optics
from lutcore.fresnel import compiled_transmittance
from lutcore.spline import spline_coefficients, spline_weights

_NODES, _ARC_NODES = 6, 8
_SMALLEST = 0.05
_RADII, _GRAIN = 400, 1e-3
_LEAST = 1e-200


@dataclass(frozen=True, eq=False)
class Radial:
    """The logarithm of a radial profile per R_d, as a spline over log(1 + r/_GRAIN).

    Parameters
    ----------
    coefficients : ndarray, shape=(knots + 2,)
        Of the spline.
    reach : float
        Distance of the last knot, l_u; nothing is left beyond.
    """

    coefficients: FloatArray
    reach: float

    @classmethod
    def of(cls, profile: DiffusionProfile, optics: Optics) -> "Radial":
        """Sample a profile.

        Parameters
        ----------
        profile : DiffusionProfile
            The profile.
        optics : Optics
            Constants of the channel.

        Returns
        -------
        Radial
            Within 1e-7 of the profile where it is not negligible.
        """
        reach = profile.reach(optics)
        # Not from 0, where a profile may be infinite: nodes of the quadrature stay clear of it.
        v = np.linspace(0.0, np.log1p(reach / _GRAIN), _RADII)
        r = np.maximum(_GRAIN * np.expm1(v), 1e-3 * _GRAIN)
        share = profile.radial(r, optics) / profile.total(optics)
        return cls(spline_coefficients(np.log(np.maximum(share, _LEAST)), 0), reach)


def on_patch(k: FloatArray, w: FloatArray, radial: Radial, eta: float) -> FloatArray:
    """Return the exitance at the apex of z = -(k1 x^2 + k2 y^2)/2 per R_d, F_t inside.

    With the true normal, area and distance in space; nothing is occluded.

    Parameters
    ----------
    k : ndarray, shape=(n, 2)
        l_u x principal curvatures.
    w : ndarray, shape=(n, 3)
        Unit vectors to the light, along the principal directions and the normal.
    radial : Radial
        The profile.
    eta : float
        Refractive index.

    Returns
    -------
    ndarray, shape=(n,)
        Per unit normal irradiance.
    """
    count = 2 + int(np.log2(radial.reach / _SMALLEST))
    panels = np.concatenate(([0.0], np.geomspace(_SMALLEST, radial.reach, count)))
    node, weight = np.polynomial.legendre.leggauss(_NODES)
    arc, share = np.polynomial.legendre.leggauss(2 * _ARC_NODES)
    half_arc = (arc[_ARC_NODES:], share[_ARC_NODES:])
    last = np.log1p(radial.reach / _GRAIN)
    return _integrals(k, w, eta, radial.coefficients, last, panels, node, weight, *half_arc)


@compiled()
def _share(distance: float, coefficients: FloatArray, last: float) -> float:
    knots = len(coefficients) - 3
    v = np.log(1.0 + distance / _GRAIN) / last * knots
    if v >= knots:
        return 0.0
    i, c0, c1, c2, c3 = spline_weights(v, knots)
    logarithm = c0 * coefficients[i] + c1 * coefficients[i + 1]
    logarithm += c2 * coefficients[i + 2] + c3 * coefficients[i + 3]
    share: float = np.exp(logarithm)
    return share


@compiled(parallel=True)
def _integrals(
    k: FloatArray,
    w: FloatArray,
    eta: float,
    coefficients: FloatArray,
    last: float,
    panels: FloatArray,
    node: FloatArray,
    weight: FloatArray,
    arc: FloatArray,
    share: FloatArray,
) -> FloatArray:
    out = np.zeros(len(k))
    for i in prange(len(k)):
        k1, k2, a = k[i, 0], k[i, 1], w[i, 2]
        gx, gy = k1 * w[i, 0], k2 * w[i, 1]
        b = np.hypot(gx, gy)
        cosine, sine = (gx / b, gy / b) if b > 0.0 else (1.0, 0.0)
        edge = min(abs(a) / (b + 1e-300), panels[-1])  # where the lit arc changes form
        ends = np.sort(np.append(panels, edge))
        for panel in range(len(panels)):
            low, high = ends[panel], ends[panel + 1]
            half = 0.5 * (high - low)
            for n in range(len(node)):
                r = 0.5 * (low + high) + half * node[n]
                if a <= -b * r:
                    continue
                lit = np.pi if a >= b * r else np.arccos(-a / (b * r))
                total = 0.0
                for m in range(len(arc)):
                    # Two directions at once, on both sides of that in which c grows fastest.
                    along, across = np.cos(lit * arc[m]), np.sin(lit * arc[m])
                    slope = max(a + b * r * along, 0.0)
                    for side in (-1.0, 1.0):
                        x = r * (cosine * along + side * sine * across)
                        y = r * (sine * along - side * cosine * across)
                        height = 0.5 * (k1 * x * x + k2 * y * y)
                        stretch = np.sqrt(1.0 + (k1 * x) ** 2 + (k2 * y) ** 2)
                        flux = _share(np.sqrt(r * r + height * height), coefficients, last)
                        c = min(slope / stretch, 1.0)
                        total += share[m] * flux * slope * compiled_transmittance(c, eta)
                out[i] += half * weight[n] * r * lit * total
    return out
