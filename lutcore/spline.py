"""Cubic B-splines on even knots: tables that are read with continuous curvature."""

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled

_LEAST_KNOTS = 5


def spline_coefficients(values: FloatArray, axis: int) -> FloatArray:
    """Return the coefficients of the cubic spline through values at even knots.

    Parameters
    ----------
    values : ndarray
        At least 5 knots along `axis`.
    axis : int
        The axis to be made a spline; the others are left alone.

    Returns
    -------
    ndarray
        Two more along `axis` than there are knots. The spline is not-a-knot at both ends, so that
        it has no slope of its own there.
    """
    rows = np.moveaxis(values, axis, 0)
    count = len(rows)
    if count < _LEAST_KNOTS:
        raise ValueError(f"{count} knots are fewer than {_LEAST_KNOTS}")
    system = np.zeros((count + 2, count + 2))
    knots = np.arange(count)
    for offset, weight in enumerate((1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0)):
        system[knots + 1, knots + offset] = weight
    system[0, :5] = system[-1, -5:] = (1.0, -4.0, 6.0, -4.0, 1.0)
    given = np.zeros((count + 2, rows[0].size))
    given[1:-1] = rows.reshape(count, -1)
    solved = np.linalg.solve(system, given).reshape(count + 2, *rows.shape[1:])
    return np.ascontiguousarray(np.moveaxis(solved, 0, axis))


@compiled()
def spline_weights(position: float, last: int) -> tuple[int, float, float, float, float]:
    """Return where to read a spline, and the weights of four coefficients from there on.

    Parameters
    ----------
    position : float
        In knots, 0 to `last`; outside, and if it is not a number, it is clamped.
    last : int
        Index of the last knot.

    Returns
    -------
    tuple
        Index of the first coefficient, then four weights that add up to 1.
    """
    # Written so that NaN, too, ends inside the table.
    inside = position if position > 0.0 else 0.0
    segment = int(inside) if inside < last else last - 1
    f = min(inside - segment, 1.0)
    g = 1.0 - f
    square, cube = f * f, f * f * f
    return (
        segment,
        g * g * g / 6.0,
        (3.0 * cube - 6.0 * square + 4.0) / 6.0,
        (3.0 * (f + square - cube) + 1.0) / 6.0,
        cube / 6.0,
    )


@compiled()
def spline_at(coefficients: FloatArray, row: float, column: float) -> float:
    """Return the value of a bicubic spline.

    Parameters
    ----------
    coefficients : ndarray, shape=(rows + 2, columns + 2)
        Made a spline along both axes by `spline_coefficients`.
    row, column : float
        Position in knots; outside it is clamped.

    Returns
    -------
    float
        The value.
    """
    i, r0, r1, r2, r3 = spline_weights(row, coefficients.shape[0] - 3)
    j, c0, c1, c2, c3 = spline_weights(column, coefficients.shape[1] - 3)
    total = 0.0
    for k, weight in enumerate((r0, r1, r2, r3)):
        total += weight * (
            c0 * coefficients[i + k, j]
            + c1 * coefficients[i + k, j + 1]
            + c2 * coefficients[i + k, j + 2]
            + c3 * coefficients[i + k, j + 3]
        )
    return total
