"""Truth by quadrature: the paper's double integral, and the dipole over a whole sphere.

Nothing here uses the even form that the tables rest on.
"""

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from lutcore.diffusion import Optics
from lutcore.fresnel import transmittance

FloatArray = NDArray[np.float64]


def paper_integral(a: float, b: float, beta: float) -> float:
    """Integrate the paper's I(a, b, beta) of section 3, without <F_t>, adaptively in x1 and x2.

    The half plane a + b x1 > 0 is integrated as printed.
    """
    from scipy.integrate import quad

    def over_x2(x1: float) -> float:
        # x2 = s sinh v makes the integrand decay doubly exponentially; below exp(-60) it is cut.
        s = math.sqrt(1.0 + x1 * x1)
        last = 1.0 + math.acosh(max(60.0 / (beta * s), 1.0))

        def integrand(v: float) -> float:
            d = s * math.cosh(v)  # sqrt(1 + x1^2 + x2^2), also dx2/dv
            return (beta + 1.0 / d) * math.exp(-beta * d) / d

        return 2.0 * float(quad(integrand, 0.0, last, epsabs=1e-13, epsrel=1e-10)[0])

    def over_x1(x1: float) -> float:
        return (a + b * x1) * over_x2(x1)

    start = -a / b
    # Split at 0, where the integrand peaks, so that the adaptive rule cannot miss it.
    ends = [start, 0.0, math.inf] if start < 0.0 else [start, math.inf]
    pairs = pairwise(ends)
    return sum(
        quad(over_x1, low, high, epsabs=1e-10, epsrel=1e-9, limit=200)[0] for low, high in pairs
    )


def paper_factor(a: float, b: float, optics: Optics) -> float:
    """Return alpha'/(4 pi) J(a, b), J = I(a, b, beta) + I(a, B b, B beta)."""
    beta, B = optics.beta, optics.depth
    J = paper_integral(a, b, beta) + paper_integral(a, B * b, B * beta)
    return optics.albedo / (4.0 * math.pi) * J


def paper_psi(u: float, optics: Optics, total: float) -> float:
    """Return psi(u) from the dark side, p(-u, 1) = R_d psi(u): nothing is subtracted."""
    return paper_factor(-u, 1.0, optics) / total


def sphere_exitance(
    cosines: FloatArray, radius: float, optics: Optics, nodes: int = 24
) -> FloatArray:
    """Integrate the dipole with F_t inside over the lit half of a sphere of `radius` l_u.

    Point by point for light from the pole, `cosines` being N.w: the source point is at the arc
    gamma and azimuth phi around the point, at the distance 2 radius sin(gamma/2).
    """
    return np.array([_sphere_point(float(c), radius, optics, nodes) for c in cosines])


def _sphere_point(cosine: float, radius: float, optics: Optics, nodes: int) -> float:
    theta = math.acos(cosine)
    # The lit azimuths change form where gamma crosses |90 deg - theta| and its supplement; the
    # profile varies on the scale of l_u, hence panels that grow from there.
    edge = abs(0.5 * math.pi - theta)
    graded = np.geomspace(0.1 / radius, math.pi, 40)
    ends = np.unique(np.clip(np.concatenate(([0.0, edge, math.pi - edge], graded)), 0.0, math.pi))
    x, weights = np.polynomial.legendre.leggauss(nodes)
    half = 0.5 * np.diff(ends)[:, None]
    gamma = (0.5 * (ends[1:] + ends[:-1])[:, None] + half * x).ravel()
    measure = (half * weights).ravel() * radius**2 * np.sin(gamma)
    across = math.sin(theta) * np.sin(gamma)
    along = cosine * np.cos(gamma)
    with np.errstate(divide="ignore", invalid="ignore"):
        last = np.arccos(np.clip(-along / across, -1.0, 1.0))
    phi = 0.5 * last[:, None] * (x + 1.0)
    lit = np.clip(along[:, None] + across[:, None] * np.cos(phi), 0.0, 1.0)
    around = last * np.sum(weights * lit * transmittance(lit, optics.eta), axis=1)  # both sides
    return float(np.sum(measure * dipole(2.0 * radius * np.sin(0.5 * gamma), optics) * around))


def dipole(r: FloatArray, optics: Optics) -> FloatArray:
    """Return the radial profile R(r) of Jensen et al. 2001, eq. 4, in units of l_u."""
    beta = optics.beta
    total = np.zeros_like(r)
    for z in (1.0, optics.depth):
        d = np.sqrt(z * z + r * r)
        total += z * (1.0 + beta * d) * np.exp(-beta * d) / d**3
    return optics.albedo / (4.0 * math.pi) * total
