"""The normalised profile of Christensen and Burley 2015."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.diffusion import DiffusionProfile, Optics, profile_registry
from lutcore.fresnel import transmittance
from lutcore.halfspace import flat_albedo
from lutcore.parameters import choice

_NODES = 32
# The trapezoidal rule for Ki_1 converges as exp(-pi^2/step); 1/cosh 40 is below rounding.
_STEP, _END = 0.25, 40.0


@profile_registry.register("burley2015")
@dataclass(frozen=True)
class Burley2015(DiffusionProfile):
    """Two exponentials over the distance, fitted to Monte Carlo.

    R(r) = A s (exp(-s r) + exp(-s r/3))/(8 pi r), eq. 3 of [1]_ in units of l_u. The scale s
    follows from the albedo A of the surface and the mean free path: eq. 6, s = 1.9 - A +
    3.5 (A - .8)^2, for light that enters from all sides, or eq. 5, s = 1.85 - A + 7 |A - .8|^3,
    for a beam straight down.

    The profile integrates to A, so A must be what R_d is here: the share of diffuse light that
    leaves, of that which entered. It is taken from the same alpha' and eta as the other
    profiles use, by solving the flat half-space exactly (`lutcore.halfspace`). [1]_ instead has
    artists choose A.

    R(r) is infinite at r = 0, like 1/r. Without absorption its width stays finite.

    References
    ----------
    .. [1] P. H. Christensen and B. Burley, "Approximate Reflectance Profiles for Efficient
       Subsurface Scattering", Pixar Technical Memo 15-04, 2015.
    """

    knots = 512  # psi'' grows like -log u towards 0

    source: str = choice(
        "diffuse",
        ("diffuse", "searchlight"),
        "Light that the profile was fitted for: from all sides, or one beam straight down.",
    )

    def radial(self, r: FloatArray, optics: Optics) -> FloatArray:
        """Return R(r): eq. 3.

        Parameters
        ----------
        r : ndarray
            Distance along the surface, l_u, above 0.
        optics : Optics
            Constants of the channel.

        Returns
        -------
        ndarray
            Of the shape of `r`.
        """
        A, s = self.total(optics), self._scale(optics)
        return A * s / (8.0 * np.pi * r) * (np.exp(-s * r) + np.exp(-s * r / 3.0))

    def line_spread(self, x: FloatArray, optics: Optics) -> FloatArray:
        """Return g(x) = A s/(4 pi) (K0(s x) + K0(s x/3)).

        Parameters
        ----------
        x : ndarray
            Distance from the line, l_u, above 0.
        optics : Optics
            Constants of the channel.

        Returns
        -------
        ndarray
            Of the shape of `x`.
        """
        from scipy.special import k0

        A, s = self.total(optics), self._scale(optics)
        return np.asarray(A * s / (4.0 * np.pi) * (k0(s * x) + k0(s * x / 3.0)))

    def total(self, optics: Optics) -> float:
        """Return R_d, the albedo A of diffuse light that entered a flat half-space.

        Parameters
        ----------
        optics : Optics
            Constants of the channel.

        Returns
        -------
        float
            A, 0 to 1; exact.
        """
        return _albedo(optics.albedo, optics.eta)

    def tails(self, knots: FloatArray, optics: Optics) -> tuple[FloatArray, FloatArray]:
        """Return L0 and L1, in which K0 leaves Bickley's Ki_1(s u) and u K1(s u).

        Parameters
        ----------
        knots : ndarray, shape=(n,)
            Values of u in l_u, ascending.
        optics : Optics
            Constants of the channel.

        Returns
        -------
        tuple of ndarray, shape=(n,)
            L0 and L1 at the knots, less what lies beyond the last.
        """
        A, s = self.total(optics), self._scale(optics)
        L0 = _bickley(s * knots) + 3.0 * _bickley(s * knots / 3.0)
        L1 = (_first(s * knots) + 9.0 * _first(s * knots / 3.0)) / s
        return A / (4.0 * np.pi) * (L0 - L0[-1]), A / (4.0 * np.pi) * (L1 - L1[-1])

    def _scale(self, optics: Optics) -> float:
        A = self.total(optics)
        if self.source == "diffuse":
            return 1.9 - A + 3.5 * (A - 0.8) ** 2  # eq. 6
        return 1.85 - A + 7.0 * abs(A - 0.8) ** 3  # eq. 5


@lru_cache(maxsize=256)
def _albedo(albedo: float, eta: float) -> float:
    x, weights = np.polynomial.legendre.leggauss(_NODES)
    c = 0.5 * (x + 1.0)
    entering = weights * c * transmittance(c, eta)
    return float(np.sum(entering * flat_albedo(c, Optics(albedo, eta))) / np.sum(entering))


def _bickley(x: FloatArray) -> FloatArray:
    """Return Ki_1(x), the integral of K0 from x on: int_0^inf exp(-x cosh t)/cosh t dt."""
    t = np.arange(0.0, _END, _STEP)
    weights = np.full(len(t), _STEP)
    weights[0] *= 0.5
    return np.asarray(np.exp(-x[:, None] * np.cosh(t)) @ (weights / np.cosh(t)))


def _first(x: FloatArray) -> FloatArray:
    """Return x K1(x), which is 1 at 0."""
    from scipy.special import k1

    safe = np.where(x > 0.0, x, 1.0)
    return np.where(x > 0.0, safe * k1(safe), 1.0)
