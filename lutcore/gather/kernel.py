"""A diffusion profile as a table over distance, and how fast it bends beyond each.

The table is cubic in v = r^2 + r_0^2 between knots that divide each octave of v into 16, so that a
knot is found from the bits of v, without a root and without a logarithm. r_0 is a thousandth of
the shortest l_u: nothing is resolved below it.
"""

from typing import NamedTuple

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled
from lutcore.diffusion import DiffusionProfile, optics
from lutcore.materials import Material

_BITS, _FINE_BITS = 4, 7
_SHIFT, _FINE_SHIFT = 52 - _BITS, 52 - _FINE_BITS
_EVERY = 1 << (_FINE_BITS - _BITS)
_FRACTION = 2.0**-_SHIFT
_MASK = (1 << _SHIFT) - 1
_INNER = 1e-3
# What differences of rounded values make of the third derivative is below this share of R/r^3.
_ROUNDED = 1e-4
# Cosines between a step and the line of sight for which the third derivative is bounded.
_COSINES = (0.25, 0.5, 0.75, 1.0)


class Kernel(NamedTuple):
    """R(r) of three channels, and what a group of light at a distance may be off by.

    Parameters
    ----------
    rows : ndarray, shape=(k, 4, 4)
        Coefficients of 1, f, f^2, f^3 of R between a knot and the next, f = 0..1, 1/mm^2. Each of
        three channels, and a fourth of 0: vector instructions take four.
    per_step : ndarray, shape=(k,)
        df/dv, 1/mm^2.
    bend : ndarray, shape=(k, 4)
        A sixth of the largest third derivative of R at a knot or beyond, over the error that a
        group may have: times the integral of its light times the cube of the distance to its
        centre that is 1 at most where it may stand for its parts, 1/(mm^5 irradiance). The fourth
        is the largest.
    distance : ndarray, shape=(k,)
        r of the knots, mm.
    inner : float
        r_0^2, mm^2, a power of 2.
    first : int
        Bits of the first knot, r_0^2 itself.
    """

    rows: FloatArray
    per_step: FloatArray
    bend: FloatArray
    distance: FloatArray
    inner: float
    first: int


class Radial(NamedTuple):
    """R and what bounds its third derivatives, at v = r^2 + r_0^2, 128 to an octave.

    Parameters
    ----------
    v : ndarray, shape=(k,)
        From r_0^2 on, mm^2.
    values : ndarray, shape=(k, 3)
        R, 1/mm^2.
    slopes : ndarray, shape=(k, 3)
        dR/dv, 1/mm^4.
    third : ndarray, shape=(k, 3)
        Largest absolute third derivative of R in any direction, at this distance or beyond,
        1/mm^5.
    """

    v: FloatArray
    values: FloatArray
    slopes: FloatArray
    third: FloatArray


def radial(profile: DiffusionProfile, material: Material, diameter: float) -> Radial:
    """Tabulate the profile of a material.

    Parameters
    ----------
    profile : DiffusionProfile
        How light spreads under a flat surface.
    material : Material
        What the surface is made of.
    diameter : float
        Largest distance that is asked for, mm.

    Returns
    -------
    Radial
        The table.
    """
    lengths = material.mean_free_path
    inner = 2.0 ** np.round(2.0 * np.log2(_INNER * lengths.min()))
    first = _bits(inner, _SHIFT)
    last = _bits(1.01 * diameter * diameter + 2.0 * inner, _SHIFT) + 2
    fine = np.arange(first * _EVERY, last * _EVERY + 1, dtype=np.int64)
    v = (fine << _FINE_SHIFT).view(np.float64)
    # A profile may be infinite at r = 0.
    square = np.maximum(v - inner, 0.25 * (v[1] - inner))
    values = np.stack(
        [
            profile.radial(np.sqrt(square) / length, one) / length**2
            for length, one in zip(lengths, optics(material), strict=True)
        ],
        axis=1,
    )
    slopes = np.gradient(values, v, axis=0)
    second = np.gradient(slopes, v, axis=0)
    # With R(r) = f(r^2), a unit step at the cosine c to the line of sight has the third derivative
    # 12 r c f'' + 8 (r c)^3 f'''.
    r, jerk = np.sqrt(square)[:, None], np.gradient(second, v, axis=0)
    bounds = [np.abs(12.0 * c * r * second + 8.0 * (c * r) ** 3 * jerk) for c in _COSINES]
    here = np.max(bounds, axis=0)
    here[here * (v**1.5)[:, None] < _ROUNDED * values] = 0.0
    third = np.maximum.accumulate(here[::-1], axis=0)[::-1]
    return Radial(v, values, slopes, third)


def kernel(table: Radial, error: FloatArray) -> Kernel:
    """Prepare a profile for sums over groups of light.

    A group of light known by its moments up to the second about a centre, at the distance r from
    it and of radius s, is off by at most a sixth of its third moment times the largest third
    derivative of R at the distance r - s or beyond.

    Parameters
    ----------
    table : Radial
        The profile.
    error : ndarray, shape=(3,)
        What a group may be off by, radiant exitance; 0 for a channel without light.

    Returns
    -------
    Kernel
        The table.
    """
    v, inner = table.v[::_EVERY], float(table.v[0])
    steps = np.diff(v)
    p, m = table.values[::_EVERY], table.slopes[::_EVERY]
    p0, p1, m0, m1 = p[:-1], p[1:], m[:-1] * steps[:, None], m[1:] * steps[:, None]
    powers = [p0, m0, 3.0 * (p1 - p0) - 2.0 * m0 - m1, 2.0 * (p0 - p1) + m0 + m1]
    rows, bend = np.zeros((len(steps), 4, 4)), np.zeros((len(steps), 4))
    rows[:, :, :3] = np.stack(powers, axis=1)
    lit = error > 0.0
    bend[:, :3][:, lit] = table.third[::_EVERY][:-1, lit] / (6.0 * error[lit])
    bend[:, 3] = bend.max(axis=1)
    distance = np.sqrt(v[:-1] - inner)
    return Kernel(rows, 1.0 / steps, bend, distance, inner, _bits(inner, _SHIFT))


def _bits(v: float, shift: int) -> int:
    return int(np.float64(v).view(np.int64)) >> shift


@compiled()
def place(square: float, inner: float, first: int) -> tuple[int, float]:
    """Return the knot before a distance and the share of the way to the next.

    Parameters
    ----------
    square : float
        r^2, mm^2.
    inner, first : float, int
        Those of `Kernel`.

    Returns
    -------
    tuple of int and float
        Index into the arrays of `Kernel`, and 0 to 1.
    """
    bits = np.float64(square + inner).view(np.int64)
    return int(bits >> _SHIFT) - first, float(bits & _MASK) * _FRACTION
