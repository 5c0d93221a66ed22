"""The flat body solved without chance: transport with isotropic scattering and Fresnel's boundary.

Chandrasekhar's H function reflects what meets a half-space from inside its own boundary; the
boundary sends a part of what comes back down again. One linear equation over the cosine inside
joins the two.
"""

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from lutcore.arrays import FloatArray, finite
from lutcore.diffusion import Optics
from lutcore.errors import ParameterError
from lutcore.fresnel import transmittance

_NODES = 24  # on each side of the critical angle; twice as many change nothing above 1e-8
_H_NODES, _H_END = 120, 3.2  # of the trapezoidal rule for H: to 1e-10


@lru_cache(maxsize=1)
def _angles() -> tuple[FloatArray, FloatArray, FloatArray]:
    # k = tan t folds the endless integral over k into t from 0 to 90 degrees. tanh-sinh nodes
    # crowd at both ends: at 0 the integrand of H grows like log k without absorption, at 90
    # degrees it is as narrow as mu. Returned are t, its complement, and weights.
    x = np.linspace(-_H_END, _H_END, _H_NODES)
    y = 0.5 * np.pi * np.sinh(x)
    weights = 0.25 * np.pi**2 * np.cosh(x) / (2.0 * np.cosh(y) ** 2) * (x[1] - x[0])
    return 0.5 * np.pi / (1.0 + np.exp(-2.0 * y)), 0.5 * np.pi / (1.0 + np.exp(2.0 * y)), weights


def _unit_nodes(count: int) -> tuple[FloatArray, FloatArray]:
    x, weights = np.polynomial.legendre.leggauss(count)
    return 0.5 * (x + 1.0), 0.5 * weights


def h_function(mu: ArrayLike, albedo: float) -> FloatArray:
    """Return Chandrasekhar's H(mu) of isotropic scattering.

    Parameters
    ----------
    mu : array_like
        Cosine, 0 to 1.
    albedo : float
        Single-scattering albedo, 0 to 1.

    Returns
    -------
    ndarray
        H, of the shape of `mu`: 1 or more.

    References
    ----------
    .. [1] S. Chandrasekhar, "Radiative Transfer", 1950, chapter V: the explicit integral
       ln H(mu) = -(mu/pi) int_0^inf ln(1 - albedo arctan(k)/k)/(1 + mu^2 k^2) dk.
    """
    cosine = np.asarray(mu, dtype=np.float64)[..., None]
    t, complement, weights = _angles()
    # 1 - albedo arctan(k)/k, from 1 - t/tan t = t^2/3 + t^4/45 + ... where that would cancel.
    short = t * t / 3.0 * (1.0 + t * t / 15.0)
    rest = np.where(t < 1e-3, short, 1.0 - t * np.tan(complement))
    logarithm = np.log((1.0 - albedo) + albedo * rest)
    # dk/(1 + mu^2 k^2) = dt/(cos^2 t + mu^2 sin^2 t).
    kernel = 1.0 / (np.sin(complement) ** 2 + (cosine * np.sin(t)) ** 2)
    return np.exp(-cosine[..., 0] / np.pi * np.sum(weights * logarithm * kernel, axis=-1))


@lru_cache(maxsize=256)
def _solved(optics: Optics) -> tuple[FloatArray, FloatArray]:
    # f(mu0), the share of light entering at mu0 that leaves in the end, obeys
    #   f(mu0) = int_0^1 K(mu0, mu) [1 - R(mu) + R(mu) f(mu)] dmu,
    #   K = alpha'/2 H(mu0) H(mu) mu/(mu + mu0):
    # it comes back to the surface at mu, and there leaves or starts again. Nystroem's method;
    # nodes and the weighted brackets H(mu) mu [...] are returned.
    eta = optics.eta
    critical = np.sqrt(1.0 - 1.0 / eta**2)
    c, weights = _unit_nodes(_NODES)
    # Beyond the critical angle R is 1; before it, smooth in the cosine c outside.
    leaving = np.sqrt(critical**2 + (c / eta) ** 2)
    # The tiny number only decides 0/0, at index one, where no angle is critical.
    mu = np.concatenate((critical * c + 1e-300, leaving))
    measure = np.concatenate((critical * weights, weights * c / (eta**2 * leaving)))
    reflected = np.concatenate((np.ones(_NODES), 1.0 - transmittance(c, eta)))
    H = h_function(mu, optics.albedo)
    flux = measure * H * mu
    kernel = 0.5 * optics.albedo * H[:, None] * flux / (mu[:, None] + mu)
    left = kernel @ (1.0 - reflected)
    f = np.linalg.solve(np.eye(len(mu)) - kernel * reflected, left)
    return mu, flux * (1.0 - reflected + reflected * f)


def flat_albedo(cosine: ArrayLike, optics: Optics) -> FloatArray:
    """Return the share of light that leaves a flat surface, of that which entered.

    Parameters
    ----------
    cosine : array_like
        Cosine of the angle of incidence outside, 0 to 1.
    optics : Optics
        Reduced albedo and refractive index; scattering is isotropic.

    Returns
    -------
    ndarray
        rho, 0 to 1, of the shape of `cosine`. The exitance per irradiance is F_t rho.

    Raises
    ------
    ParameterError
        If a cosine is out of range or not finite.
    """
    c = finite("cosine", cosine)
    if (c < 0.0).any() or (c > 1.0).any():
        raise ParameterError(f"cosine = {cosine!r} is outside its range 0 to 1")
    nodes, brackets = _solved(optics)
    entering = np.sqrt(1.0 - (1.0 - c * c) / optics.eta**2)[..., None]
    K = h_function(entering[..., 0], optics.albedo)[..., None] * brackets / (nodes + entering)
    return 0.5 * optics.albedo * K.sum(axis=-1)
