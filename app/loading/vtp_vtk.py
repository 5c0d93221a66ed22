"""The part of reading VTK's own files that calls VTK; runs in the child process only."""

import re
from typing import Any

import numpy as np

from app.loading.colors import FACE_COLORS_UNUSED, normalized
from app.loading.errors import BadContentError
from app.loading.strips import strip_faces
from app.loading.surface import RawSurface
from app.loading.vtk_cells import cells, grid_polygons
from lutcore.arrays import AnyArray, FloatArray
from lutcore.errors import MeshError

_COLOR_NAMES = ("rgb", "rgba", "color", "colors", "vertex_colors", "vertexcolors")


def read(content: bytes) -> RawSurface:
    """Read a VTP, VTU or legacy VTK file with VTK.

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
    lutcore.errors.MeshError
        If it holds data of a kind that has no surface.
    """
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

    log = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(log)
    reader = _reader(content)
    reader.Update()
    raise_reported(log.GetOutput())
    data = reader.GetOutput()
    if data is None:
        raise BadContentError("VTK finds no data in it")
    if not (data.IsA("vtkPolyData") or data.IsA("vtkUnstructuredGrid")):
        kind = data.GetClassName().removeprefix("vtk")
        raise MeshError(f"it holds data of VTK's kind {kind}, which have no triangles or polygons")
    points = data.GetPoints()
    if points is None or points.GetNumberOfPoints() == 0:
        return RawSurface(np.empty((0, 3)), np.empty(0, np.int64), np.empty(0, np.int64))
    vertices = np.array(vtk_to_numpy(points.GetData()), dtype=np.float64)
    warnings: list[str] = []
    if data.IsA("vtkPolyData"):
        corners, counts = _polygons(data, warnings)
    else:
        corners, counts = grid_polygons(data, warnings)
    if _color_array(data.GetCellData()) is not None:
        warnings.append(FACE_COLORS_UNUSED)
    return RawSurface(vertices, corners, counts, _colors(data.GetPointData(), warnings), warnings)


def _reader(content: bytes) -> Any:
    from vtkmodules.vtkIOLegacy import vtkDataSetReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

    reader: Any
    if content.startswith(b"# vtk"):
        reader = vtkDataSetReader()
        reader.ReadFromInputStringOn()
        reader.SetBinaryInputString(content, len(content))
        return reader
    grid = b"<UnstructuredGrid" in content[:4096]
    reader = vtkXMLUnstructuredGridReader() if grid else vtkXMLPolyDataReader()
    reader.ReadFromInputStringOn()
    reader.SetInputString(content)
    return reader


def _polygons(data: Any, warnings: list[str]) -> tuple[AnyArray, AnyArray]:
    corners, counts = cells(data.GetPolys())
    strips, lengths = cells(data.GetStrips())
    if len(strips):
        faces = strip_faces(strips, lengths)
        warnings.append(f"{len(faces)} triangles come from triangle strips")
        corners = np.concatenate((corners, faces.reshape(-1)))
        counts = np.concatenate((counts, np.full(len(faces), 3)))
    return corners, counts


def raise_reported(log: str) -> None:
    """Turn what VTK wrote to its output window into an error.

    Parameters
    ----------
    log : str
        All that it wrote.

    Raises
    ------
    BadContentError
        If there is an error among it.
    """
    # "ERROR: In file.cxx, line 1" / "vtkXMLDataParser (0x5): what is wrong", one pair each.
    found = re.search(r"ERR(?:OR)?[:|].*?\n?.*?\(0x[0-9a-f]+\): *([^\n]*)", log[:4000], re.DOTALL)
    if found:
        raise BadContentError(f"VTK says: {found.group(1).strip()}")
    if "ERR" in log:
        raise BadContentError(f"VTK says: {' '.join(log.split())[:200]}")


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
