"""Tables as files: npz for exact values, EXR and PNG for use as a texture.

An EXR or PNG holds one RGB image, as a texture wants it:

- psi table: 2 rows, `samples` columns. Row 0 is psi, row 1 dpsi/dt, over t = asinh(u) from 0 to the
  channel's reach.
- (a, b) table: rows are b from 0 to the limit, columns a from -1 to 1.

Everything else stands in a JSON text beside the pixels (EXR attribute or PNG text ``curvelight``).
EXR holds 32-bit floats. In PNG a pixel q of 16 bits stands for low + (high - low) q/65535, low and
high being given in that text for each channel, for a psi table by row. The values are raw data: no
sRGB or gamma encoding is applied, so that a texture of them must be read as linear.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np

from app.writing import replacing
from lutcore.arrays import AnyArray, FloatArray
from lutcore.errors import ParameterError
from lutcore.lut import PsiTable
from lutcore.plane import PlaneTable

Table = PsiTable | PlaneTable
_ENDINGS = (".npz", ".exr", ".png")
_KEY = "curvelight"
_RANGE = "range"
_LARGEST = 65535.0


def save_table(path: str | Path, table: Table) -> None:
    """Write a table; the file appears whole or not at all.

    Parameters
    ----------
    path : str or Path
        Ends in ``.npz`` (exact), ``.exr`` (32-bit float) or ``.png`` (16 bit).
    table : PsiTable or PlaneTable
        What `lutcore.bake` or `lutcore.baking.bake_plane` returned.

    Raises
    ------
    ParameterError
        If the ending is none of these.
    WriteError
        If the file cannot be written.
    """
    ending = _ending(path)
    with replacing(path) as beside:
        if ending == ".npz":
            with beside.open("wb") as stream:
                np.savez(stream, allow_pickle=False, **table.arrays())
        elif ending == ".exr":
            _write(beside, *_image(table), np.float32)
        else:
            _write(beside, *_quantised(*_image(table)), np.uint16)


def load_table(path: str | Path) -> Table:
    """Read a table that `save_table` wrote.

    Parameters
    ----------
    path : str or Path
        Ends in ``.npz``, ``.exr`` or ``.png``.

    Returns
    -------
    PsiTable or PlaneTable
        From npz the saved one to the last bit; from EXR within 6e-8 of each value; from PNG within
        8e-6 of the range of the values of each channel, by row of a psi table.

    Raises
    ------
    ParameterError
        If the ending is none of these, or the file holds no table.
    OSError
        If the file cannot be read.
    """
    ending = _ending(path)
    # A missing or forbidden file is an OSError, whatever the libraries would make of it.
    with Path(path).open("rb"):
        pass
    try:
        if ending == ".npz":
            with np.load(path, allow_pickle=False) as stored:
                arrays: dict[str, Any] = dict(stored)
        else:
            arrays = _arrays(*_read(path))
    except Exception as error:
        # Whatever a broken file makes a reader raise, it means the same to the user.
        raise ParameterError(f"{path} holds no table ({error})") from error
    return PsiTable.from_arrays(arrays) if "psi" in arrays else PlaneTable.from_arrays(arrays)


def _ending(path: str | Path) -> str:
    ending = Path(path).suffix.lower()
    if ending not in _ENDINGS:
        raise ParameterError.unknown("file ending for a table", ending, _ENDINGS)
    return ending


def _image(table: Table) -> tuple[FloatArray, dict[str, Any]]:
    arrays = table.arrays()
    if isinstance(table, PsiTable):
        pixels = np.stack([arrays.pop("psi").T, arrays.pop("slope").T])
    else:
        pixels = arrays.pop("values")
    return pixels, {name: array.tolist() for name, array in arrays.items()}


def _arrays(pixels: FloatArray, rest: dict[str, Any]) -> dict[str, AnyArray]:
    arrays = {name: np.asarray(value) for name, value in rest.items()}
    if "reach" in arrays:
        return {"psi": pixels[0].T, "slope": pixels[1].T, **arrays}
    return {"values": pixels, **arrays}


def _quantised(values: FloatArray, rest: dict[str, Any]) -> tuple[FloatArray, dict[str, Any]]:
    axes = (1,) if "reach" in rest else (0, 1)
    low, high = values.min(axis=axes, keepdims=True), values.max(axis=axes, keepdims=True)
    # A channel of one value only is all 0.
    pixels = np.rint((values - low) / np.where(high > low, high - low, 1.0) * _LARGEST)
    return pixels, {**rest, _RANGE: [low.tolist(), high.tolist()]}


def _write(path: Path, pixels: FloatArray, rest: dict[str, Any], kind: type[np.generic]) -> None:
    from OpenImageIO import ImageInput, ImageOutput, ImageSpec

    rows, columns, channels = pixels.shape
    spec = ImageSpec(columns, rows, channels, np.dtype(kind).name.replace("float32", "float"))
    spec.attribute("oiio:ColorSpace", "Linear")
    spec.attribute(_KEY, json.dumps(rest))
    output = ImageOutput.create(str(path))
    if output is None:
        raise OSError(f"no writer for {path.suffix} files")
    stored = pixels.astype(kind, order="C")
    good = output.open(str(path), spec) and output.write_image(stored)
    if not (good and output.close()):
        raise OSError(output.geterror())
    # The PNG writer does not tell of a full disk; tables are small, so reading back is cheap.
    again = ImageInput.open(str(path))
    written = None if again is None else again.read_image(spec.format)
    if written is None or not np.array_equal(written, stored):
        raise OSError("it was not written whole: the disk may be full")


def _read(path: str | Path) -> tuple[FloatArray, dict[str, Any]]:
    from OpenImageIO import FLOAT, UINT16, ImageInput, geterror

    source = ImageInput.open(str(path))
    if source is None:
        raise ParameterError(geterror())
    exact = source.spec().format == FLOAT
    # None where the pixels are broken.
    pixels = source.read_image(FLOAT if exact else UINT16)
    if pixels is None:
        raise ParameterError(source.geterror())
    rest = json.loads(source.spec().get_string_attribute(_KEY))
    values = pixels.astype(np.float64)
    if not exact:
        low, high = np.array(rest.pop(_RANGE))
        values = low + (high - low) * (values / _LARGEST)
    return values, rest
