"""The tables of a binary PLY file."""

from typing import Any, Literal

import numpy as np

from app.loading.errors import BadContentError
from app.loading.ply_header import Element, Header, Property
from app.loading.ply_table import Table, cut_short, empty_table
from lutcore.arrays import AnyArray


def read_tables(content: bytes, header: Header) -> tuple[dict[str, Table], int]:
    """Read the tables of a binary file.

    Parameters
    ----------
    content : bytes
        The whole file.
    header : Header
        Its header.

    Returns
    -------
    dict of str to Table
        Each element's values.
    int
        Number of bytes after the last table.

    Raises
    ------
    BadContentError
        If the file ends too early.
    """
    tables: dict[str, Table] = {}
    at = header.body
    for element in header.elements:
        if element.rows == 0 or not element.properties:
            tables[element.name] = empty_table(element)
            continue
        table, at = _uniform(content, at, element) or _walked(content, at, element)
        tables[element.name] = table
    return tables, len(content) - at


def _uniform(content: bytes, at: int, element: Element) -> tuple[Table, int] | None:
    """Read all rows at once if every list is as long as the first row's; else None."""
    fields: list[tuple[str, np.dtype[Any]] | tuple[str, np.dtype[Any], tuple[int]]] = []
    place = at
    for index, each in enumerate(element.properties):
        if each.length is None:
            fields.append((f"value{index}", each.dtype))
            place += each.dtype.itemsize
            continue
        if place + each.length.itemsize > len(content):
            raise cut_short(element, 0)
        length = int(np.frombuffer(content, each.length, 1, place)[0])
        if not 0 <= length * each.dtype.itemsize <= len(content):
            return None
        fields += [(f"length{index}", each.length), (f"value{index}", each.dtype, (length,))]
        place += each.length.itemsize + length * each.dtype.itemsize
    record = np.dtype(fields)
    if element.rows * record.itemsize > len(content) - at:
        if all(each.length is None for each in element.properties):
            raise cut_short(element, (len(content) - at) // record.itemsize)
        return None
    rows = np.frombuffer(content, record, element.rows, at)
    table = Table()
    for index, each in enumerate(element.properties):
        values = rows[f"value{index}"]
        if each.length is None:
            table.columns[each.name] = values
            continue
        lengths = rows[f"length{index}"]
        if (lengths != lengths[0]).any():
            return None
        table.lists[each.name] = values.reshape(-1), lengths.astype(np.int64)
    return table, at + element.rows * record.itemsize


def _walked(content: bytes, at: int, element: Element) -> tuple[Table, int]:
    """Read rows whose lists differ in length, one after another."""
    places: list[list[int]] = [[] for _ in element.properties]
    lengths: list[list[int]] = [[] for _ in element.properties]
    steps = [_step(each) for each in element.properties]
    size = len(content)
    for row in range(element.rows):
        for index, (width, counter, order, signed) in enumerate(steps):
            length = 1
            if counter:
                length = int.from_bytes(content[at : at + counter], order, signed=signed)
                at += counter
                if length < 0:
                    raise BadContentError(f"row {row} of {element.name!r} has {length} values")
            places[index].append(at)
            lengths[index].append(length)
            at += width * length
        if at > size:
            raise cut_short(element, row)
    table = Table()
    raw = np.frombuffer(content, np.uint8)
    for index, each in enumerate(element.properties):
        count = np.array(lengths[index], dtype=np.int64)
        values = _gathered(raw, np.array(places[index], dtype=np.int64), count, each.dtype)
        if each.length is None:
            table.columns[each.name] = values
        else:
            table.lists[each.name] = values, count
    return table, at


def _step(each: Property) -> tuple[int, int, Literal["big", "little"], bool]:
    """Return the sizes of a value and of a list's length (0: no list), its order and sign."""
    if each.length is None:
        return each.dtype.itemsize, 0, "little", False
    # A type of one byte has no order of its own, and needs none.
    order: Literal["big", "little"] = "big" if each.length.str[0] == ">" else "little"
    return each.dtype.itemsize, each.length.itemsize, order, each.length.kind == "i"


def _gathered(raw: AnyArray, places: AnyArray, counts: AnyArray, dtype: np.dtype[Any]) -> AnyArray:
    starts = np.cumsum(counts) - counts
    item = np.repeat(places - starts * dtype.itemsize, counts)
    item += np.arange(len(item)) * dtype.itemsize
    return raw[item[:, None] + np.arange(dtype.itemsize)].reshape(-1).view(dtype)
