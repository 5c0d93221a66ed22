"""How different an error of light may look: a bound fast enough for every vertex.

A small error dv of an encoded colour v makes a CIEDE2000 of sqrt(dv G dv), where G depends on v
alone and varies slowly: a cube of it is tabulated once, and looked up by a vertex in a hundredth
of the time of the eight CIEDE2000 differences that `lutcore.tolerance.color_differences` takes.
"""

from functools import lru_cache

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray
from lutcore.color import srgb_encode
from lutcore.compiled import compiled
from lutcore.metrics import ciede2000_lab, lab

# Nodes along each axis of the cube, and of the encoding along the root of the light.
_NODES, _CURVE = 17, 2049
# Difference that G is taken from, in encoded values: a CIEDE2000 of .1 to .5.
_STEP = 1.0 / 256.0
# G is 300 to 20 000. Rounded so, other last bits of a machine's library do not change it.
_QUANTUM = 0.125
# G at the colour itself stands for G on the whole way: with this, 99 % of colours and errors of a
# CIEDE2000 up to 2 are bounded, see tests/lutcore/test_color_bound.py.
_MARGIN = 1.25
# Entries of G, by the directions of differences that they are taken from.
_AXES = np.eye(3)
_PAIRS = ((0, 1), (1, 2), (0, 2))


def color_bound(
    exitance: FloatArray, errors: FloatArray, total: FloatArray, exposure: float
) -> FloatArray:
    """Return about the largest CIEDE2000 difference that errors of the exitance can make.

    Continuous in the exitance and its errors: what follows it has no seam.

    Parameters
    ----------
    exitance : ndarray, shape=(n, 3)
        Linear RGB.
    errors : ndarray, shape=(n, 3)
        Bounds on its error, of any sign, channel by channel, over `total`.
    total : ndarray, shape=(3,)
        R_d.
    exposure : float
        Factor of both.

    Returns
    -------
    ndarray, shape=(n,)
        Encoded as for a display: light beyond white is white, and its error is none.
    """
    found: FloatArray = _bound(
        np.ascontiguousarray(exitance), errors, exposure * total, exposure, _curve(), _forms()
    )
    return found


@lru_cache(maxsize=1)
def _curve() -> FloatArray:
    """Return encoded values at even steps of the root of the light."""
    return srgb_encode(np.linspace(0.0, 1.0, _CURVE) ** 2)


@lru_cache(maxsize=1)
def _forms() -> FloatArray:
    """Return G over the cube of encoded colours: rr, gg, bb, rg, gb, rb; shape (_NODES,) * 3 + 6.

    By polarisation: 2 G(u, v) = G(u + v, u + v) - G(u, u) - G(v, v).
    """
    along = np.linspace(0.0, 1.0, _NODES)
    nodes = np.stack(np.meshgrid(along, along, along, indexing="ij"), axis=-1)
    nodes = np.clip(nodes, 0.5 * _STEP, 1.0 - 0.5 * _STEP)

    def square(way: FloatArray) -> FloatArray:
        half = 0.5 * _STEP * way
        return np.square(ciede2000_lab(lab(nodes - half), lab(nodes + half)) / _STEP)

    own = [square(axis) for axis in _AXES]
    mixed = [
        0.5 * (square(_AXES[one] + _AXES[other]) - own[one] - own[other]) for one, other in _PAIRS
    ]
    return np.round(np.stack([*own, *mixed], axis=-1) / _QUANTUM) * _QUANTUM


@compiled()
def _encoded(light: float, curve: FloatArray) -> float:
    at = np.sqrt(min(max(light, 0.0), 1.0)) * (len(curve) - 1)
    cell = min(int(at), len(curve) - 2)
    value: float = curve[cell] + (at - cell) * (curve[cell + 1] - curve[cell])
    return value


@compiled(parallel=True)
def _bound(
    exitance: FloatArray,
    errors: FloatArray,
    unit: FloatArray,
    exposure: float,
    curve: FloatArray,
    forms: FloatArray,
) -> FloatArray:
    out = np.empty(len(exitance))
    last = forms.shape[0] - 2
    for i in prange(len(exitance)):
        cell, part, off = np.empty(3, np.int64), np.empty(3), np.empty(3)
        for c in range(3):
            light, error = exposure * exitance[i, c], unit[c] * errors[i, c]
            value = _encoded(light, curve)
            more, less = _encoded(light + error, curve), _encoded(light - error, curve)
            off[c] = max(more - value, value - less)
            cell[c] = min(int(value * (last + 1)), last)
            part[c] = value * (last + 1) - cell[c]
        rr = gg = bb = rg = gb = rb = 0.0
        for corner in range(8):
            x, y, z = corner & 1, (corner >> 1) & 1, corner >> 2
            share = part[0] if x else 1.0 - part[0]
            share *= part[1] if y else 1.0 - part[1]
            share *= part[2] if z else 1.0 - part[2]
            node = forms[cell[0] + x, cell[1] + y, cell[2] + z]
            rr += share * node[0]
            gg += share * node[1]
            bb += share * node[2]
            rg += share * node[3]
            gb += share * node[4]
            rb += share * node[5]
        # Errors of three channels add up in colour or cancel: the worst of their signs.
        rg, gb, rb = rg * off[0] * off[1], gb * off[1] * off[2], rb * off[0] * off[2]
        mixed = max(rg + gb + rb, rg - gb - rb, gb - rg - rb, rb - rg - gb)
        square = rr * off[0] ** 2 + gg * off[1] ** 2 + bb * off[2] ** 2 + 2.0 * mixed
        out[i] = _MARGIN * np.sqrt(max(square, 0.0))
    return out
