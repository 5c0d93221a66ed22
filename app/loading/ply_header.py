"""The header of a PLY file, and whether the file can be as large as it says."""

import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from app.loading.errors import BadContentError

# "element vertex 10" promises ten lines; no header needs more than this.
_LONGEST_HEADER = 1 << 20
# Gaussian splats, the widest tables about, have 62; each one costs an array.
_MOST_PROPERTIES = 1000
# A line of its own, for comments may hold the word. The first data byte follows exactly one line
# end, which may be CR LF.
_END = re.compile(rb"(?<![^\r\n])[ \t]*end_header[ \t]*(?:\r\n|\r|\n|\Z)")
_TYPES = {
    "char": "i1",
    "uchar": "u1",
    "short": "i2",
    "ushort": "u2",
    "int": "i4",
    "uint": "u4",
    "float": "f4",
    "double": "f8",
    "int8": "i1",
    "uint8": "u1",
    "int16": "i2",
    "uint16": "u2",
    "int32": "i4",
    "uint32": "u4",
    "int64": "i8",
    "uint64": "u8",
    "float32": "f4",
    "float64": "f8",
}
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass(frozen=True)
class Property:
    """One property of an element.

    Parameters
    ----------
    name : str
        Its name in the file.
    dtype : dtype
        Type of the value, or of each value of a list, in the file's byte order.
    length : dtype or None
        Type of the list's length; None if it is no list.
    """

    name: str
    dtype: np.dtype[Any]
    length: np.dtype[Any] | None = None


@dataclass(frozen=True)
class Element:
    """One table of the file.

    Parameters
    ----------
    name : str
        ``"vertex"``, ``"face"`` or anything else.
    rows : int
        Number of its rows.
    properties : tuple of Property
        Its columns.
    """

    name: str
    rows: int
    properties: tuple[Property, ...]

    @property
    def least(self) -> int:
        """Bytes that a binary row has at least, its lists being empty."""
        return sum((each.length or each.dtype).itemsize for each in self.properties)


@dataclass(frozen=True)
class Header:
    """What a PLY file says it holds.

    Parameters
    ----------
    ascii : bool
        Whether the tables are text.
    elements : tuple of Element
        The tables in the file's order.
    body : int
        Offset of the first byte after the header.
    lines : int
        Number of lines of the header.
    """

    ascii: bool
    elements: tuple[Element, ...]
    body: int
    lines: int


def parse(content: bytes) -> Header:
    """Read the header and refuse counts that the file is too small for.

    Parameters
    ----------
    content : bytes
        The whole file.

    Returns
    -------
    Header
        Its tables.

    Raises
    ------
    BadContentError
        If it cannot be understood, or promises more than the file can hold.
    """
    end = _END.search(content, 0, _LONGEST_HEADER)
    if end is None:
        raise BadContentError("its header has no line 'end_header'")
    text = content[: end.start()].decode("latin-1")
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    order, elements = _elements(lines)
    header = Header(order == "", elements, end.end(), len(lines))
    _check_size(header, len(content) - header.body)
    return header


def _elements(lines: list[str]) -> tuple[str, tuple[Element, ...]]:
    order: str | None = None
    counts: dict[str, int] = {}
    columns: dict[str, dict[str, Property]] = {}
    last: dict[str, Property] = {}
    for number, line in enumerate(lines, start=1):
        try:
            match line.split():
                case ["format", encoding, _] if order is None:
                    order = _ORDERS[encoding]
                case ["element" | "property", *_] if order is None:
                    raise _refusal(number, line, ", before the line 'format'")
                case ["element", name, _] if name in counts:
                    raise _refusal(number, line, ", and that element is there already")
                case ["element", name, count] if int(count) >= 0:
                    counts[name] = int(count)
                    last = columns[name] = {}
                case ["property", *words] if order is not None and counts:
                    added = _property(words, order)
                    if added.name in last:
                        raise _refusal(number, line, ", and that property is there already")
                    if len(last) == _MOST_PROPERTIES:
                        raise _refusal(number, line, f", after {_MOST_PROPERTIES} others")
                    last[added.name] = added
                case ["format" | "element" | "property", *_]:
                    raise ValueError
                case _:
                    # Comments, obj_info, and whatever else a writer adds.
                    continue
        except (KeyError, ValueError):
            raise _refusal(number, line) from None
    if order is None:
        raise BadContentError("its header does not name a format")
    return order, tuple(
        Element(name, count, tuple(columns[name].values())) for name, count in counts.items()
    )


def _refusal(number: int, line: str, why: str = "") -> BadContentError:
    shown = line[:60].encode("ascii", "backslashreplace").decode()
    return BadContentError(f"line {number} of its header is {shown!r}{why}")


def _property(words: list[str], order: str) -> Property:
    match words:
        case ["list", length, item, name]:
            counter = np.dtype(order + _TYPES[length])
            if counter.kind == "f":
                raise ValueError
            return Property(name, np.dtype(order + _TYPES[item]), counter)
        case [kind, name]:
            return Property(name, np.dtype(order + _TYPES[kind]))
        case _:
            raise ValueError


def _check_size(header: Header, size: int) -> None:
    for element in header.elements:
        # A number in text takes a digit and a separator, if it is not the last.
        least = 2 * len(element.properties) if header.ascii else element.least
        if element.rows * least > size + 1:
            raise BadContentError(
                f"its header promises {element.rows} rows of {element.name!r}, at least "
                f"{element.rows * least} bytes, and {size} bytes follow"
            )
