"""The paper's table over (a, b), which can be stored as a texture image."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lutcore.arrays import AnyArray, FloatArray, finite
from lutcore.errors import ParameterError
from lutcore.lut import PsiTable, arguments


@dataclass(frozen=True, eq=False, repr=False)
class PlaneTable:
    """alpha'/(4 pi) J(a, b) on an even grid.

    Parameters
    ----------
    values : ndarray, shape=(rows, columns, 3)
        Rows are b from 0 to `limit`, columns a from -1 to 1; by channel.
    limit : float
        b of the last row, in units of l_u times 1/mm.
    mean_free_path : ndarray, shape=(3,)
        l_u, mm: b = l_u kappa.
    """

    values: FloatArray
    limit: float
    mean_free_path: FloatArray

    def evaluate(self, a: ArrayLike, kappa: ArrayLike) -> FloatArray:
        """Return the exitance per unit normal irradiance by bilinear interpolation.

        Parameters
        ----------
        a : array_like
            N.w, -1 to 1.
        kappa : array_like
            |S+ w_t|, 1/mm; broadcast against `a`. Beyond the last row the last row is used.

        Returns
        -------
        ndarray, shape=(..., 3)
            As `PsiTable.evaluate`, within the error of the samples.

        Raises
        ------
        ParameterError
            If a value is not finite or out of range, or the shapes do not broadcast.
        """
        from scipy.ndimage import map_coordinates

        cosines, bends = arguments(a, kappa)
        rows, columns = self.values.shape[:2]
        x = 0.5 * (cosines.ravel() + 1.0) * (columns - 1)
        out = np.empty((cosines.size, 3))
        for channel, length in enumerate(self.mean_free_path):
            y = bends.ravel() * length / self.limit * (rows - 1)
            out[:, channel] = map_coordinates(
                self.values[..., channel], (y, x), order=1, mode="nearest"
            )
        return out.reshape(*cosines.shape, 3)

    def arrays(self) -> dict[str, AnyArray]:
        """Return all that the table holds, by name, for storing.

        Returns
        -------
        dict of str to ndarray
            One entry for each parameter of the class.
        """
        return {
            "values": self.values,
            "limit": np.asarray(self.limit),
            "mean_free_path": self.mean_free_path,
        }

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, AnyArray]) -> "PlaneTable":
        """Return the table that `arrays` described.

        Parameters
        ----------
        arrays : mapping of str to ndarray
            As `arrays` returns them.

        Returns
        -------
        PlaneTable
            An equal table.

        Raises
        ------
        ParameterError
            If an entry is missing, not finite or of the wrong shape.
        """
        missing = {"values", "limit", "mean_free_path"} - set(arrays)
        if missing:
            raise ParameterError(f"this is no (a, b) table: {', '.join(sorted(missing))} missing")
        values = finite("values", arrays["values"])
        if values.ndim != 3 or values.shape[2] != 3 or min(values.shape[:2]) < 2:
            raise ParameterError(f"values has shape {values.shape}, expected (rows, columns, 3)")
        limit = float(finite("limit", arrays["limit"], ()))
        if limit <= 0.0:
            raise ParameterError("limit must be above 0")
        return cls(values, limit, finite("mean_free_path", arrays["mean_free_path"], (3,)))


def tabulate(table: PsiTable, size: int, limit: float) -> PlaneTable:
    """Return the (a, b) table that a psi table spans.

    Parameters
    ----------
    table : PsiTable
        Baked with enough samples.
    size : int
        Rows and columns.
    limit : float
        b of the last row.

    Returns
    -------
    PlaneTable
        Square, of `size` samples a side.
    """
    a = np.linspace(-1.0, 1.0, size)
    b = np.linspace(0.0, limit, size)[:, None]
    values = np.empty((size, size, 3))
    for channel, length in enumerate(table.mean_free_path):
        values[..., channel] = table.evaluate(a, b / length)[..., channel]
    values.setflags(write=False)
    return PlaneTable(values, limit, table.mean_free_path)
