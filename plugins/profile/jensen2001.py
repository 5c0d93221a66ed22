"""The dipole of Jensen et al. 2001."""

from dataclasses import dataclass

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.diffusion import DiffusionProfile, Optics, profile_registry


@profile_registry.register("jensen2001")
@dataclass(frozen=True)
class Jensen2001(DiffusionProfile):
    """Diffusion from a real source at depth 1 and a virtual one at height B, in l_u.

    The radial profile is R(r) = alpha'/(4 pi) sum over z in {1, B} of
    z (1 + beta d) exp(-beta d)/d^3 with d = sqrt(z^2 + r^2) (eq. 4 of [1]_, in units of l_u).

    References
    ----------
    .. [1] H. W. Jensen, S. R. Marschner, M. Levoy and P. Hanrahan, "A Practical Model for
       Subsurface Light Transport", SIGGRAPH 2001.
    """

    def radial(self, r: FloatArray, optics: Optics) -> FloatArray:
        """Return R(r): eq. 4.

        Parameters
        ----------
        r : ndarray
            Distance along the surface, l_u.
        optics : Optics
            Constants of the channel.

        Returns
        -------
        ndarray
            Of the shape of `r`.
        """
        beta, profile = optics.beta, np.zeros_like(r)
        for z in (1.0, optics.depth):
            d = np.hypot(z, r)
            profile += z * (1.0 + beta * d) * np.exp(-beta * d) / d**3
        return optics.albedo / (4.0 * np.pi) * profile

    def line_spread(self, x: FloatArray, optics: Optics) -> FloatArray:
        """Return g(x) = alpha'/(4 pi) sum over z in {1, B} of 2 z beta K1(beta d)/d.

        Parameters
        ----------
        x : ndarray
            Distance from the line, l_u.
        optics : Optics
            Constants of the channel; beta must not be 0.

        Returns
        -------
        ndarray
            Of the shape of `x`.
        """
        from scipy.special import k1

        spread = np.zeros_like(x)
        for z in (1.0, optics.depth):
            d = np.sqrt(z * z + x * x)
            spread += 2.0 * z * optics.beta * k1(optics.beta * d) / d
        return optics.albedo / (4.0 * np.pi) * spread

    def total(self, optics: Optics) -> float:
        """Return R_d = alpha'/2 (exp(-beta) + exp(-B beta)); exact also without absorption.

        Parameters
        ----------
        optics : Optics
            Constants of the channel.

        Returns
        -------
        float
            R_d, 0 to 1.
        """
        beta, B = optics.beta, optics.depth
        return float(0.5 * optics.albedo * (np.exp(-beta) + np.exp(-B * beta)))

    def mean_square(self, optics: Optics) -> float:
        """Return <r^2> = (2/beta)(exp(-beta) + B exp(-B beta))/(exp(-beta) + exp(-B beta)).

        Parameters
        ----------
        optics : Optics
            Constants of the channel; beta must not be 0.

        Returns
        -------
        float
            <r^2>, l_u^2.
        """
        beta, B = optics.beta, optics.depth
        real, virtual = np.exp(-beta), np.exp(-B * beta)
        return float(2.0 / beta * (real + B * virtual) / (real + virtual))
