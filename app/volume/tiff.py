"""TIFF stacks: one file of many pages, or a folder of slices, read by tifffile."""

from pathlib import Path
from typing import Any

import numpy as np

from app.loading.errors import BadContentError
from app.volume.grid import Grid, check_header, placed
from app.volume.remarks import remarks
from app.volume.tiff_spacing import spacing_of
from lutcore.arrays import AnyArray

_STORED_PLAIN, _WHITE_IS_ZERO = 1, 0
_ADVICE = "save its pages grey, all of one size, uncompressed or with Deflate"


def read(files: tuple[Path, ...], memory: int) -> Grid:
    """Read a stack.

    Parameters
    ----------
    files : tuple of Path
        One file of many pages, or several of one page each, in the stack's order.
    memory : int
        Bytes of memory there are.

    Returns
    -------
    Grid
        Its voxels: x along the rows, y down them, z along the stack, so that the axes are
        right-handed for a camera that looks along z.

    Raises
    ------
    BadContentError
        If it is damaged, has colours, or its slices do not fit together.
    """
    warnings: list[str] = []
    try:
        with remarks("tifffile", "tifffile", warnings):
            values, spacing, known = _stack(files, memory, warnings)
    except (BadContentError, MemoryError):
        raise
    except Exception as error:
        # Damage shows in tifffile as anything: division by 0, failed assertions, missing keys.
        raise BadContentError(f"tifffile cannot read it ({error!r})", _ADVICE) from None
    affine = placed(np.eye(3), spacing, (0.0, 0.0, 0.0))
    return Grid(np.require(values, np.float32, ["C", "W"]), affine, known, warnings)


def _stack(
    files: tuple[Path, ...], memory: int, warnings: list[str]
) -> tuple[AnyArray, tuple[float, float, float], bool]:
    from tifffile import TiffFile

    with TiffFile(files[0]) as first:
        series = first.series[0]
        spacing, known = spacing_of(first)
        if spacing is None:
            warnings.append("it states no spacing: a voxel is taken as a cube of 1 mesh unit")
        if int(first.pages[0].photometric) == _WHITE_IS_ZERO:
            warnings.append("it stores white as 0: its values are used as they are stored")
        if len(files) == 1:
            if len(first.series) > 1:
                warnings.append(f"it holds {len(first.series)} stacks: the first is used")
            values = _volume(series, files[0].stat().st_size, memory, warnings)
            return values, spacing or (1.0, 1.0, 1.0), known
        shape, kind = _slice_shape(series), series.dtype
        packed = _packed(first.pages[0])
    stored = sum(one.stat().st_size for one in files)
    check_header((len(files), *shape), kind.itemsize, stored, memory, packed)
    values = np.empty((len(files), *shape), np.float32)
    for layer, path in zip(values, files, strict=True):
        layer[:] = _slice(path, shape, kind)
    return values, spacing or (1.0, 1.0, 1.0), known


def _volume(series: Any, stored: int, memory: int, warnings: list[str]) -> AnyArray:
    axes, shape = series.axes, series.shape
    _check_grey(series)
    # Stacks that do not name their third axis Z (ImageJ's I, shaped arrays' Q, time) have one.
    long = [i for i, count in enumerate(shape[:-2]) if count > 1]
    depth = axes.index("Z") if "Z" in axes else (long[0] if len(long) == 1 else -1)
    if axes[-2:] != "YX" or depth < 0:
        kind = "x".join(map(str, shape))
        raise BadContentError(f"its pages are {kind} along {axes}, which is no volume", _ADVICE)
    more = int(np.prod([shape[i] for i in long if i != depth], dtype=object))
    size = (shape[depth], *shape[-2:])
    _check_segments(series, stored)
    check_header(size, series.dtype.itemsize * more, stored, memory, _packed(series.keyframe))
    if more > 1:
        warnings.append(f"it holds {more} volumes (axes {axes}): the first is used")
    values: AnyArray = series.asarray(maxworkers=1)
    chosen = tuple(
        slice(None) if i == depth or i >= len(shape) - 2 else 0 for i in range(len(shape))
    )
    return values[chosen]


def _slice_shape(series: Any) -> tuple[int, int]:
    _check_grey(series)
    shape = tuple(count for count in series.shape if count > 1)
    if len(shape) != 2:
        raise BadContentError("a file of the folder holds more than one picture", _ADVICE)
    return shape[0], shape[1]


def _slice(path: Path, shape: tuple[int, int], kind: Any) -> AnyArray:
    from tifffile import TiffFile

    with TiffFile(path) as file:
        series = file.series[0]
        if _slice_shape(series) != shape or series.dtype != kind:
            raise BadContentError(
                f"its slice {path.name} has {series.shape} pixels of {series.dtype}, the first "
                f"has {shape} of {kind}",
                "keep only the slices of one scan in the folder",
            )
        _check_segments(series, path.stat().st_size)
        return np.asarray(series.asarray(maxworkers=1)).reshape(shape)


def _check_grey(series: Any) -> None:
    if "S" in series.axes or series.dtype.kind not in "biuf":
        raise BadContentError("its pixels are colours, not single numbers", _ADVICE)


def _check_segments(series: Any, stored: int) -> None:
    """Refuse a file cut short: tifffile would fill what is missing with zeros."""
    for number, page in enumerate(series.pages):
        if page is None:
            raise BadContentError(f"its page {number} (from 0) is missing")
        ends = [
            start + count
            for start, count in zip(page.dataoffsets, page.databytecounts, strict=True)
        ]
        if not ends or max(ends) > stored:
            raise BadContentError(f"page {number} (from 0) reaches beyond the end of the file")
    if series.dataoffset is not None and series.dataoffset + series.nbytes > stored:
        raise BadContentError(
            f"its pages take {series.nbytes} bytes, more than the file's {stored}"
        )


def _packed(page: Any) -> bool:
    return int(page.compression) != _STORED_PLAIN or page.bitspersample < 8
