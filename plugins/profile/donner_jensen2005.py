"""The multipole of Donner and Jensen 2005: a slab that light also leaves at the back."""

from dataclasses import dataclass

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.diffusion import DiffusionProfile, Optics, profile_registry
from lutcore.errors import ParameterError
from lutcore.parameters import param

# Share of R_d that the dipoles left out would take back.
_LEFT_OUT = 1e-12
# Without absorption R_d needs endlessly many, R(r) does not: what is left out of R(0) then is below
# 1e-9 R(0), because the dipoles fall as the third power of their distance.
_LEAST_BETA = 5e-4


@profile_registry.register("donner-jensen2005")
@dataclass(frozen=True)
class DonnerJensen2005(DiffusionProfile):
    """Dipoles mirrored at both faces of a slab, with nothing behind it.

    The sources of the dipole lie, in l_u, at the depths 1 + i P and at the heights
    B - i P, i = -n to n, P = 2 (d + 2 z_b) for the thickness d and z_b = (B - 1)/2; those beyond
    the faces count negative: the multipole of [1]_, of which eq. 37 and 45 of [2]_, which it cites,
    are the places and the sum. The 2 n + 1 dipoles are as many as leave out less than 1e-12 of R_d.
    A thick slab is the dipole of `jensen2001`.

    Diffusion needs a slab of at least one mean free path.

    References
    ----------
    .. [1] C. Donner and H. W. Jensen, "Light Diffusion in Multi-Layered Translucent Materials",
       SIGGRAPH 2005.
    .. [2] D. Contini, F. Martelli and G. Zaccanti, "Photon migration through a turbid slab
       described by a model based on diffusion approximation. I. Theory", Applied Optics 36(19),
       1997.
    """

    thickness: float = param(20.0, 0.01, 10000.0, "mm", "Thickness of the slab.")

    def radial(self, r: FloatArray, optics: Optics) -> FloatArray:
        """Return R(r), the dipole's eq. 4 summed over all sources.

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

        Raises
        ------
        ParameterError
            If the slab is thinner than the mean free path.
        """
        beta, profile = optics.beta, np.zeros_like(r)
        for z in self._sources(optics):
            d = np.hypot(z, r)
            profile += z * (1.0 + beta * d) * np.exp(-beta * d) / d**3
        return optics.albedo / (4.0 * np.pi) * profile

    def line_spread(self, x: FloatArray, optics: Optics) -> FloatArray:
        """Return g(x) = alpha'/(4 pi) sum over the sources of 2 z beta K1(beta d)/d.

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

        Raises
        ------
        ParameterError
            If the slab is thinner than the mean free path.
        """
        from scipy.special import k1

        spread = np.zeros_like(x)
        for z in self._sources(optics):
            d = np.hypot(z, x)
            spread += 2.0 * z * optics.beta * k1(optics.beta * d) / d
        return optics.albedo / (4.0 * np.pi) * spread

    def total(self, optics: Optics) -> float:
        """Return R_d of all dipoles, a geometric series; exact also without absorption.

        Parameters
        ----------
        optics : Optics
            Constants of the channel.

        Returns
        -------
        float
            alpha'/2 sum over z in {1, B} of sinh(beta (P/2 - z))/sinh(beta P/2).

        Raises
        ------
        ParameterError
            If the slab is thinner than the mean free path.
        """
        beta, half = optics.beta, 0.5 * self._period(optics)
        if beta * half < 1e-8:
            shares = [1.0 - z / half for z in (1.0, optics.depth)]
        else:
            shares = [
                np.exp(-beta * z)
                * np.expm1(-2.0 * beta * (half - z))
                / np.expm1(-2.0 * beta * half)
                for z in (1.0, optics.depth)
            ]
        return float(0.5 * optics.albedo * sum(shares))

    def _period(self, optics: Optics) -> float:
        if self.thickness < optics.mean_free_path:
            raise ParameterError(
                f"thickness = {self.thickness!r} mm is less than one mean free path, "
                f"{optics.mean_free_path:.3g} mm, of this material: diffusion does not hold there"
            )
        # z_b is the same at both faces: nothing but the outside is behind them.
        return 2.0 * self.thickness / optics.mean_free_path + 2.0 * (optics.depth - 1.0)

    def _sources(self, optics: Optics) -> FloatArray:
        """Signed depths of all sources: a negative one counts negative."""
        period, beta = self._period(optics), max(optics.beta, _LEAST_BETA)
        # Dipoles i and -i together take alpha' exp(-i beta P) (sinh beta + sinh beta B) from R_d.
        taken = float(np.sinh(beta) + np.sinh(beta * optics.depth)) / -np.expm1(-beta * period)
        share = taken * optics.albedo / self.total(optics)
        count = int(np.ceil(max(np.log(share / _LEFT_OUT), 0.0) / (beta * period)))
        shifts = period * np.arange(-count, count + 1)
        return np.concatenate((1.0 + shifts, optics.depth - shifts))
