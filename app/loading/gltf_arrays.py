"""The numeric arrays of a glTF file (its accessors), every offset checked against the data."""

from typing import Any

import numpy as np

from app.loading.errors import BadContentError
from app.loading.gltf_buffers import Buffers
from app.loading.scene_size import GRANTED, GROWTH
from lutcore.arrays import AnyArray

_TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Arrays:
    """The accessors of one file.

    Parameters
    ----------
    document : dict
        The file's JSON.
    buffers : Buffers
        Where its numbers are.
    """

    def __init__(self, document: dict[str, Any], buffers: Buffers) -> None:
        self._document = document
        self._buffers = buffers

    def count(self, index: int) -> int:
        """Return the number of an accessor's values as it is declared, without looking at them.

        Parameters
        ----------
        index : int
            Its number.

        Returns
        -------
        int
            The length of what `get` returns, if the data are there.

        Raises
        ------
        BadContentError
            If there is no such accessor.
        """
        return _natural(_item(self._document, "accessors", index), "count")

    def get(self, index: int) -> AnyArray:
        """Return one accessor's values.

        Parameters
        ----------
        index : int
            Its number.

        Returns
        -------
        ndarray, shape=(count, width)
            Of the stored type; normalised whole numbers as floats.

        Raises
        ------
        BadContentError
            If it reaches beyond the data or lies outside this file.
        """
        accessor = _item(self._document, "accessors", index)
        dtype = np.dtype(_TYPES[accessor["componentType"]])
        width = _WIDTHS[accessor["type"]]
        count = _natural(accessor, "count")
        if "bufferView" in accessor:
            values = self._view(
                accessor["bufferView"], _natural(accessor, "byteOffset", 0), dtype, count, width
            )
        elif count * width * dtype.itemsize <= GRANTED + GROWTH * self._buffers.size:
            # Zeros that a sparse part fills; its size bounds what is worth allocating.
            values = np.zeros((count, width), dtype)
        else:
            raise BadContentError(f"accessor {index} has {count} values and no data")
        if "sparse" in accessor:
            values = self._sparse(accessor["sparse"], values)
        elif "bufferView" not in accessor:
            raise BadContentError(f"accessor {index} has no data")
        if accessor.get("normalized") and dtype.kind in "iu":
            return np.maximum(values / np.float64(np.iinfo(dtype).max), -1.0)
        return values

    def _sparse(self, sparse: dict[str, Any], values: AnyArray) -> AnyArray:
        count = _natural(sparse, "count")
        part = sparse["indices"]
        where = self._view(
            part["bufferView"],
            _natural(part, "byteOffset", 0),
            np.dtype(_TYPES[part["componentType"]]),
            count,
            1,
        )[:, 0]
        part = sparse["values"]
        new = self._view(
            part["bufferView"],
            _natural(part, "byteOffset", 0),
            values.dtype,
            count,
            values.shape[1],
        )
        if where.dtype.kind == "f" or (count and (where.min() < 0 or where.max() >= len(values))):
            raise BadContentError("a sparse accessor names values that do not exist")
        values = values.copy()
        values[where] = new
        return values

    def _view(
        self, index: int, offset: int, dtype: np.dtype[Any], count: int, width: int
    ) -> AnyArray:
        view = _item(self._document, "bufferViews", index)
        if "EXT_meshopt_compression" in view.get("extensions", {}):
            raise BadContentError("it is compressed with meshopt", "export it uncompressed")
        binary = self._buffers.get(view["buffer"])
        item = width * dtype.itemsize
        stride = _natural(view, "byteStride", 0) or item
        start = _natural(view, "byteOffset", 0) + offset
        needed = offset + (count - 1) * stride + item if count else 0
        length = _natural(view, "byteLength")
        if needed > length or start - offset + length > len(binary) or stride < item:
            raise BadContentError(
                f"bufferView {index} holds {length} bytes, {needed} are needed, and the file has "
                f"{len(binary)} bytes of data"
            )
        if count == 0:
            return np.empty((0, width), dtype)
        return np.ndarray((count, width), dtype, binary, start, (stride, dtype.itemsize))


def _item(document: dict[str, Any], name: str, index: int) -> dict[str, Any]:
    items = document.get(name, [])
    if not isinstance(index, int) or not 0 <= index < len(items):
        raise BadContentError(f"it refers to number {index} of its {len(items)} {name}")
    item: dict[str, Any] = items[index]
    return item


def _natural(holder: dict[str, Any], name: str, default: int | None = None) -> int:
    value = holder.get(name, default)
    if not isinstance(value, int) or not 0 <= value < 1 << 40:
        raise BadContentError(f"{name!r} is {value!r}")
    return value
