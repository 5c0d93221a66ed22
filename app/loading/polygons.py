"""Polygons to triangles.

Quadrilaterals are split along a diagonal that lies inside; they are by far the most frequent and
need no library. Polygons with more corners go through VTK's ear clipping: a fan from the first
corner would fold over where the polygon is concave.
"""

import numpy as np

from app.loading.errors import BadContentError
from lutcore.arrays import AnyArray, FloatArray

# Ear clipping takes a time that grows with the square of a polygon's corners, about 1.4 ns each.
_MOST_WORK = 1e10


def triangulated(
    vertices: FloatArray, corners: AnyArray, counts: AnyArray, warnings: list[str]
) -> AnyArray:
    """Split every polygon into triangles, in the polygons' order.

    Parameters
    ----------
    vertices : ndarray, shape=(n, 3)
        Finite positions.
    corners : ndarray of int, shape=(c,)
        Vertex indices of all polygons, in range.
    counts : ndarray of int, shape=(f,)
        Number of corners of each polygon, at least 3.
    warnings : list of str
        Gets a line about polygons that cross themselves.

    Returns
    -------
    ndarray of int, shape=(m, 3)
        Triangles of the polygons' orientation; count - 2 of each polygon.

    Raises
    ------
    BadContentError
        If there are polygons of so many corners that splitting them would take minutes.
    """
    if (counts == 3).all():
        return corners.reshape(-1, 3)
    starts = np.cumsum(counts) - counts
    pieces = []
    owners = []
    for width, split in ((3, _triangles), (4, _quads)):
        which = np.flatnonzero(counts == width)
        pieces.append(split(vertices, corners[starts[which, None] + np.arange(width)]))
        owners.append(np.repeat(which, width - 2))
    many = np.flatnonzero(counts > 4)
    if len(many):
        if float(np.sum(counts[many].astype(np.float64) ** 2)) > _MOST_WORK:
            raise BadContentError(
                f"it has polygons of up to {counts.max()} corners", "triangulate it first"
            )
        faces, which = _ears(vertices, corners[np.repeat(counts > 4, counts)], counts[many])
        short = _unsplit(counts[many], which)
        if len(short):
            warnings.append(
                f"{len(short)} polygons cross themselves or have no area: split as fans"
            )
            whole = ~np.isin(which, short)
            faces, which = faces[whole], which[whole]
            for each in many[short]:
                pieces.append(_fan(corners[starts[each] : starts[each] + counts[each]]))
                owners.append(np.full(counts[each] - 2, each))
        pieces.append(faces)
        owners.append(many[which])
    order = np.argsort(np.concatenate(owners), kind="stable")
    return np.concatenate(pieces)[order]


def _triangles(vertices: FloatArray, triangles: AnyArray) -> AnyArray:
    return triangles


def _fan(polygon: AnyArray) -> AnyArray:
    first = np.full(len(polygon) - 2, polygon[0])
    return np.column_stack((first, polygon[1:-1], polygon[2:]))


def _quads(vertices: FloatArray, quads: AnyArray) -> AnyArray:
    a, b, c, d = (vertices[quads[:, i]] for i in range(4))
    # A diagonal lies inside where both of its triangles face the same way.
    inside_ac = np.einsum("ij,ij->i", np.cross(b - a, c - a), np.cross(c - a, d - a)) > 0.0
    inside_bd = np.einsum("ij,ij->i", np.cross(c - b, d - b), np.cross(d - b, a - b)) > 0.0
    shorter_ac = np.sum((c - a) ** 2, axis=1) <= np.sum((d - b) ** 2, axis=1)
    along_ac = np.where(inside_ac == inside_bd, shorter_ac, inside_ac)
    split = np.where(along_ac[:, None], quads[:, [0, 1, 2, 0, 2, 3]], quads[:, [1, 2, 3, 1, 3, 0]])
    return split.reshape(-1, 3)


def _ears(vertices: FloatArray, corners: AnyArray, counts: AnyArray) -> tuple[AnyArray, AnyArray]:
    """Return triangles and the polygon each came from; fewer where VTK found no ear."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkFiltersCore import vtkTriangleFilter

    used, local = np.unique(corners, return_inverse=True)
    points = vtkPoints()
    # Deep copies, for VTK would go on using memory that NumPy may have freed.
    points.SetData(numpy_to_vtk(np.ascontiguousarray(vertices[used]), deep=True))
    offsets = np.concatenate(([0], np.cumsum(counts))).astype(np.int64)
    polygons = vtkCellArray()
    polygons.SetData(
        numpy_to_vtkIdTypeArray(offsets, deep=True),
        numpy_to_vtkIdTypeArray(np.ascontiguousarray(local, dtype=np.int64), deep=True),
    )
    owner = numpy_to_vtk(np.arange(len(counts)), deep=True)
    owner.SetName("polygon")
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(polygons)
    data.GetCellData().AddArray(owner)
    clip = vtkTriangleFilter()
    clip.SetInputData(data)
    clip.Update()
    out = clip.GetOutput()
    if out.GetNumberOfPolys() == 0:
        return np.empty((0, 3), dtype=np.int64), np.empty(0, dtype=np.int64)
    faces = vtk_to_numpy(out.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return used[faces], vtk_to_numpy(out.GetCellData().GetArray("polygon")).astype(np.int64)


def _unsplit(counts: AnyArray, which: AnyArray) -> AnyArray:
    return np.flatnonzero(np.bincount(which, minlength=len(counts)) != counts - 2)
