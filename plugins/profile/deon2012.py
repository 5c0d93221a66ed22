"""The better dipole of d'Eon 2012."""

from dataclasses import dataclass

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.diffusion import DiffusionProfile, Optics, profile_registry
from lutcore.fresnel import internal_moments


@profile_registry.register("deon2012")
@dataclass(frozen=True)
class DEon2012(DiffusionProfile):
    """A dipole with Grosjean's diffusion coefficient and exitance from fluence and flux.

    In units of l_u, with the moments C1 and C2 of Fresnel's internal reflectance taken exactly:

    - D = (2 - alpha')/3 and mu = sqrt((1 - alpha')/D), Grosjean's;
    - sources at depth 1 and at height B = 1 + 4 A D, A = (1 + 3 C2)/(1 - 2 C1);
    - R(r) = alpha'^2/(4 pi) [C_phi/D (e_1/d_1 - e_B/d_B) + C_E sum_z z (1 + mu d_z) e_z/d_z^3],
      d_z = sqrt(z^2 + r^2), e_z = exp(-mu d_z), C_phi = (1 - 2 C1)/4, C_E = (1 - 3 C2)/2.

    Light that was scattered only once is not in it, hence alpha'^2: where little is scattered R_d
    is low. Without absorption R_d is 1.

    References
    ----------
    .. [1] E. d'Eon, "A Better Dipole", technical report, 2012.
    """

    def radial(self, r: FloatArray, optics: Optics) -> FloatArray:
        """Return R(r), as written above.

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
        of = _Constants.of(optics)
        near, far = np.hypot(1.0, r), np.hypot(of.B, r)
        apart = (of.B**2 - 1.0) / (near + far)
        # exp(-mu near)/near - exp(-mu far)/far, which would cancel far away.
        phi = np.exp(-of.mu * near) / far * (apart / near - np.expm1(-of.mu * apart))
        flux = sum(
            z * (1.0 + of.mu * d) * np.exp(-of.mu * d) / d**3 for z, d in ((1.0, near), (of.B, far))
        )
        return optics.albedo**2 / (4.0 * np.pi) * (of.C_phi / of.D * phi + of.C_E * flux)

    def line_spread(self, x: FloatArray, optics: Optics) -> FloatArray:
        """Return g(x): exp(-mu d)/d becomes 2 K0, and (1 + mu d) exp(-mu d)/d^3 2 mu K1/d.

        Parameters
        ----------
        x : ndarray
            Distance from the line, l_u.
        optics : Optics
            Constants of the channel; there must be absorption.

        Returns
        -------
        ndarray
            Of the shape of `x`.
        """
        from scipy.special import k0, k1

        of = _Constants.of(optics)
        near, far = np.hypot(1.0, x), np.hypot(of.B, x)
        phi = 2.0 * (k0(of.mu * near) - k0(of.mu * far))
        flux = 2.0 * of.mu * (k1(of.mu * near) / near + of.B * k1(of.mu * far) / far)
        spread = of.C_phi / of.D * phi + of.C_E * flux
        return np.asarray(optics.albedo**2 / (4.0 * np.pi) * spread)

    def total(self, optics: Optics) -> float:
        """Return R_d; exact also without absorption.

        Parameters
        ----------
        optics : Optics
            Constants of the channel.

        Returns
        -------
        float
            alpha'^2/2 exp(-mu) [C_phi/(D mu) (1 - q) + C_E (1 + q)], q = exp(-4 A D mu).
        """
        of = _Constants.of(optics)
        q = float(np.exp(-of.mu * (of.B - 1.0)))
        # (1 - q)/mu, B - 1 without absorption.
        length = (1.0 - q) / of.mu if of.mu > 1e-8 else of.B - 1.0
        bracket = of.C_phi / of.D * length + of.C_E * (1.0 + q)
        return float(0.5 * optics.albedo**2 * np.exp(-of.mu) * bracket)


@dataclass(frozen=True)
class _Constants:
    D: float
    mu: float
    B: float
    C_phi: float
    C_E: float

    @classmethod
    def of(cls, optics: Optics) -> "_Constants":
        C1, C2 = internal_moments(optics.eta)
        D = (2.0 - optics.albedo) / 3.0
        A = (1.0 + 3.0 * C2) / (1.0 - 2.0 * C1)
        return cls(
            D=D,
            mu=float(np.sqrt((1.0 - optics.albedo) / D)),
            B=1.0 + 4.0 * A * D,
            C_phi=0.25 * (1.0 - 2.0 * C1),
            C_E=0.5 * (1.0 - 3.0 * C2),
        )
