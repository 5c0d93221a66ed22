"""Diffusion profiles: how far light spreads under a flat surface, and what tables need of it.

All lengths are in units of the mean free path l_u of the channel.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.errors import ParameterError
from lutcore.fresnel import virtual_depth
from lutcore.materials import Material
from lutcore.parameters import Parameters
from lutcore.registry import Registry

_PANEL_NODES = 16
_WHOLE_PANELS = 200
# psi < _TAIL beyond a profile's reach: a hundred times below what 128 samples resolve.
_TAIL = 1e-9
_ENDLESS = 1e9


@dataclass(frozen=True)
class Optics:
    """Optical constants of one channel of a material.

    Parameters
    ----------
    albedo : float
        Reduced albedo alpha' = sigma_s'/(sigma_s' + sigma_a), above 0 to 1.
    eta : float
        Refractive index relative to the outside.
    """

    albedo: float
    eta: float

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
    red, green, blue = (Optics(float(albedo), material.eta) for albedo in material.albedo)
    return red, green, blue


@dataclass(frozen=True)
class DiffusionProfile(Parameters, ABC):
    """Base of every profile plug-in: only the line spread must be given.

    What follows from the line spread by quadrature here, a profile may override with its closed
    form. The line spread must be positive, finite at 0 and, in the end, decay exponentially.
    """

    @abstractmethod
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

    def total(self, optics: Optics) -> float:
        """Return the diffuse reflectance of the flat surface, R_d = 2 int_0^inf g dx.

        Parameters
        ----------
        optics : Optics
            Constants of the channel.

        Returns
        -------
        float
            R_d, 0 to 1.
        """
        return 2.0 * float(self.tails(self._whole(optics), optics)[0][0])

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
        knots = self._whole(optics)
        x, weights = _panels(knots)
        moment = np.sum(weights * x * x * self.line_spread(x, optics))
        return 4.0 * float(moment) / self.total(optics)

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
        # psi(u) R_d < u^2 g(u) where g falls faster than 1/u^3, and R_d is at least about g(0) l_u:
        # no source lies less deep than that.
        peak = float(self.line_spread(np.zeros(1), optics)[0])

        def small(u: float) -> bool:
            return float(self.line_spread(np.array([u]), optics)[0]) * u * u < _TAIL * peak

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

    def _whole(self, optics: Optics) -> FloatArray:
        return np.sinh(np.linspace(0.0, np.arcsinh(self.reach(optics)), _WHOLE_PANELS))


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
