"""The tables of a text PLY file."""

from typing import Any

import numpy as np

from app.loading.errors import BadContentError
from app.loading.ply_header import Element, Header
from app.loading.ply_table import Table, cut_short, empty_table
from app.loading.text import numbers, whole
from lutcore.arrays import AnyArray


def read_tables(content: bytes, header: Header) -> tuple[dict[str, Table], int]:
    """Read the tables of a text file.

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
        Number of values after the last table.

    Raises
    ------
    BadContentError
        If the file ends too early or holds something that is no number.
    """
    values = numbers(content[header.body :], first_line=header.lines + 1)
    tables: dict[str, Table] = {}
    at = 0
    for element in header.elements:
        tables[element.name], at = _text_table(values, at, element)
    return tables, len(values) - at


def _text_table(values: AnyArray, at: int, element: Element) -> tuple[Table, int]:
    if element.rows == 0 or not element.properties:
        return empty_table(element), at
    table = Table()
    starts, at = _row_starts(values, at, element)
    for each in element.properties:
        if each.length is None:
            table.columns[each.name] = _as(values[starts], each.dtype)
            starts = starts + 1
            continue
        counts = whole(values[starts], "list lengths")
        first = np.cumsum(counts) - counts
        place = np.repeat(starts + 1 - first, counts) + np.arange(int(counts.sum()))
        table.lists[each.name] = _as(values[place], each.dtype), counts
        starts = starts + 1 + counts
    return table, at


def _row_starts(values: AnyArray, at: int, element: Element) -> tuple[AnyArray, int]:
    is_list = [each.length is not None for each in element.properties]
    rows = element.rows
    if at >= len(values):
        raise cut_short(element, 0)
    # All rows as wide as the first one, the rule; else one after another.
    width, place = 0, at
    checks: list[int] = []
    for each in is_list:
        if each:
            checks.append(width)
            if place + width >= len(values):
                raise cut_short(element, 0)
            length = values[place + width]
            width += 1 + (int(length) if 0 <= length < len(values) else 0)
        else:
            width += 1
    if at + rows * width <= len(values):
        table = values[at : at + rows * width].reshape(rows, width)
        if all((table[:, column] == table[0, column]).all() for column in checks):
            return np.arange(rows) * width + at, at + rows * width
    elif not checks:
        raise cut_short(element, (len(values) - at) // width)
    starts = np.empty(rows, dtype=np.int64)
    flat = values.tolist()
    for row in range(rows):
        starts[row] = at
        for each in is_list:
            if at >= len(flat):
                raise cut_short(element, row)
            if each:
                length = flat[at]
                if not 0 <= length <= len(flat):
                    raise BadContentError(f"row {row} of {element.name!r} has {length:g} values")
                at += int(length)
            at += 1
        if at > len(flat):
            raise cut_short(element, row)
    return starts, at


def _as(values: AnyArray, dtype: np.dtype[Any]) -> AnyArray:
    """Give text values their declared type where it matters: whole numbers, to scale colours."""
    if dtype.kind == "f":
        return values
    integers = whole(values, f"values declared as {dtype.name}")
    limits = np.iinfo(dtype)
    if len(integers) and (integers.min() < limits.min or integers.max() > limits.max):
        raise BadContentError(f"a value declared as {dtype.name} is outside its range")
    return integers.astype(dtype)
