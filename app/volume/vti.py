"""VTI, the XML image data of VTK, read by VTK."""

import re
from pathlib import Path
from typing import Any

import numpy as np

from app.loading.errors import BadContentError
from app.loading.vtp_vtk import raise_reported
from app.volume.grid import Grid, check_header, placed
from lutcore.arrays import AnyArray

_HEAD = 1 << 16
_EXTENT = re.compile(rb"\bWholeExtent\s*=\s*[\"']([^\"']*)[\"']")


def read(files: tuple[Path, ...], memory: int) -> Grid:
    """Read a VTI volume.

    Parameters
    ----------
    files : tuple of Path
        The file.
    memory : int
        Bytes of memory there are.

    Returns
    -------
    Grid
        Its active scalars, or else its first array with one number a point or, if there is none,
        a cell.

    Raises
    ------
    BadContentError
        If it is damaged, or VTK reports an error.
    """
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader

    path = files[0]
    _check(path, memory)
    log = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(log)
    reader = vtkXMLImageDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    raise_reported(log.GetOutput())
    image = reader.GetOutput()
    extent = np.array(image.GetExtent()).reshape(3, 2)
    array, centred = _array(image)
    size = extent[:, 1] - extent[:, 0] + (0 if centred else 1)
    values: AnyArray = vtk_to_numpy(array)
    if values.ndim != 1 or len(values) != np.prod(size):
        raise BadContentError("its array does not fit its extent")
    check_header(tuple(size.tolist()), values.dtype.itemsize, values.nbytes, memory)
    matrix = image.GetDirectionMatrix()
    directions = np.array([[matrix.GetElement(i, j) for j in range(3)] for i in range(3)])
    affine = placed(directions, image.GetSpacing(), image.GetOrigin())
    # VTK counts from the extent's beginning, and cells lie between points.
    first = extent[:, 0] + (0.5 if centred else 0.0)
    affine[:, 3] += affine[:, :3] @ first
    warnings = [f"its array {array.GetName()!r} is used"] if _several(image) else []
    return Grid(values.reshape(size[::-1]).astype(np.float32), affine, False, warnings)


def _check(path: Path, memory: int) -> None:
    """Compare the extent with the file's size before VTK takes memory for it."""
    with path.open("rb") as stream:
        head = stream.read(_HEAD)
    found = _EXTENT.search(head)
    try:
        ends = [int(word) for word in found[1].split()] if found else []
    except ValueError:
        ends = []
    if len(ends) != 6:
        raise BadContentError("its header states no WholeExtent of six whole numbers")
    points = [high - low + 1 for low, high in zip(ends[::2], ends[1::2], strict=True)]
    # Its values may be text or of any width: each takes at least a byte.
    check_header(points, 1, path.stat().st_size, memory, b"compressor" in head)


def _array(image: Any) -> tuple[Any, bool]:
    """Return the voxels and whether they are of cells."""
    for data, centred in ((image.GetPointData(), False), (image.GetCellData(), True)):
        arrays = [data.GetScalars(), *(data.GetArray(i) for i in range(data.GetNumberOfArrays()))]
        for array in arrays:
            if array is not None and array.GetNumberOfComponents() == 1:
                return array, centred
    raise BadContentError(
        "it holds no array with one number for each voxel", "save its grey values as scalars"
    )


def _several(image: Any) -> bool:
    return bool(
        image.GetPointData().GetNumberOfArrays() + image.GetCellData().GetNumberOfArrays() > 1
    )
