"""Diffusion profiles: how far light spreads under a flat surface, and what tables need of it.

All lengths are in units of the mean free path l_u of the channel.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.errors import ParameterError
from lutcore.fresnel import virtual_depth
from lutcore.materials import Material
from lutcore.parameters import Parameters, create
from lutcore.registry import Registry

_PANEL_NODES = 16
# psi < _TAIL beyond a profile's reach: a hundred times below what 128 samples resolve.
_TAIL = 1e-9
_ENDLESS = 1e9
# The trapezoidal rule in v, r = e^v or y = s sinh(v), converges as exp(-pi^2/step): the integrands
# are analytic for |Im v| < pi/2 whatever the depths of the sources.
_STEP = 0.2
_SCALES = (1e-12, 1.0)


@dataclass(frozen=True)
class Optics:
    """Optical constants of one channel of a material.

    Parameters
    ----------
    albedo : float
        Reduced albedo alpha' = sigma_s'/(sigma_s' + sigma_a), above 0 to 1.
    eta : float
        Refractive index relative to the outside.
    mean_free_path : float
        l_u in mm, for profiles that know lengths of their own; 1 makes their mm lengths in l_u.
    """

    albedo: float
    eta: float
    mean_free_path: float = 1.0

    @property
    def beta(self) -> float:
        """The paper's beta = sqrt(3 (1 - alpha')) = l_u/l_d."""
        return float(np.sqrt(3.0 * (1.0 - self.albedo)))

    @property
    def depth(self) -> float:
        """The paper's B, depth of the dipole's virtual source."""
        return virtual_depth(self.eta)


def optics(material: Material) -> tuple[Optics, Optics, Optics]:
    """Return the optical constants of each channel.

    Parameters
    ----------
    material : Material
        The material.

    Returns
    -------
    tuple of 3 Optics
        Red, green, blue.
    """
    red, green, blue = (
        Optics(float(albedo), eta, float(length))
        for albedo, eta, length in zip(
            material.albedo, material.eta, material.mean_free_path, strict=True
        )
    )
    return red, green, blue


@dataclass(frozen=True)
class DiffusionProfile(Parameters, ABC):
    """Base of every profile plug-in: only the radial profile must be given.

    What follows from it by quadrature here, a profile may override with its closed form. The
    radial profile must be positive, analytic in r > 0, rise less steeply than 1/r^2 towards 0 and
    in the end decay exponentially.
    """

    knots: ClassVar[int] = 64
    """Knots that bring a psi table within 1e-6 of the integral."""

    @abstractmethod
    def radial(self, r: FloatArray, optics: Optics) -> FloatArray:
        """Return R(r), the radiant exitance at r for unit flux that enters at one point.

        Parameters
        ----------
        r : ndarray
            Distance along the flat surface, l_u, above 0.
        optics : Optics
            Constants of the channel.

        Returns
        -------
        ndarray
            Of the shape of `r`, 1/l_u^2; int R dA = R_d.
        """

    def line_spread(self, x: FloatArray, optics: Optics) -> FloatArray:
        """Return g(x) = int R(sqrt(x^2 + y^2)) dy, the radial profile seen edge on.

        Parameters
        ----------
        x : ndarray
            Distance from the line, l_u, 0 or more.
        optics : Optics
            Constants of the channel.

        Returns
        -------
        ndarray
            Of the shape of `x`, 1/l_u.
        """
        v = np.arange(0.0, 50.0, _STEP)
        scale = np.clip(x, *_SCALES)[..., None]
        r = np.hypot(x[..., None], scale * np.sinh(v))
        terms = self.radial(r, optics) * scale * np.cosh(v)
        return 2.0 * _STEP * (np.asarray(terms.sum(axis=-1)) - 0.5 * terms[..., 0])

    def total(self, optics: Optics) -> float:
        """Return the diffuse reflectance of the flat surface, R_d = int R dA.

        Parameters
        ----------
        optics : Optics
            Constants of the channel.

        Returns
        -------
        float
            R_d, 0 to 1.
        """
        return self._moment(2, optics)

    def mean_square(self, optics: Optics) -> float:
        """Return <r^2> = int r^2 R dA / R_d, twice the mean square of the line spread.

        Parameters
        ----------
        optics : Optics
            Constants of the channel.

        Returns
        -------
        float
            <r^2>, l_u^2.
        """
        return self._moment(4, optics) / self.total(optics)

    def reach(self, optics: Optics) -> float:
        """Return where the glow ends: psi is below 1e-9 beyond it.

        Parameters
        ----------
        optics : Optics
            Constants of the channel.

        Returns
        -------
        float
            Distance in l_u.

        Raises
        ------
        ParameterError
            If the line spread does not end.
        """
        # psi(u) R_d < u^2 g(u) where g falls faster than 1/u^3.
        bound = _TAIL * self.total(optics)

        def small(u: float) -> bool:
            return float(self.line_spread(np.array([u]), optics)[0]) * u * u < bound

        high = 1.0
        while not small(high):
            high *= 2.0
            if high > _ENDLESS:
                raise ParameterError(f"this profile has no end at an albedo of {optics.albedo!r}")
        low = 0.5 * high
        for _ in range(20):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if small(middle) else (middle, high)
        return high

    def tails(self, knots: FloatArray, optics: Optics) -> tuple[FloatArray, FloatArray]:
        """Return L0(u) = int_u g dx and L1(u) = int_u x g dx up to the last knot.

        Parameters
        ----------
        knots : ndarray, shape=(n,)
            Values of u in l_u, ascending, spaced evenly in asinh(u).
        optics : Optics
            Constants of the channel.

        Returns
        -------
        tuple of ndarray, shape=(n,)
            L0 and L1 at the knots; 0 at the last.
        """
        x, weights = _panels(knots)
        spread = weights * self.line_spread(x, optics)
        zeroth, first = spread.sum(axis=1), (spread * x).sum(axis=1)
        return _sum_from_end(zeroth), _sum_from_end(first)

    def _moment(self, power: int, optics: Optics) -> float:
        # int r^(power - 2) R dA, in v = log r.
        r = np.exp(np.arange(-36.0, 21.0, _STEP))
        return float(2.0 * np.pi * _STEP * np.sum(r**power * self.radial(r, optics)))


def _panels(knots: FloatArray) -> tuple[FloatArray, FloatArray]:
    # Gauss-Legendre in t = asinh(x) on each panel, where the integrands are smooth and even.
    nodes, weights = np.polynomial.legendre.leggauss(_PANEL_NODES)
    t = np.arcsinh(knots)
    half = 0.5 * np.diff(t)[:, None]
    inner = 0.5 * (t[1:] + t[:-1])[:, None] + half * nodes
    return np.sinh(inner), half * weights * np.cosh(inner)


def _sum_from_end(panels: FloatArray) -> FloatArray:
    return np.concatenate((np.cumsum(panels[::-1])[::-1], [0.0]))


profile_registry: Registry[DiffusionProfile] = Registry(
    "diffusion profile", "plugins.profile", "curvelight.profile"
)
"""The diffusion profiles by name."""


def diffusion_profiles() -> list[str]:
    """Return the names of the diffusion profiles.

    Returns
    -------
    list of str
        Sorted; built-in ones and those that other packages bring.
    """
    return profile_registry.names()


def diffusion_profile(profile: DiffusionProfile | str, **parameters: Any) -> DiffusionProfile:
    """Return a diffusion profile by its name, or the one given.

    Parameters
    ----------
    profile : DiffusionProfile or str
        One of `diffusion_profiles`, or a profile itself.
    **parameters : object
        The parameters of a profile that is named.

    Returns
    -------
    DiffusionProfile
        The profile, its values checked.

    Raises
    ------
    ParameterError
        If the name or a parameter is unknown, a value out of range, or parameters are given to a
        profile that has its own.
    """
    if not isinstance(profile, DiffusionProfile):
        return create(profile_registry.get(profile), f"diffusion profile {profile!r}", parameters)
    if parameters:
        raise ParameterError(f"{type(profile).__name__} already has its parameters")
    return profile
