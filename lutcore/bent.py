"""Tables over the cosine of light and one curvature, smooth down to the flat surface.

What leaves a curved surface differs from what leaves a flat one most at the terminator, over a
width that is proportional to the curvature. The knots are therefore even in

    tau = asinh(a/sigma)/asinh(1/sigma),    sigma = SHARPEST + s,    a = N.w, -1 to 1,
    v = log(1 + 100 spread s),              s = length x curvature, 0 to a limit,

and what is stored is the difference to Lambert's c F_t(c), which is 0 at s = 0, where c is N.w
rounded off about the terminator over the same width: c = (a + sqrt(a^2 + m^2))/2, m = s/(1 + s). A
bicubic spline reads it, so that nothing has a seam; beyond the limit the surface is shaded as if
at the limit.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled
from lutcore.convexity import invariants
from lutcore.fresnel import compiled_transmittance
from lutcore.lights import light_at
from lutcore.lut import BLOCK, logarithm
from lutcore.shading import ShadingInputs
from lutcore.spline import spline_at, spline_coefficients

SHARPEST = 1e-4
"""Least width of the terminator that the knots follow: a narrower glow is lower than that."""

# With these the tables of all built-in materials are within 1e-5 of what they hold.
_BENDS, _COSINES = 65, 97
_CROWDING = 100.0


@dataclass(frozen=True, eq=False)
class BentTable:
    """Exitance of one channel per R_d and unit normal irradiance, less that of `rounded` Lambert.

    Parameters
    ----------
    coefficients : ndarray, shape=(bends + 2, cosines + 2)
        Of the bicubic spline.
    scale : float
        100 spread: knots in s are even in log(1 + s scale).
    limit : float
        Largest s.
    """

    coefficients: FloatArray
    scale: float
    limit: float


def cosine_knots(s: float, count: int) -> FloatArray:
    """Return the cosines at the knots of one row of a table.

    Parameters
    ----------
    s : float
        length x curvature.
    count : int
        Knots, odd, so that the terminator is one.

    Returns
    -------
    ndarray, shape=(count,)
        From -1 to 1, exactly symmetric.
    """
    sigma = SHARPEST + s
    half = sigma * np.sinh(np.linspace(0.0, np.arcsinh(1.0 / sigma), count // 2 + 1))
    half[-1] = 1.0
    return np.concatenate((-half[:0:-1], half))


def bend_knots(scale: float, limit: float, count: int) -> FloatArray:
    """Return s at the rows of a table.

    Parameters
    ----------
    scale, limit : float
        As in `BentTable`.
    count : int
        Rows.

    Returns
    -------
    ndarray, shape=(count,)
        From 0 to `limit`.
    """
    s: FloatArray = np.expm1(np.linspace(0.0, np.log1p(limit * scale), count)) / scale
    return s


def tabulate_bends(
    curve: Callable[[FloatArray, float], FloatArray],
    spread: float,
    limit: float,
    eta: float = 1.0,
) -> BentTable:
    """Fill a table.

    Parameters
    ----------
    curve : callable
        Given cosines as `cosine_knots` returns them and s > 0, returns the exitance at each.
    spread : float
        The longest length of what is blurred, in the length of s.
    limit : float
        Largest s.
    eta : float
        Refractive index that the flat surface lets light in by; 1 for none.

    Returns
    -------
    BentTable
        The table.
    """
    scale = _CROWDING * spread
    values = np.zeros((_BENDS, _COSINES))
    for row, s in enumerate(bend_knots(scale, limit, _BENDS)[1:], start=1):
        a = cosine_knots(float(s), _COSINES)
        values[row] = curve(a, float(s)) - [rounded(cosine, float(s), eta) for cosine in a]
    coefficients = spline_coefficients(spline_coefficients(values, 0), 1)
    coefficients.setflags(write=False)
    return BentTable(coefficients, scale, limit)


def bent_exitance(
    inputs: ShadingInputs,
    tables: tuple[BentTable, BentTable, BentTable],
    total: FloatArray,
    length: FloatArray,
    eta: FloatArray | None = None,
) -> FloatArray:
    """Shade with one table for each channel, s being that of the mean convex curvature.

    Parameters
    ----------
    inputs : ShadingInputs
        What a model is given.
    tables : tuple of 3 BentTable
        Red, green, blue; of the same limit and number of knots.
    total : ndarray, shape=(3,)
        What the result is multiplied by.
    length : ndarray, shape=(3,)
        s = length (k1 + k2)/2 with concave curvature 0, mm.
    eta : ndarray, shape=(3,), optional
        Refractive index that the flat surface lets light in by; if not given, none.

    Returns
    -------
    ndarray, shape=(n, 3)
        Sum over lights of E total max(rounded Lambert + table, 0).
    """
    return _exitance(
        inputs.points,
        inputs.normals,
        inputs.shape,
        inputs.lights,
        # Always new arrays: those that cannot be written to would be compiled for apart.
        total.copy(),
        length.copy(),
        np.ones(3) if eta is None else eta.copy(),
        np.stack([table.coefficients for table in tables]),
        np.array([table.scale for table in tables]),
        tables[0].limit,
    )


@compiled()
def bend_row(s: float, scale: float, limit: float, rows: int) -> tuple[float, float, float]:
    """Return where the row of a curvature lies, and how its knots are spread.

    Parameters
    ----------
    s : float
        length x curvature, 0 to `limit`.
    scale, limit : float
        As in `BentTable`.
    rows : int
        Index of the last row.

    Returns
    -------
    tuple of float
        Position in rows, 1/sigma and asinh(1/sigma).
    """
    inverse = 1.0 / (SHARPEST + s)
    position = np.log(1.0 + s * scale) / np.log(1.0 + limit * scale) * rows
    return position, inverse, np.log(inverse + np.sqrt(inverse * inverse + 1.0))


@compiled()
def bend_column(a: float, inverse: float, span: float, columns: int) -> float:
    """Return where a cosine lies in its row.

    Parameters
    ----------
    a : float
        N.w, -1 to 1.
    inverse, span : float
        As `bend_row` returned them.
    columns : int
        Index of the last column.

    Returns
    -------
    float
        Position in columns.
    """
    u = abs(a) * inverse
    tau = logarithm(u + np.sqrt(u * u + 1.0)) / span  # asinh
    return 0.5 * columns * (1.0 + (tau if a > 0.0 else -tau))


@compiled()
def rounded(a: float, s: float, eta: float) -> float:
    """Return Lambert's c F_t(c) of a cosine that is rounded off about the terminator.

    Parameters
    ----------
    a : float
        N.w.
    s : float
        length x curvature; 0 rounds nothing off.
    eta : float
        Refractive index.

    Returns
    -------
    float
        Per unit normal irradiance.
    """
    m = s / (1.0 + s)
    c = 0.5 * (a + np.sqrt(a * a + m * m))
    return c * compiled_transmittance(c, eta)


@compiled(parallel=True)
def _exitance(
    points: FloatArray,
    normals: FloatArray,
    shape: FloatArray,
    lights: FloatArray,
    total: FloatArray,
    length: FloatArray,
    eta: FloatArray,
    coefficients: FloatArray,
    scale: FloatArray,
    limit: float,
) -> FloatArray:
    out = np.zeros((len(points), 3))
    rows, columns = coefficients.shape[1] - 3, coefficients.shape[2] - 3
    for block in prange((len(points) + BLOCK - 1) // BLOCK):
        first = block * BLOCK
        count = min(BLOCK, len(points) - first)
        cosine, strength, column = np.empty(count), np.empty(count), np.empty(count)
        held, row = np.empty((3, count)), np.empty((3, count))
        inverse, span, flat = np.empty((3, count)), np.empty((3, count)), np.empty(count)
        for k in range(count):
            bend = 0.5 * invariants(shape, first + k)[0]
            for c in range(3):
                held[c, k] = min(length[c] * bend, limit)
                row[c, k], inverse[c, k], span[c, k] = bend_row(held[c, k], scale[c], limit, rows)
        for light in range(len(lights)):
            for k in range(count):
                i = first + k
                x, y, z, strength[k] = light_at(
                    lights, light, points[i, 0], points[i, 1], points[i, 2]
                )
                cosine[k] = normals[i, 0] * x + normals[i, 1] * y + normals[i, 2] * z
            for c in range(3):
                if lights[light, 8 + c] == 0.0:
                    continue
                # The last loop fetches; the others are all arithmetic and are vectorised.
                for k in range(count):
                    column[k] = bend_column(cosine[k], inverse[c, k], span[c, k], columns)
                for k in range(count):
                    flat[k] = rounded(cosine[k], held[c, k], eta[c])
                brightness = lights[light, 8 + c] * total[c]
                for k in range(count):
                    value = flat[k] + spline_at(coefficients[c], row[c, k], column[k])
                    out[first + k, c] += brightness * strength[k] * max(value, 0.0)
    return out
