"""MetaImage (.mha, .mhd with .raw), the format of ITK.

Own code: VTK's reader drops the orientation (TransformMatrix) and trusts the header's sizes, and no
other installed package reads it.
"""

import zlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from app.loading.errors import BadContentError
from app.volume.grid import Grid, check_header, placed
from app.volume.metaimage_header import data_files, header
from lutcore.arrays import AnyArray, FloatArray

_TYPES = {
    "MET_CHAR": "i1",
    "MET_UCHAR": "u1",
    "MET_SHORT": "i2",
    "MET_USHORT": "u2",
    "MET_INT": "i4",
    "MET_UINT": "u4",
    "MET_LONG": "i4",  # 4 bytes in this format, on every system
    "MET_ULONG": "u4",
    "MET_LONG_LONG": "i8",
    "MET_ULONG_LONG": "u8",
    "MET_FLOAT": "f4",
    "MET_DOUBLE": "f8",
}
_HEADER_READ = 1 << 16
# DistanceUnits is rare; without it the format's users take millimetres.
_UNITS = {"mm": 1.0, "um": 1e-3, "cm": 10.0, "m": 1000.0, "?": 1.0}


def read(files: tuple[Path, ...], memory: int) -> Grid:
    """Read a MetaImage.

    Parameters
    ----------
    files : tuple of Path
        The header's file first.
    memory : int
        Bytes of memory there are.

    Returns
    -------
    Grid
        Its voxels, in the file's own coordinates (ITK's: towards left, back and head).

    Raises
    ------
    BadContentError
        If it is damaged, cut short or of a kind that holds no plain volume.
    """
    path = files[0]
    with path.open("rb") as stream:
        content = stream.read(_HEADER_READ)
    fields, end = header(content)
    _refuse(fields)
    size = _numbers(fields, ("DimSize",), None)
    if not all(0 <= one < 2**31 and one == int(one) for one in size):  # a NaN is neither
        raise BadContentError(f"its DimSize is {fields.get('DimSize')!r}, expected whole numbers")
    shape = tuple(int(one) for one in size)
    kind = np.dtype(_TYPES[fields["ElementType"]])
    beside = data_files(path, content)
    if not beside and fields["ElementDataFile"] != "LOCAL":
        raise BadContentError(
            f"its data are a list of files ({fields['ElementDataFile']!r})",
            "save it with all slices in one file",
        )
    holder = beside[0] if beside else path
    packed = _true(fields, "CompressedData")
    at = _start(fields, end if not beside else 0, holder, shape, kind.itemsize)
    check_header(shape, kind.itemsize, holder.stat().st_size - at, memory, packed)
    raw = _data(holder, at, int(np.prod(shape)) * kind.itemsize, packed)
    big = _true(fields, "BinaryDataByteOrderMSB") or _true(fields, "ElementByteOrderMSB")
    values: AnyArray = np.frombuffer(raw, kind.newbyteorder(">" if big else "<"))
    unit = _unit(fields)
    spacing = np.array(_numbers(fields, ("ElementSpacing", "ElementSize"), (1.0, 1.0, 1.0))) * unit
    origin = np.array(_numbers(fields, ("Offset", "Position", "Origin"), (0.0, 0.0, 0.0))) * unit
    affine = placed(_directions(fields), spacing.tolist(), origin.tolist())
    return Grid(values.reshape(shape[::-1]).astype(np.float32), affine, True)


def _refuse(fields: dict[str, str]) -> None:
    if fields.get("NDims") != "3":
        raise BadContentError(
            f"it has {fields.get('NDims', 'an unknown number of')} dimensions, expected 3",
            "save one volume of it",
        )
    if fields.get("ElementType") not in _TYPES:
        raise BadContentError(
            f"its ElementType is {fields.get('ElementType')!r}, which is no kind of number",
            f"save it as one of {', '.join(_TYPES)}",
        )
    if fields.get("ElementNumberOfChannels", "1") != "1":
        raise BadContentError(
            f"each voxel has {fields['ElementNumberOfChannels']} numbers", "save one channel of it"
        )
    if fields.get("BinaryData", "True").lower() == "false":
        raise BadContentError("its voxels are text", "save it as binary data")


def _true(fields: dict[str, str], key: str) -> bool:
    return fields.get(key, "False").lower() in ("true", "1")


def _unit(fields: dict[str, str]) -> float:
    name = fields.get("DistanceUnits", "mm")
    if name not in _UNITS:
        raise BadContentError(f"its DistanceUnits are {name!r}", f"expected one of {list(_UNITS)}")
    return _UNITS[name]


def _numbers(
    fields: dict[str, str], keys: tuple[str, ...], default: tuple[float, ...] | None, count: int = 3
) -> list[float]:
    key = next((one for one in keys if one in fields), None)
    if key is None and default is not None:
        return list(default)
    try:
        found = [float(word) for word in fields[key or keys[0]].split()]
    except (KeyError, ValueError):
        found = []
    if len(found) != count:
        raise BadContentError(
            f"its {key or keys[0]} is {fields.get(key or keys[0], 'missing')!r}, expected {count} "
            "numbers"
        )
    return found


def _directions(fields: dict[str, str]) -> FloatArray:
    identity = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    keys = ("TransformMatrix", "Rotation", "Orientation")
    # Each row of the header's matrix is the direction of one axis.
    return np.array(_numbers(fields, keys, identity, 9)).reshape(3, 3).T


def _start(
    fields: dict[str, str], end: int, holder: Path, shape: tuple[int, ...], item: int
) -> int:
    given = fields.get("HeaderSize", "0")
    if given == "-1":  # the data are the last bytes of the file
        return max(holder.stat().st_size - int(np.prod(shape, dtype=object)) * item, 0)
    if not given.isdecimal():
        raise BadContentError(f"its HeaderSize is {given!r}")
    return max(end, int(given))


def _data(path: Path, start: int, size: int, packed: bool) -> bytes | NDArray[np.uint8]:
    with path.open("rb") as stream:
        stream.seek(start)
        if not packed:
            return stream.read(size)
        unpacker = zlib.decompressobj(wbits=47)
        try:
            raw = unpacker.decompress(stream.read(), size)
            # The checksum comes after the last byte.
            more = unpacker.decompress(unpacker.unconsumed_tail, 1)
        except zlib.error as error:
            raise BadContentError(f"its compressed data are damaged ({error})") from None
    if len(raw) < size or more:
        many = "more" if more else f"{len(raw)} bytes"
        raise BadContentError(f"its compressed data unfold to {many}, its header promises {size}")
    if not unpacker.eof:
        raise BadContentError("its compressed data have no end")
    return raw
