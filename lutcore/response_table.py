"""A material's whole response to light as a texture: one look-up for each light and channel."""

from typing import TYPE_CHECKING

import numpy as np

from lutcore.arrays import FloatArray, SingleArray

if TYPE_CHECKING:
    from lutcore.lut import PsiTable


COLUMNS, ROWS = 128, 64
"""Cells along the cosine, and along the bend of each channel: few enough to stay in the cache.

What is drawn is within .45/255 of what `CurvatureLut` gives, and within .7/255 where the exposure
shows a third of the brightest flat surface as white: half of that for its default hinges."""
BEND = 0.15
"""|a| in the middle between 0 and the end of the columns: where F_t(a) bends, they are dense."""
MOST = 1.001
"""|a| at the end: a normalised vector may exceed a cosine of one by rounding."""
_MIDDLE = 0.3
# In the last knot b is finite, and more than any surface has.
_LAST = 1.0 - 1e-4


def halfway(table: "PsiTable") -> FloatArray:
    """Return the root of the bend that lies in the middle of the rows.

    Parameters
    ----------
    table : PsiTable
        Of the material.

    Returns
    -------
    ndarray, shape=(3,)
        sqrt(b) by channel: the wider the glow, the less.
    """
    return _MIDDLE / np.sqrt(table.psi[:, 0])


def response(table: "PsiTable", corners: FloatArray, weights: FloatArray) -> SingleArray:
    """Return sum_j w_j p(a - c_j, b) / R_d for all cosines a and bends b.

    Parameters
    ----------
    table : PsiTable
        Of the material.
    corners, weights : ndarray, shape=(3, J)
        Hinges that F_t(a) a of each channel is replaced by; see `lutcore.fresnel.hinges_of`.

    Returns
    -------
    ndarray of float32, shape=(3 * ROWS, COLUMNS, 4)
        For each channel, bend and cosine the cell's k in
        p/(1 + b) = k0 + f k1 + g (k2 + f k3), f and g being 0..1 along columns and rows. Columns
        are equally wide in a/(BEND + abs a), rows in sqrt(b)/(`halfway` + sqrt(b)): dense where
        there is little bend and edges of light are sharp.
    """
    cells = [_cells(table, corners[channel], weights[channel], channel) for channel in range(3)]
    return np.concatenate(cells).astype(np.float32)


def _cells(table: "PsiTable", corners: FloatArray, weights: FloatArray, channel: int) -> FloatArray:
    from lutcore.lut import even_forms

    end = MOST / (BEND + MOST)
    x = np.linspace(-end, end, 2 * COLUMNS + 1)
    cosine = BEND * x / (1.0 - np.abs(x))
    y = np.minimum(np.linspace(0.0, 1.0, 2 * ROWS + 1), _LAST)
    bends = (halfway(table)[channel] * y / (1.0 - y)) ** 2
    found = np.empty((len(bends), len(cosine)))
    for row, bend in enumerate(bends):
        kappa = np.full(len(cosine), bend)
        arguments = (weights, corners, cosine, kappa, 1.0)
        found[row] = even_forms(*arguments, table.rows, table.inverse_step, channel)
    found /= 1.0 + bends[:, None]
    knots, middle = found[::2, ::2], found[1::2, 1::2]
    low, high = knots[:-1], knots[1:]
    rise, last = np.diff(low, axis=1), np.diff(high, axis=1)
    cells = np.stack([low[:, :-1], rise, (high - low)[:, :-1], last - rise], axis=-1)
    # What is off most in the middle, and not at the knots, is shared by both.
    cells[:, :, 0] += 0.5 * (middle - cells @ (1.0, 0.5, 0.5, 0.25))
    return cells
