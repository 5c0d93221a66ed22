"""Local shading while a light is dragged: in single precision, one look-up for each channel.

What does not change with the light is computed once for a surface. The rest is a sixth of the work
of the model itself, and within half a byte of it on a display.
"""

from dataclasses import dataclass

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray, SingleArray
from lutcore.compiled import compiled
from lutcore.lights import is_directional, light_at
from lutcore.lut import BLOCK, PsiTable
from lutcore.response_table import BEND, COLUMNS, MOST, ROWS, halfway, response

# Of the kernel: a number written there would have it compute in double precision.
_ONE, _BEND = np.float32(1.0), np.float32(BEND)
_HALF_COLUMNS = np.float32(0.5 * COLUMNS)
_STRETCH = np.float32(0.5 * COLUMNS * (BEND + MOST) / MOST)
_ROWS = np.float32(ROWS)
_FIRST, _WIDTH = np.int32(0), np.int32(COLUMNS)
_LAST_COLUMN, _LAST_ROW = np.int32(COLUMNS - 1), np.int32(ROWS - 1)


@dataclass(frozen=True, eq=False)
class Draft:
    """A surface that is ready to be shaded under any lights.

    Parameters
    ----------
    points : ndarray, shape=(n, 3)
        Positions, mesh units.
    surface : ndarray of float32, shape=(3, 9, n)
        Normal and l_u S+ by channel.
    kept : ndarray of float32, shape=(3, n)
        What the light of each channel is multiplied by; 0 where there is no normal.
    halfway : ndarray of float32, shape=(3,)
        See `lutcore.response_table.halfway`.
    cells : ndarray of float32, shape=(3, ROWS * COLUMNS, 4)
        See `lutcore.response_table.response`.
    """

    points: FloatArray
    surface: SingleArray
    kept: SingleArray
    halfway: SingleArray
    cells: SingleArray

    def exitance(self, lights: FloatArray) -> FloatArray:
        """Compute what leaves the surface, nearly.

        Parameters
        ----------
        lights : ndarray, shape=(l, LIGHT_FIELDS)
            See `lutcore.lights.pack`.

        Returns
        -------
        ndarray, shape=(n, 3)
            As `lutcore.exitance.exitance` without visibility, to .0015 R_d of unit light; that is
            .45/255 of what is shown where 1 is white.
        """
        return _exitance(self.points, self.surface, self.kept, self.halfway, self.cells, lights)


def draft(
    points: FloatArray,
    normals: FloatArray,
    shape: FloatArray,
    kept: FloatArray,
    table: PsiTable,
    hinges: tuple[FloatArray, FloatArray],
) -> Draft:
    """Prepare a surface.

    Parameters
    ----------
    points : ndarray, shape=(n, 3)
        Positions, mesh units.
    normals, shape : ndarray, shape=(3, n, 3) and (3, n, 6), or (1, n, 3) and (1, n, 6)
        Unit normals and S+, for each channel or one for all; see `lutcore.detail.Detail`.
    kept : ndarray, shape=(3, n)
        What the light of each channel is multiplied by.
    table : PsiTable
        Of the material.
    hinges : tuple of 2 ndarrays, shape=(3, J)
        See `lutcore.fresnel.hinges_of`.

    Returns
    -------
    Draft
        For all lights.
    """
    surface = np.empty((3, 9, len(points)), np.float32)
    for channel, length in enumerate(table.mean_free_path):
        own = min(channel, len(normals) - 1)
        surface[channel, :3] = normals[own].T
        surface[channel, 3:] = length * shape[own].T
    dark = ~normals.any(axis=2)
    cells = response(table, *hinges).reshape(3, ROWS * COLUMNS, 4)
    return Draft(
        points,
        surface,
        np.where(dark, 0.0, kept).astype(np.float32),
        halfway(table).astype(np.float32),
        cells,
    )


@compiled(parallel=True)
def _exitance(
    points: FloatArray,
    surface: SingleArray,
    kept: SingleArray,
    halfway: SingleArray,
    cells: SingleArray,
    lights: FloatArray,
) -> FloatArray:
    out = np.zeros((len(points), 3))
    for block in prange((len(points) + BLOCK - 1) // BLOCK):
        first = block * BLOCK
        last = min(first + BLOCK, len(points))
        towards = np.empty((4, last - first), np.float32)
        for light in range(len(lights)):
            _face(lights, light, points[first:last], towards)
            for c in range(3):
                power = np.float32(lights[light, 8 + c])
                _add(towards, power, surface[c], kept[c], halfway[c], cells[c], first, out, c)
    return out


@compiled()
def _face(lights: FloatArray, light: int, points: FloatArray, towards: SingleArray) -> None:
    """Write where a light is seen from a block of vertices, and how strong it is there."""
    if is_directional(lights, light):
        towards[0], towards[1], towards[2], towards[3] = light_at(lights, light, 0.0, 0.0, 0.0)
        return
    for k in range(len(points)):
        seen = light_at(lights, light, points[k, 0], points[k, 1], points[k, 2])
        towards[0, k], towards[1, k], towards[2, k], towards[3, k] = seen


@compiled()
def _add(
    towards: SingleArray,
    power: np.float32,
    surface: SingleArray,
    kept: SingleArray,
    halfway: float,
    cells: SingleArray,
    first: int,
    out: FloatArray,
    channel: int,
) -> None:
    """Add one channel of one light on a block of vertices; see `response` for the cells."""
    count = towards.shape[1]
    last = first + count
    f, g = np.empty(count, np.float32), np.empty(count, np.float32)
    factor, at = np.empty(count, np.float32), np.empty(count, np.int32)
    # One by one, so that the compiler knows that each is without gaps.
    x, y, z, strength = towards[0], towards[1], towards[2], towards[3]
    nx, ny, nz = surface[0, first:last], surface[1, first:last], surface[2, first:last]
    xx, yy, zz = surface[3, first:last], surface[4, first:last], surface[5, first:last]
    xy, yz, xz = surface[6, first:last], surface[7, first:last], surface[8, first:last]
    keep = kept[first:last]
    # All arithmetic, and vectorised; the loop after it fetches.
    for k in range(count):
        a = nx[k] * x[k] + ny[k] * y[k] + nz[k] * z[k]
        p = xx[k] * x[k] + xy[k] * y[k] + xz[k] * z[k]
        q = xy[k] * x[k] + yy[k] * y[k] + yz[k] * z[k]
        r = xz[k] * x[k] + yz[k] * y[k] + zz[k] * z[k]
        b = np.sqrt(p * p + q * q + r * r)
        root = np.sqrt(b)
        column = _HALF_COLUMNS + _STRETCH * (a / (_BEND + abs(a)))
        row = _ROWS * (root / (halfway + root))
        # Also what is no number ends inside the table.
        i = min(max(np.int32(column), _FIRST), _LAST_COLUMN)
        j = min(max(np.int32(row), _FIRST), _LAST_ROW)
        f[k], g[k] = column - np.float32(i), row - np.float32(j)
        at[k] = j * _WIDTH + i
        factor[k] = (_ONE + b) * keep[k] * strength[k] * power
    for k in range(count):
        cell = cells[at[k]]
        light = cell[0] + f[k] * cell[1] + g[k] * (cell[2] + f[k] * cell[3])
        out[first + k, channel] += factor[k] * light
