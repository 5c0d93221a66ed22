"""Fresnel transmittance of a dielectric seen from outside, its means, and its hinge fit.

Inside an integral over a curved neighbourhood the transmittance varies with the angle of light.
Writing c F_t(c) as a sum of hinges w_j max(0, c - c_j) keeps it there at the cost of a few
look-ups of one table, because each hinge is Lambert's cosine shifted by c_j.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import TypeVar

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled
from lutcore.keeping import kept

N = TypeVar("N", float, FloatArray)
# Gauss-Legendre in the cosine converges to rounding error well before 200 nodes for eta >= 1.01.
_NODES = 200
# The best knots crowd where c F_t(c) bends most, near 0; the fit starts from knots (j/J)^power.
_START_POWERS = (1.5, 2.0, 2.5, 3.0)


def transmittance(cosine: N, eta: float) -> N:
    """Return the unpolarised Fresnel transmittance F_t for light from outside.

    Parameters
    ----------
    cosine : float or ndarray
        Cosine of the angle of incidence, 0 to 1.
    eta : float
        Refractive index relative to the outside, 1 or more.

    Returns
    -------
    float or ndarray
        Share of the light that enters, 0 to 1.
    """
    inside = np.sqrt(1.0 - (1.0 - cosine * cosine) / (eta * eta))
    # The tiny number only decides 0/0, at grazing incidence on a medium of index one.
    crossing = (cosine - eta * inside) / (cosine + eta * inside + 1e-300)
    parallel = (eta * cosine - inside) / (eta * cosine + inside + 1e-300)
    entering: N = 1.0 - 0.5 * (crossing * crossing + parallel * parallel)
    return entering


compiled_transmittance = compiled()(transmittance)
"""`transmittance` of one cosine, for use in compiled code."""


@compiled()
def transmittances(cosine: float, eta: FloatArray) -> tuple[float, float, float]:
    """Return `transmittance` by channel, for use in compiled code.

    Parameters
    ----------
    cosine : float
        Cosine of the angle of incidence, 0 to 1.
    eta : ndarray, shape=(3,)
        Refractive index of each channel: where they are equal, it costs as much as one.

    Returns
    -------
    tuple of 3 floats
        Share of the light that enters, 0 to 1.
    """
    red = compiled_transmittance(cosine, eta[0])
    if eta[0] == eta[1] and eta[0] == eta[2]:
        return red, red, red
    return red, compiled_transmittance(cosine, eta[1]), compiled_transmittance(cosine, eta[2])


def leaving_to(
    place: FloatArray, points: FloatArray, normals: FloatArray, eta: FloatArray
) -> FloatArray:
    """Return the transmittance of light that leaves points of a surface for a place.

    A surface seen from behind, through a hole, counts as its front would.

    Parameters
    ----------
    place : ndarray, shape=(3,)
        Where the light goes to.
    points, normals : ndarray, shape=(n, 3)
        Where it leaves, and the unit normals there.
    eta : ndarray, shape=(c,)
        Refractive indices.

    Returns
    -------
    ndarray, shape=(n, c)
        0 to 1.
    """
    out = np.empty((len(points), len(eta)))
    _leave_to(place, points, normals, eta, out)
    return out


def leaving_along(direction: FloatArray, normals: FloatArray, eta: FloatArray) -> FloatArray:
    """Return the transmittance of light that leaves a surface in one direction.

    Parameters
    ----------
    direction : ndarray, shape=(3,)
        A unit vector.
    normals, eta
        As for `leaving_to`.

    Returns
    -------
    ndarray, shape=(n, c)
        0 to 1.
    """
    out = np.empty((len(normals), len(eta)))
    _leave_along(direction, normals, eta, out)
    return out


@compiled(parallel=True)
def _leave_to(
    place: FloatArray, points: FloatArray, normals: FloatArray, eta: FloatArray, out: FloatArray
) -> None:
    for i in prange(len(points)):
        x, y, z = place[0] - points[i, 0], place[1] - points[i, 1], place[2] - points[i, 2]
        length = np.sqrt(x * x + y * y + z * z)
        _leaving(out, i, normals, x / length, y / length, z / length, eta)


@compiled(parallel=True)
def _leave_along(
    direction: FloatArray, normals: FloatArray, eta: FloatArray, out: FloatArray
) -> None:
    for i in prange(len(normals)):
        _leaving(out, i, normals, direction[0], direction[1], direction[2], eta)


@compiled()
def _leaving(
    out: FloatArray, i: int, normals: FloatArray, x: float, y: float, z: float, eta: FloatArray
) -> None:
    cosine = abs(normals[i, 0] * x + normals[i, 1] * y + normals[i, 2] * z)
    for index in range(len(eta)):
        out[i, index] = compiled_transmittance(cosine, eta[index])


def _nodes() -> tuple[FloatArray, FloatArray]:
    x, weights = np.polynomial.legendre.leggauss(_NODES)
    return 0.5 * (x + 1.0), 0.5 * weights


@lru_cache(maxsize=256)
def mean_transmittance(eta: float) -> float:
    """Return <F_t> = 2 int_0^1 F_t(mu) mu dmu, the paper's average of F_t.

    Parameters
    ----------
    eta : float
        Refractive index relative to the outside, 1 or more.

    Returns
    -------
    float
        Share of diffuse light that enters: .9389 at 1.3, .9082 at 1.5.
    """
    mu, weights = _nodes()
    return float(2.0 * np.sum(weights * mu * transmittance(mu, eta)))


@lru_cache(maxsize=256)
def internal_moments(eta: float) -> tuple[float, float]:
    """Return the moments C1 = int_0^1 R mu dmu and C2 = int_0^1 R mu^2 dmu from inside.

    Parameters
    ----------
    eta : float
        Refractive index relative to the outside, 1 or more.

    Returns
    -------
    tuple of float
        Of the reflectance R(mu) of light that meets the surface from inside. 2 C1 is the exact
        value of what `internal_reflectance` fits.
    """
    # Only light inside the critical angle leaves, and as much as enters the other way: with the
    # cosine c outside, mu^2 = 1 - (1 - c^2)/eta^2 and mu dmu = c dc/eta^2.
    c, weights = _nodes()
    leaving = weights * c * transmittance(c, eta) / eta**2
    mu = np.sqrt(1.0 - (1.0 - c * c) / eta**2)
    return float(0.5 - np.sum(leaving)), float(1.0 / 3.0 - np.sum(leaving * mu))


def internal_reflectance(eta: float) -> float:
    """Return F_dr, the share of diffuse light that the surface reflects back inside.

    Parameters
    ----------
    eta : float
        Refractive index relative to the outside, 1 or more.

    Returns
    -------
    float
        The rational fit of Jensen et al. 2001, section 2.1.
    """
    return -1.440 / eta**2 + 0.710 / eta + 0.668 + 0.0636 * eta


def virtual_depth(eta: float) -> float:
    """Return the paper's B = 1 + 4 A/3, the depth of the dipole's virtual source in l_u.

    Parameters
    ----------
    eta : float
        Refractive index relative to the outside, 1 or more.

    Returns
    -------
    float
        B, with A = (1 + F_dr)/(1 - F_dr) of Jensen et al. 2001, section 2.2.
    """
    reflected = internal_reflectance(eta)
    return 1.0 + 4.0 / 3.0 * (1.0 + reflected) / (1.0 - reflected)


@dataclass(frozen=True, eq=False)
class Hinges:
    """A fit c F_t(c) ~ sum_j w_j max(0, c - c_j).

    Parameters
    ----------
    corners : ndarray, shape=(count,)
        c_j, ascending, the first 0.
    weights : ndarray, shape=(count,)
        w_j.
    error : float
        Largest absolute error for c in 0 to 1.
    """

    corners: FloatArray
    weights: FloatArray
    error: float


def _ramps(cosine: FloatArray, inner: FloatArray) -> FloatArray:
    corners = np.concatenate(([0.0], np.sort(inner)))
    return np.maximum(0.0, cosine[:, None] - corners)


@kept
def hinges(eta: float, count: int) -> Hinges:
    """Fit c F_t(c) by hinges, in least squares over c from 0 to 1.

    Parameters
    ----------
    eta : float
        Refractive index relative to the outside, 1 or more.
    count : int
        Number of hinges, 1 or more.

    Returns
    -------
    Hinges
        The same object for the same arguments. Error .0037 for eta 1.3 and 4 hinges.
    """
    from scipy.optimize import least_squares

    cosine, measure = _nodes()
    root = np.sqrt(measure)
    target = cosine * transmittance(cosine, eta)

    def weights_for(inner: FloatArray) -> FloatArray:
        ramps = _ramps(cosine, inner) * root[:, None]
        return np.asarray(np.linalg.lstsq(ramps, target * root)[0])

    def residual(inner: FloatArray) -> FloatArray:
        return (_ramps(cosine, inner) @ weights_for(inner) - target) * root

    inner = np.empty(0)
    if count > 1:
        fits = [
            least_squares(residual, (np.arange(1, count) / count) ** power, bounds=(1e-4, 0.9999))
            for power in _START_POWERS
        ]
        inner = np.sort(min(fits, key=lambda fit: float(fit.cost)).x)
    weights = weights_for(inner)
    dense = np.linspace(0.0, 1.0, 4001)
    error = np.abs(_ramps(dense, inner) @ weights - dense * transmittance(dense, eta)).max()
    return Hinges(np.concatenate(([0.0], inner)), weights, float(error))


def hinges_of(eta: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
    """Fit c F_t(c) by hinges for each channel of a material.

    Parameters
    ----------
    eta : ndarray, shape=(3,)
        Refractive index of each channel.
    count : int
        Number of hinges, 1 or more.

    Returns
    -------
    corners, weights : ndarray, shape=(3, count)
        Those of `hinges`, one row for each channel.
    """
    fits = [hinges(float(index), count) for index in eta]
    return np.stack([fit.corners for fit in fits]), np.stack([fit.weights for fit in fits])
