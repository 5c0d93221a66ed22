"""Triangles over points of a rectangle whose sides may be joined (a band, a torus)."""

import numpy as np

from lutcore.arrays import FloatArray, IndexArray

# Copies of points across a joined side reach this many mean spacings: far more than the longest
# edge of a Delaunay triangulation of a hundred or more even-handedly random points.
_MARGIN = 12.0


def grid_cells(
    count: int, size: tuple[float, float], closed: tuple[bool, bool]
) -> tuple[FloatArray, IndexArray]:
    """Return a grid of points and its triangles, two to a cell.

    Parameters
    ----------
    count : int
        Points, nearly.
    size : tuple of float
        Sides of the rectangle.
    closed : tuple of bool
        For each axis, whether its ends are joined.

    Returns
    -------
    points : ndarray, shape=(n, 2)
        Points in the rectangle.
    faces : ndarray, shape=(m, 3)
        Triangles, counter-clockwise.
    """
    spacing = np.sqrt(size[0] * size[1] / count)
    cells = [max(4, round(side / spacing)) for side in size]
    places = [cell if loop else cell + 1 for cell, loop in zip(cells, closed, strict=True)]
    lines = [
        side / cell * np.arange(place)
        for side, cell, place in zip(size, cells, places, strict=True)
    ]
    points = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 2)
    i, j = np.meshgrid(np.arange(cells[0]), np.arange(cells[1]), indexing="ij")
    i_next, j_next = (i + 1) % places[0], (j + 1) % places[1]
    corner = [(p * places[1] + q).ravel() for p in (i, i_next) for q in (j, j_next)]
    faces = np.concatenate(
        [
            np.stack([corner[0], corner[2], corner[3]], axis=1),
            np.stack([corner[0], corner[3], corner[1]], axis=1),
        ]
    )
    return points, faces.astype(np.int32)


def delaunay_cells(
    points: FloatArray, size: tuple[float, float], closed: tuple[bool, bool]
) -> IndexArray:
    """Return the Delaunay triangles of points in a rectangle.

    Parameters
    ----------
    points : ndarray, shape=(n, 2)
        Points, 0 <= point <= size.
    size : tuple of float
        Sides of the rectangle.
    closed : tuple of bool
        For each axis, whether its ends are joined.

    Returns
    -------
    ndarray, shape=(m, 3)
        Triangles, counter-clockwise.
    """
    from scipy.spatial import Delaunay

    margin = _MARGIN * np.sqrt(size[0] * size[1] / len(points))
    index = np.arange(len(points))
    around = points
    for axis in range(2):
        if closed[axis]:
            low = around[:, axis] < margin
            high = around[:, axis] > size[axis] - margin
            shift = np.zeros(2)
            shift[axis] = size[axis]
            index = np.concatenate([index, index[low], index[high]])
            around = np.concatenate([around, around[low] + shift, around[high] - shift])
    faces = Delaunay(around).simplices
    corners = around[faces]
    # Of the copies of a triangle, keep the one whose centre lies in the rectangle.
    centre = corners.mean(axis=1)
    kept = np.ones(len(faces), np.bool_)
    for axis in range(2):
        if closed[axis]:
            kept &= (centre[:, axis] >= 0.0) & (centre[:, axis] < size[axis])
    corners, faces = corners[kept], faces[kept]
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    faces[area < 0.0] = faces[area < 0.0, ::-1]
    # Points in line along the rim leave triangles without area.
    solid = np.abs(area) > 1e-9 * size[0] * size[1] / len(points)
    return index[faces[solid]].astype(np.int32)
