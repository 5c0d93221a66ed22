"""The part of reading VTP that calls VTK; runs in the child process only."""

import re
from typing import Any

import numpy as np

from app.loading.colors import FACE_COLORS_UNUSED, normalized
from app.loading.errors import BadContentError
from app.loading.strips import strip_faces
from app.loading.surface import RawSurface
from lutcore.arrays import AnyArray, FloatArray

_COLOR_NAMES = ("rgb", "rgba", "color", "colors", "vertex_colors", "vertexcolors")


def read(content: bytes) -> RawSurface:
    """Read a VTP file with VTK.

    Parameters
    ----------
    content : bytes
        The whole file.

    Returns
    -------
    RawSurface
        Its points, polygons or triangle strips, and colours.

    Raises
    ------
    BadContentError
        If VTK reports an error or returns arrays that do not fit together.
    """
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    log = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(log)
    reader = vtkXMLPolyDataReader()
    reader.ReadFromInputStringOn()
    reader.SetInputString(content)  # type: ignore[call-overload]  # takes bytes as well
    reader.Update()
    _raise_reported(log.GetOutput())
    data = reader.GetOutput()
    points = data.GetPoints()
    if points is None or points.GetNumberOfPoints() == 0:
        return RawSurface(np.empty((0, 3)), np.empty(0, np.int64), np.empty(0, np.int64))
    vertices = np.array(vtk_to_numpy(points.GetData()), dtype=np.float64)
    warnings: list[str] = []
    corners, counts = _cells(data.GetPolys())
    strips, lengths = _cells(data.GetStrips())
    if len(strips):
        faces = strip_faces(strips, lengths)
        warnings.append(f"{len(faces)} triangles come from triangle strips")
        corners = np.concatenate((corners, faces.reshape(-1)))
        counts = np.concatenate((counts, np.full(len(faces), 3)))
    if _color_array(data.GetCellData()) is not None:
        warnings.append(FACE_COLORS_UNUSED)
    return RawSurface(vertices, corners, counts, _colors(data.GetPointData(), warnings), warnings)


def _raise_reported(log: str) -> None:
    # "ERROR: In file.cxx, line 1" / "vtkXMLDataParser (0x5): what is wrong", one pair each.
    found = re.search(r"ERR(?:OR)?[:|].*?\n?.*?\(0x[0-9a-f]+\): *([^\n]*)", log[:4000], re.DOTALL)
    if found:
        raise BadContentError(f"VTK says: {found.group(1).strip()}")
    if "ERR" in log:
        raise BadContentError(f"VTK says: {' '.join(log.split())[:200]}")


def _cells(cells: Any) -> tuple[AnyArray, AnyArray]:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    if cells is None or cells.GetNumberOfCells() == 0:
        return np.empty(0, np.int64), np.empty(0, np.int64)
    corners = np.array(vtk_to_numpy(cells.GetConnectivityArray()), dtype=np.int64)
    offsets = np.array(vtk_to_numpy(cells.GetOffsetsArray()), dtype=np.int64)
    counts = np.diff(offsets)
    if offsets[0] != 0 or (counts < 0).any() or offsets[-1] != len(corners):
        raise BadContentError("its cell offsets do not fit its connectivity")
    return corners, counts


def _colors(attributes: Any, warnings: list[str]) -> FloatArray | None:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    array = _color_array(attributes)
    return None if array is None else normalized(vtk_to_numpy(array), warnings)


def _color_array(attributes: Any) -> Any:
    for index in range(attributes.GetNumberOfArrays()):
        array = attributes.GetArray(index)
        if array is None or (array.GetName() or "").lower() not in _COLOR_NAMES:
            continue
        if array.GetNumberOfComponents() in (3, 4):
            return array
    return None
