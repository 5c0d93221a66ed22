"""NIfTI (.nii, .nii.gz), read by nibabel."""

import gzip
import zlib
from pathlib import Path
from typing import Any, BinaryIO, cast

import numpy as np

from app.loading.errors import BadContentError
from app.volume.grid import PACKED, Grid, check_header
from app.volume.remarks import remarks

_GZIP = b"\x1f\x8b"
_MILLIMETRES = {"meter": 1000.0, "mm": 1.0, "micron": 1e-3, "unknown": 1.0}
_CHUNK = 1 << 20


def read(files: tuple[Path, ...], memory: int) -> Grid:
    """Read a NIfTI volume.

    Parameters
    ----------
    files : tuple of Path
        The file.
    memory : int
        Bytes of memory there are.

    Returns
    -------
    Grid
        Its voxels, scaled as its header says, in its world coordinates (RAS: towards right, front
        and head), mm.

    Raises
    ------
    BadContentError
        If it is damaged, cut short or holds something else than one number for each voxel.
    """
    from nibabel.filebasedimages import ImageFileError
    from nibabel.spatialimages import HeaderDataError
    from nibabel.wrapstruct import WrapStructError

    path = files[0]
    with path.open("rb") as stream:
        packed = stream.read(2) == _GZIP
    try:
        with gzip.open(path) if packed else path.open("rb") as stream:
            return _grid(cast(BinaryIO, stream), path.stat().st_size, memory, packed)
    except (EOFError, OSError, zlib.error) as error:
        raise BadContentError(f"its data cannot be read ({error})") from None
    except (
        HeaderDataError,
        ImageFileError,
        WrapStructError,
        ValueError,
        KeyError,
        OverflowError,
    ) as error:
        raise BadContentError(f"its header is not valid NIfTI ({error})") from None


def _grid(stream: BinaryIO, size: int, memory: int, packed: bool) -> Grid:
    from nibabel import Nifti1Image, Nifti2Image

    second = stream.read(8)[4:] == b"n+2\0"
    stream.seek(0)
    warnings: list[str] = []
    # It mends headers, and says how in its log.
    with remarks("nibabel.global", "nibabel", warnings):
        image = (Nifti2Image if second else Nifti1Image).from_stream(stream)
    shape, kind = image.shape, image.get_data_dtype()
    _check_kind(kind)
    check_header(shape[:3], kind.itemsize, size, memory, packed)
    more = int(np.prod(shape[3:], dtype=object))
    if more != 1:
        if more < 1:
            raise BadContentError(f"it holds {' x '.join(map(str, shape))} voxels")
        warnings.append(f"it holds {more} volumes ({shape[3:]}): the first is used")
    values = np.asarray(image.dataobj[(..., *([0] * (len(shape) - 3)))], np.float32)
    if packed:
        _read_on(stream, size)
    unit = image.header.get_xyzt_units()[0]
    if not (int(image.header["sform_code"]) or int(image.header["qform_code"])):
        warnings.append(
            "it states no orientation (sform and qform are 0): left and right may be exchanged"
        )
    affine = image.affine[:3] * _MILLIMETRES[unit]
    # scikit-image works on writable arrays only; nibabel maps the file.
    values = np.require(values.T, np.float32, ["C", "W"])
    return Grid(values, affine, unit != "unknown", warnings)


def _check_kind(kind: Any) -> None:
    if kind.fields is not None or kind.kind not in "iuf":
        raise BadContentError(
            f"its voxels are of type {kind}, not single numbers", "save it as a grey volume"
        )


def _read_on(stream: BinaryIO, size: int) -> None:
    """Read to the end, where gzip's checksum is: turned bits show nowhere else."""
    for _ in range(size * PACKED // _CHUNK + 1):
        if not stream.read(_CHUNK):
            return
