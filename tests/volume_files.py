"""Volumes of known bodies, written in each format."""

import gzip
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
SPACING = (0.5, 0.75, 1.0)
RADIUS, MIDDLE = 6.0, np.array([30.0, -20.0, 5.0])


def rotation() -> Array:
    """Return a right-handed rotation by no round angle."""
    axis = np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0)
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + np.sin(0.7) * cross + (1.0 - np.cos(0.7)) * cross @ cross


def affine_of(directions: Array, shape: tuple[int, ...]) -> Array:
    """Return the affine (4, 4) that puts the middle of a grid at `MIDDLE`."""
    matrix = np.eye(4)
    matrix[:3, :3] = directions * SPACING
    matrix[:3, 3] = MIDDLE - matrix[:3, :3] @ ((np.array(shape) - 1) / 2.0)
    return matrix


def world(affine: Array, shape: tuple[int, ...]) -> Array:
    """Return the position (nx, ny, nz, 3) of each voxel."""
    index = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), -1)
    return index @ affine[:3, :3].T + affine[:3, 3]


def ball(affine: Array, shape: tuple[int, ...] = (34, 24, 18)) -> Array:
    """Return how far each voxel lies inside a ball around `MIDDLE`, as float32 (nx, ny, nz)."""
    distance = np.linalg.norm(world(affine, shape) - MIDDLE, axis=-1)
    return (RADIUS - distance).astype(np.float32)


def ring(affine: Array, major: float, minor: float, shape: tuple[int, ...]) -> Array:
    """Return how far each voxel lies inside a torus about the z axis through `MIDDLE`."""
    x, y, z = np.moveaxis(world(affine, shape) - MIDDLE, -1, 0)
    return (minor - np.hypot(np.hypot(x, y) - major, z)).astype(np.float32)


def nifti(path: Path, values: Array, affine: Array, unit: str = "mm", second: bool = False) -> None:
    """Write .nii or .nii.gz with nibabel."""
    import nibabel

    image = (nibabel.Nifti2Image if second else nibabel.Nifti1Image)(values, affine)
    image.header.set_xyzt_units(unit)
    nibabel.save(image, path)


def metaimage(path: Path, values: Array, affine: Array, packed: bool = False, **more: str) -> None:
    """Write .mha, or .mhd with its data beside it, byte by byte."""
    kinds = {"f4": "MET_FLOAT", "i2": "MET_SHORT", "u1": "MET_UCHAR", "f8": "MET_DOUBLE"}
    local = path.suffix == ".mha"
    spacing = np.linalg.norm(affine[:3, :3], axis=0)
    big = more.get("BinaryDataByteOrderMSB") == "True"
    raw = np.asarray(values, values.dtype.newbyteorder(">" if big else "<")).tobytes("F")
    raw = zlib.compress(raw) if packed else raw
    fields = {
        "ObjectType": "Image",
        "NDims": "3",
        "BinaryData": "True",
        "BinaryDataByteOrderMSB": "False",
        "CompressedData": str(packed),
        "TransformMatrix": _words((affine[:3, :3] / spacing).T.ravel()),
        "Offset": _words(affine[:3, 3]),
        "ElementSpacing": _words(spacing),
        "DimSize": _words(values.shape),
        "ElementType": kinds[values.dtype.str[1:]],
        **more,
        "ElementDataFile": "LOCAL" if local else path.with_suffix(".raw").name,
    }
    header = "".join(f"{key} = {value}\n" for key, value in fields.items()).encode()
    path.write_bytes(header + raw if local else header)
    if not local:
        path.with_suffix(".raw").write_bytes(raw)


def vti(path: Path, values: Array, affine: Array, cells: bool = False, binary: bool = True) -> None:
    """Write .vti with VTK."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

    spacing = np.linalg.norm(affine[:3, :3], axis=0)
    image = vtkImageData()
    # Its extent need not begin at 0; the origin is where index 0 would lie.
    first = np.array([3, 0, -2])
    points = np.array(values.shape) + (1 if cells else 0)
    image.SetExtent(*np.stack((first, first + points - 1), -1).ravel().tolist())
    image.SetSpacing(*spacing.tolist())
    image.SetDirectionMatrix(*(affine[:3, :3] / spacing).ravel().tolist())
    shift = first + (0.5 if cells else 0.0)
    image.SetOrigin(*(affine[:3, 3] - affine[:3, :3] @ shift).tolist())
    array = numpy_to_vtk(values.ravel(order="F"), deep=True)
    array.SetName("density")
    (image.GetCellData() if cells else image.GetPointData()).SetScalars(array)
    writer = vtkXMLImageDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(image)
    if not binary:
        writer.SetDataModeToAscii()
    writer.Write()


def tiff(path: Path, values: Array, kind: str = "imagej", **more: Any) -> None:
    """Write a stack of pages with `SPACING`, in mm, where the kind of file can say it."""
    import tifffile

    x, y, z = SPACING
    stack = np.ascontiguousarray(values.T)
    if kind == "imagej":
        meta = {"axes": "ZYX", "spacing": z, "unit": "mm"}
        tifffile.imwrite(path, stack, imagej=True, resolution=(1 / x, 1 / y), metadata=meta)
    elif kind == "ome":
        sizes = {"PhysicalSizeX": 1e3 * x, "PhysicalSizeY": 1e3 * y, "PhysicalSizeZ": 1e3 * z}
        tifffile.imwrite(path, stack, ome=True, metadata={"axes": "ZYX", **sizes})
    else:
        tifffile.imwrite(path, stack, **more)


def gzipped(path: Path, content: bytes) -> None:
    """Write bytes as gzip."""
    path.write_bytes(gzip.compress(content, mtime=0))


def _words(numbers: Any) -> str:
    return " ".join(repr(float(one)) if float(one) % 1 else str(int(one)) for one in numbers)
