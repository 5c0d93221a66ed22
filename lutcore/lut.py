"""The table behind every curvature-based model: one even function of one variable.

To first order in curvature, a unit normal irradiance from the direction w leaves a surface as

    p(a, b) = R_d [max(a, 0) + b psi(|a|/b)],    R_d psi(u) = L1(u) - u L0(u),

with a = N.w, b = l_u |S+ w_t|, S+ the convex part of the shape operator, L0(u) = int_u^inf g and
L1(u) = int_u^inf x g of the line spread g. That is the paper's integral (section 3), which is
homogeneous in (a, b): Lambert plus a glow that is widest at the terminator.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from lutcore.arrays import AnyArray, BoolArray, FloatArray, finite
from lutcore.compiled import compiled
from lutcore.errors import ParameterError
from lutcore.fresnel import mean_transmittance

BLOCK = 512
"""Vertices that `even_forms` is best given at once: few enough to stay in the first cache."""

_LOG_2 = 0.6931471805599453
_SQRT_HALF_BITS = 0x3FE6A09E667F3BCD


@compiled()
def logarithm(v: float) -> float:
    """Return the natural logarithm, to 5e-13.

    Written out because a call of the C library would keep loops from being vectorised: 1.8 ns a
    value instead of 12.

    Parameters
    ----------
    v : float
        1 or more, finite.

    Returns
    -------
    float
        log v.
    """
    bits = np.float64(v).view(np.int64)
    exponent = (bits - _SQRT_HALF_BITS) >> 52
    m = np.int64(bits - (exponent << 52)).view(np.float64)  # in sqrt(1/2) to sqrt(2)
    s = (m - 1.0) / (m + 1.0)
    q = s * s
    # log m = 2 atanh s.
    series = 1 / 7 + q * (1 / 9 + q * (1 / 11 + q * (1 / 13)))
    return exponent * _LOG_2 + 2.0 * s * (1.0 + q * (1 / 3 + q * (1 / 5 + q * series)))


@compiled()
def _inverse(b: float) -> float:
    # The tiny number only decides 0/0, where the glow is 0 times psi(0).
    return 1.0 / (b + 1e-300)


@compiled()
def _position(u: float, inverse_step: float, last: float) -> float:
    position = logarithm(u + np.sqrt(u * u + 1.0)) * inverse_step  # asinh(u)
    # Written so that NaN, too, ends inside the table.
    return position if position < last else last


@compiled()
def _psi(position: float, rows: FloatArray, channel: int) -> float:
    segment = int(position)
    t = position - segment
    cubic = rows[channel, segment, 2] + t * rows[channel, segment, 3]
    psi: float = rows[channel, segment, 0] + t * (rows[channel, segment, 1] + t * cubic)
    return psi


@compiled()
def even_form(
    a: float, b: float, rows: FloatArray, inverse_step: FloatArray, channel: int
) -> float:
    """Return max(a, 0) + b psi(|a|/b), the exitance per R_d and unit normal irradiance.

    Parameters
    ----------
    a : float
        Cosine of the angle of light, N.w.
    b : float
        l_u |S+ w_t|, 0 or more.
    rows : ndarray, shape=(3, samples, 4)
        `PsiTable.rows`.
    inverse_step : ndarray, shape=(3,)
        `PsiTable.inverse_step`.
    channel : int
        0, 1 or 2.

    Returns
    -------
    float
        The even form; Lambert's max(a, 0) where the glow is below 1e-9.
    """
    u = abs(a) * _inverse(b)
    position = _position(u, inverse_step[channel], rows.shape[1] - 1.0)
    return max(a, 0.0) + b * _psi(position, rows, channel)


@compiled()
def even_forms(
    weights: FloatArray,
    corners: FloatArray,
    cosine: FloatArray,
    kappa: FloatArray,
    length: float,
    rows: FloatArray,
    inverse_step: FloatArray,
    channel: int,
) -> FloatArray:
    """Return sum_j weight_j even_form(cosine - corner_j, length x kappa) for a block of vertices.

    Several times as fast as calling `even_form` for each, and the same to the last bit.

    Parameters
    ----------
    weights, corners : ndarray, shape=(hinges,)
        A fit c F(c) ~ sum_j weight_j max(0, c - corner_j) of what the cosine is multiplied by; one
        hinge at 0 multiplies by its weight.
    cosine : ndarray, shape=(m,)
        N.w; best m = `BLOCK`.
    kappa : ndarray, shape=(m,)
        |S+ w_t|, 1/mm.
    length : float
        l_u, mm.
    rows : ndarray, shape=(3, samples, 4)
        `PsiTable.rows`.
    inverse_step : ndarray, shape=(3,)
        `PsiTable.inverse_step`.
    channel : int
        0, 1 or 2.

    Returns
    -------
    ndarray, shape=(m,)
        The sums.
    """
    out, psi, inverse = np.zeros(len(cosine)), np.empty(len(cosine)), np.empty(len(cosine))
    step, last = inverse_step[channel], rows.shape[1] - 1.0
    for i in range(len(out)):
        inverse[i] = _inverse(length * kappa[i])
    for hinge in range(len(corners)):
        corner, weight = corners[hinge], weights[hinge]
        # The middle loop fetches; the others are all arithmetic and are vectorised.
        for i in range(len(out)):
            psi[i] = _position(abs(cosine[i] - corner) * inverse[i], step, last)
        for i in range(len(out)):
            psi[i] = _psi(psi[i], rows, channel)
        for i in range(len(out)):
            out[i] += weight * (max(cosine[i] - corner, 0.0) + length * kappa[i] * psi[i])
    return out


@compiled()
def _exitance(
    a: FloatArray, kappa: FloatArray, lengths: FloatArray, rows: FloatArray, steps: FloatArray
) -> FloatArray:
    out = np.empty((len(a), 3))
    for i in range(len(a)):
        for channel in range(3):
            out[i, channel] = even_form(a[i], lengths[channel] * kappa[i], rows, steps, channel)
    return out


def arguments(a: ArrayLike, kappa: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Check what a table is asked for.

    Parameters
    ----------
    a : array_like
        N.w, -1 to 1.
    kappa : array_like
        |S+ w_t|, 1/mm, 0 or more; broadcast against `a`.

    Returns
    -------
    tuple of ndarray
        Both, broadcast.

    Raises
    ------
    ParameterError
        If a value is not finite or out of range, or the shapes do not broadcast.
    """
    cosines, bends = finite("a", a), finite("kappa", kappa)
    # Normalised vectors may exceed a cosine of one by rounding.
    if (np.abs(cosines) > 1.0 + 1e-6).any():
        raise ParameterError(f"a = {a!r} is outside its range -1 to 1")
    if (bends < 0.0).any():
        raise ParameterError(f"kappa = {kappa!r} is negative")
    try:
        cosines, bends = np.broadcast_arrays(cosines, bends)
    except ValueError:
        raise ParameterError(
            f"a and kappa have shapes {cosines.shape} and {bends.shape} that do not broadcast"
        ) from None
    return cosines, bends


@dataclass(frozen=True, eq=False, repr=False)
class PsiTable:
    """psi of three channels, as values and slopes at knots that are even in t = asinh(u).

    Parameters
    ----------
    psi : ndarray, shape=(3, samples)
        psi at the knots, 0 at the last; in units of R_d.
    slope : ndarray, shape=(3, samples)
        dpsi/dt at the knots.
    reach : ndarray, shape=(3,)
        t of the last knot; the first is 0. psi is 0 beyond.
    total : ndarray, shape=(3,)
        Diffuse reflectance R_d of the flat surface.
    mean_free_path : ndarray, shape=(3,)
        l_u, mm.
    mean_square : ndarray, shape=(3,)
        <r^2> of the profile, l_u^2.
    eta : ndarray, shape=(3,)
        Refractive index of the material.
    floored : ndarray of bool, shape=(3,)
        Whether the channel has so little absorption that the glow was made that of the least
        absorption which has one; see `lutcore.baking.BETA_FLOOR`. Tell the user.
    """

    psi: FloatArray
    slope: FloatArray
    reach: FloatArray
    total: FloatArray
    mean_free_path: FloatArray
    mean_square: FloatArray
    eta: FloatArray
    floored: BoolArray

    @property
    def glow(self) -> float:
        """How far light carries the edge of a shadow: the largest l_u psi(0), mm."""
        return float((self.mean_free_path * self.psi[:, 0]).max())

    @property
    def samples(self) -> int:
        """Number of knots."""
        return len(self.psi[0])

    @cached_property
    def entering(self) -> FloatArray:
        """The paper's <F_t>, the share of diffuse light that enters; shape (3,)."""
        return np.array([mean_transmittance(float(eta)) for eta in self.eta])

    @cached_property
    def inverse_step(self) -> FloatArray:
        """Segments per unit of t; shape (3,)."""
        return (self.samples - 1) / self.reach

    @cached_property
    def rows(self) -> FloatArray:
        """Coefficients of 1, f, f^2, f^3 on each segment, f = 0..1; shape (3, samples, 4).

        The last row, all 0, stands for everything beyond the last knot.
        """
        h = (self.reach / (self.samples - 1))[:, None]
        p0, p1 = self.psi[:, :-1], self.psi[:, 1:]
        m0, m1 = h * self.slope[:, :-1], h * self.slope[:, 1:]
        rows = np.zeros((3, self.samples, 4))
        rows[:, :-1] = np.stack(
            [p0, m0, 3.0 * (p1 - p0) - 2.0 * m0 - m1, 2.0 * (p0 - p1) + m0 + m1], axis=-1
        )
        return rows

    def evaluate(self, a: ArrayLike, kappa: ArrayLike) -> FloatArray:
        """Return the first-order exitance per unit normal irradiance, without Fresnel factors.

        Parameters
        ----------
        a : array_like
            N.w, -1 to 1.
        kappa : array_like
            |S+ w_t|, 1/mm, 0 or more; broadcast against `a`.

        Returns
        -------
        ndarray, shape=(..., 3)
            R_d [max(a, 0) + b psi(|a|/b)] with b = l_u kappa, by channel.

        Raises
        ------
        ParameterError
            If a value is not finite or out of range, or the shapes do not broadcast.
        """
        cosines, bends = arguments(a, kappa)
        lengths = self.mean_free_path
        flat = _exitance(cosines.ravel(), bends.ravel(), lengths, self.rows, self.inverse_step)
        return (flat * self.total).reshape(*cosines.shape, 3)

    def arrays(self) -> dict[str, AnyArray]:
        """Return all that the table holds, by name, for storing.

        Returns
        -------
        dict of str to ndarray
            One entry for each parameter of the class.
        """
        return {field.name: np.asarray(getattr(self, field.name)) for field in fields(self)}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, AnyArray]) -> "PsiTable":
        """Return the table that `arrays` described.

        Parameters
        ----------
        arrays : mapping of str to ndarray
            As `arrays` returns them.

        Returns
        -------
        PsiTable
            An equal table.

        Raises
        ------
        ParameterError
            If an entry is missing, not finite or of the wrong shape.
        """
        missing = {field.name for field in fields(cls)} - set(arrays)
        if missing:
            raise ParameterError(f"this is no psi table: {', '.join(sorted(missing))} missing")
        psi = finite("psi", arrays["psi"])
        if psi.ndim != 2 or psi.shape[0] != 3 or psi.shape[1] < 2:
            raise ParameterError(f"psi has shape {psi.shape}, expected (3, samples)")
        vectors = {
            name: finite(name, arrays[name], (3,))
            for name in ("reach", "total", "mean_free_path", "mean_square")
        }
        if (vectors["reach"] <= 0.0).any():
            raise ParameterError("reach must be above 0")
        return cls(
            psi=psi,
            slope=finite("slope", arrays["slope"], psi.shape),
            # Tables were once stored with one index for all channels.
            eta=np.full(3, finite("eta", arrays["eta"], (), (3,))),
            floored=finite("floored", arrays["floored"], (3,)) != 0.0,
            **vectors,
        )
