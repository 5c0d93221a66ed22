"""A table of what leaves any convex quadratic patch, smooth in all its arguments.

Of a patch with l_u-scaled curvatures k1 >= k2 >= 0 and light from w the exitance has four
arguments. It is written as

    M/R_d = U(a, e) + sum_ij p^i (q - 1)^j D_ij(a, s),    0 < 2 i + j <= 6,

    a = N.w,  s^2 = (k1^2 + k2^2)/2,  p = (k1 - k2)^2/(k1^2 + k2^2),  b = |S w_t|,
    q = b/(s |w_t|),  e^2 = b^2 + a^2 s^2,

with U the patch of revolution, in a table of its own. On an umbilic e = s, p = 0, q = 1, and
nothing is left for the sum. Elsewhere U has the first order in curvature right, because it depends
on b alone where a is small, and the sum is of second order. Its terms are smooth at umbilics, where
q - 1 vanishes with the difference of the curvatures, and where the light is along a ridge, q = 0,
which a series in the azimuth is not. No principal direction is needed.
"""

from dataclasses import dataclass

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.bent import (
    BentTable,
    bend_column,
    bend_knots,
    bend_row,
    cosine_knots,
    rounded,
    tabulate_bends,
)
from lutcore.compiled import compiled
from lutcore.diffusion import DiffusionProfile, Optics
from lutcore.keeping import kept
from lutcore.quadric import Radial, on_patch
from lutcore.revolution import on_paraboloid
from lutcore.spline import spline_at, spline_coefficients, spline_weights

LIMIT = 2.0
"""Largest s; a more curved patch is shaded as the patch of that s and the same shape."""

_ORDER = 6
TERMS = [
    (i, j) for j in range(_ORDER + 1) for i in range(_ORDER // 2 + 1) if 0 < 2 * i + j <= _ORDER
]
"""The powers i and j."""

_BENDS, _COSINES = 15, 33
_CROWDING = 10.0
# Enough to tell the terms apart; p = 0 is known.
_SHAPES = np.array([0.25, 0.75, 1.0])
_AZIMUTHS = np.cos(np.pi * np.arange(7) / 6.0)  # cos 2 phi


@dataclass(frozen=True, eq=False)
class MongeTable:
    """Exitance of one channel per R_d and unit normal irradiance.

    Parameters
    ----------
    round_ : BentTable
        U, of patches of revolution.
    terms : ndarray, shape=(bends + 2, cosines + 2, len(TERMS))
        D_ij, as coefficients of a bicubic spline over knots like those of a `BentTable`.
    scale : float
        Of the knots in s of `terms`.
    """

    round_: BentTable
    terms: FloatArray
    scale: float


@kept
def bake_monge(profile: DiffusionProfile, optics: Optics) -> MongeTable:
    """Return the table of a channel; the same object for the same arguments.

    Parameters
    ----------
    profile : DiffusionProfile
        How light spreads.
    optics : Optics
        Constants of the channel.

    Returns
    -------
    MongeTable
        The table.
    """

    def curve(cosines: FloatArray, s: float) -> FloatArray:
        return on_paraboloid(cosines, s, profile, optics)

    spread = float(np.sqrt(profile.mean_square(optics)))
    whole = tabulate_bends(curve, spread, 1.5 * LIMIT, optics.eta)  # e <= sqrt(2) s
    radial = Radial.of(profile, optics)
    scale = _CROWDING * spread
    values = np.zeros((_BENDS, _COSINES, len(TERMS)))
    for row, s in enumerate(bend_knots(scale, LIMIT, _BENDS)[1:], start=1):
        values[row] = _fitted(whole, radial, optics.eta, float(s))
    terms = spline_coefficients(spline_coefficients(values, 0), 1)
    return MongeTable(whole, terms, scale)


def _fitted(whole: BentTable, radial: Radial, eta: float, s: float) -> FloatArray:
    a = cosine_knots(s, _COSINES)
    sine = np.sqrt(1.0 - a * a)
    p, turn = (grid.ravel() for grid in np.meshgrid(_SHAPES, _AZIMUTHS, indexing="ij"))
    mean, half = s * np.sqrt(1.0 - 0.5 * p), s * np.sqrt(0.5 * p)
    k = np.stack([mean + half, mean - half], axis=1)
    tangent = np.sqrt(0.5 * np.stack([1.0 + turn, 1.0 - turn], axis=1))
    shape = (len(p), len(a))
    w = np.empty((*shape, 3))
    w[..., :2], w[..., 2] = tangent[:, None, :] * sine[:, None], a
    exact = on_patch(np.repeat(k, len(a), axis=0), w.reshape(-1, 3), radial, eta).reshape(shape)
    bend = np.linalg.norm(k * tangent, axis=1)
    b = bend[:, None] * sine
    e = np.sqrt(b * b + (a * s) ** 2)
    limits = (whole.coefficients, whole.scale, whole.limit, eta)
    left = exact - [[round_at(x, y, *limits) for x, y in zip(a, each, strict=True)] for each in e]
    basis = np.empty((len(p), len(TERMS)))
    for powers, shape_, q in zip(basis, p, bend / s, strict=True):
        set_powers(shape_, q, powers)
    return np.asarray(np.linalg.lstsq(basis, left)[0]).T


@compiled()
def round_at(
    a: float, e: float, coefficients: FloatArray, scale: float, limit: float, eta: float
) -> float:
    """Return U, what leaves the apex of a paraboloid of revolution.

    Parameters
    ----------
    a : float
        N.w.
    e : float
        l_u x its curvature, 0 or more.
    coefficients : ndarray, shape=(bends + 2, cosines + 2)
        Of `MongeTable.round_`.
    scale, limit : float
        Of `MongeTable.round_`.
    eta : float
        Refractive index.

    Returns
    -------
    float
        Per R_d and unit normal irradiance.
    """
    rows, columns = coefficients.shape[0] - 3, coefficients.shape[1] - 3
    row, inverse, span = bend_row(min(e, limit), scale, limit, rows)
    column = bend_column(a, inverse, span, columns)
    return rounded(a, min(e, limit), eta) + spline_at(coefficients, row, column)


@compiled()
def set_powers(p: float, q: float, powers: FloatArray) -> None:
    """Set p^i (q - 1)^j for all `TERMS`.

    Parameters
    ----------
    p, q : float
        See the module.
    powers : ndarray, shape=(len(TERMS),)
        Is overwritten.
    """
    slot, factor = 0, 1.0
    for j in range(_ORDER + 1):
        power = factor
        for i in range(_ORDER // 2 + 1):
            if 0 < 2 * i + j <= _ORDER:
                powers[slot] = power
                slot += 1
            power *= p
        factor *= q - 1.0


@compiled()
def _along(
    terms: FloatArray, i: int, j: int, m: int, c0: float, c1: float, c2: float, c3: float
) -> float:
    value: float = c0 * terms[i, j, m] + c1 * terms[i, j + 1, m]
    value += c2 * terms[i, j + 2, m] + c3 * terms[i, j + 3, m]
    return value


@compiled()
def terms_at(a: float, s: float, terms: FloatArray, scale: float, powers: FloatArray) -> float:
    """Return the sum over `TERMS`.

    Parameters
    ----------
    a : float
        N.w.
    s : float
        l_u sqrt((k1^2 + k2^2)/2), 0 to `LIMIT`.
    terms : ndarray, shape=(bends + 2, cosines + 2, len(TERMS))
        `MongeTable.terms`.
    scale : float
        `MongeTable.scale`.
    powers : ndarray, shape=(len(TERMS),)
        From `set_powers`.

    Returns
    -------
    float
        Per R_d and unit normal irradiance.
    """
    rows, columns = terms.shape[0] - 3, terms.shape[1] - 3
    row, inverse, span = bend_row(s, scale, LIMIT, rows)
    i, r0, r1, r2, r3 = spline_weights(row, rows)
    j, c0, c1, c2, c3 = spline_weights(bend_column(a, inverse, span, columns), columns)
    # Four sums side by side: in one, every addition would wait for the one before.
    t0 = t1 = t2 = t3 = 0.0
    for m in range(len(powers)):
        power = powers[m]
        t0 += power * _along(terms, i, j, m, c0, c1, c2, c3)
        t1 += power * _along(terms, i + 1, j, m, c0, c1, c2, c3)
        t2 += power * _along(terms, i + 2, j, m, c0, c1, c2, c3)
        t3 += power * _along(terms, i + 3, j, m, c0, c1, c2, c3)
    return r0 * t0 + r1 * t1 + r2 * t2 + r3 * t3
