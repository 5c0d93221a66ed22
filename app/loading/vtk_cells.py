"""VTK's cells as polygons; runs in the child process only."""

from typing import Any

import numpy as np

from app.loading.errors import BadContentError
from lutcore.arrays import AnyArray
from lutcore.errors import MeshError

# VTK's numbers of cell types, and how many of a cell's points are its corners; the others lie
# between them. A polygon's are all.
_TRIANGLE, _POLYGON, _PIXEL, _QUAD = 5, 7, 8, 9
_CURVED = {22: 3, 34: 3, 23: 4, 28: 4, 30: 4, 37: 4}
_LARGEST_FLAT = 9  # up to here: points, lines, and what is listed above


def cells(found: Any) -> tuple[AnyArray, AnyArray]:
    """Return the corners of a cell array.

    Parameters
    ----------
    found : vtkCellArray or None
        The cells.

    Returns
    -------
    ndarray of int64, shape=(c,)
        Their points, one cell after another.
    ndarray of int64, shape=(f,)
        How many each has.

    Raises
    ------
    BadContentError
        If its two arrays do not fit together.
    """
    from vtkmodules.util.numpy_support import vtk_to_numpy

    if found is None or found.GetNumberOfCells() == 0:
        return np.empty(0, np.int64), np.empty(0, np.int64)
    corners = np.array(vtk_to_numpy(found.GetConnectivityArray()), dtype=np.int64)
    offsets = np.array(vtk_to_numpy(found.GetOffsetsArray()), dtype=np.int64)
    counts = np.diff(offsets)
    if offsets[0] != 0 or (counts < 0).any() or offsets[-1] != len(corners):
        raise BadContentError("its cell offsets do not fit its connectivity")
    return corners, counts


def grid_polygons(grid: Any, warnings: list[str]) -> tuple[AnyArray, AnyArray]:
    """Return the triangles, quadrilaterals and polygons among the cells of a grid.

    Parameters
    ----------
    grid : vtkUnstructuredGrid
        The grid.
    warnings : list of str
        Gets a line about cells that are left out or made flat.

    Returns
    -------
    ndarray of int64, shape=(c,)
        Their corners, one after another.
    ndarray of int64, shape=(f,)
        How many each has.

    Raises
    ------
    BadContentError
        If its arrays do not fit together.
    lutcore.errors.MeshError
        If it has cells, and none of them is a face.
    """
    corners, counts = cells(grid.GetCells())
    if len(counts) == 0:
        return corners, counts
    # One by one: the array of them all is called otherwise from one version of VTK to the next.
    types = np.array([grid.GetCellType(cell) for cell in range(len(counts))], dtype=np.int64)
    least = np.zeros(len(counts), dtype=np.int64)
    for kind, corner_count in ((_TRIANGLE, 3), (_PIXEL, 4), (_QUAD, 4), *_CURVED.items()):
        least[types == kind] = corner_count
    least[types == _POLYGON] = counts[types == _POLYGON]
    if (counts < least).any():
        cell = int(np.argmax(counts < least))
        raise BadContentError(f"cell {cell} (from 0) has {counts[cell]} points, too few")
    solid = (least == 0) & (types > _LARGEST_FLAT)
    if not least.any() and solid.any():
        raise MeshError(f"its {len(counts)} cells are volumes, and none is a face")
    if solid.any():
        warnings.append(f"{np.count_nonzero(solid)} cells that are no flat faces: left out")
    if np.isin(types, list(_CURVED)).any():
        warnings.append("curved faces are taken as flat: the points between corners are unused")
    starts = np.cumsum(counts) - counts
    # The corners come first in every cell that is kept.
    where = np.arange(len(corners)) - np.repeat(starts, counts)
    kept = where < np.repeat(least, counts)
    pixels = starts[types == _PIXEL]
    # A pixel's points go row by row, not round it.
    corners[pixels + 2], corners[pixels + 3] = corners[pixels + 3], corners[pixels + 2]
    return corners[kept], least[least > 0]
