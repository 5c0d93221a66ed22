"""OFF and its kin COFF, NOFF, CNOFF, STOFF: counts, a line per vertex, a line per polygon.

Own code, since trimesh passes over colours and fans concave polygons.
"""

import re

import numpy as np

from app.loading.colors import FACE_COLORS_UNUSED, normalized
from app.loading.errors import BadContentError
from app.loading.surface import RawSurface
from app.loading.text import note_open_end, numbers, whole
from lutcore.arrays import AnyArray, FloatArray

_KEYWORD = re.compile(rb"\s*(ST)?(C)?(N)?(4)?(n)?OFF\b[ \t]*(BINARY\b)?")
# The shortest vertex line is "0 0 0", the shortest face line "3 0 1 2", each with its line end.
_LEAST_VERTEX, _LEAST_FACE = 6, 2


def read(content: bytes) -> RawSurface:
    """Read an OFF file.

    Parameters
    ----------
    content : bytes
        The whole file.

    Returns
    -------
    RawSurface
        Its vertices, polygons and vertex colours.

    Raises
    ------
    BadContentError
        If it is damaged, cut short, or has other than three dimensions.
    """
    text = re.sub(rb"#[^\n]*", b"", content.replace(b"\r\n", b"\n").replace(b"\r", b"\n"))
    keyword = _KEYWORD.match(text)
    if keyword is None:
        raise BadContentError("it does not begin with OFF", "check that it is an OFF file")
    if keyword.group(4) or keyword.group(5):
        raise BadContentError("it is not three-dimensional", "export it with x, y and z alone")
    if keyword.group(6):
        raise BadContentError("it is a binary OFF file", "save it as text OFF or as PLY")
    lines = [line for line in text[keyword.end() :].split(b"\n") if line.strip()]
    vertex_count, face_count = _counts(lines, len(text))
    warnings: list[str] = []
    note_open_end(content, warnings)
    vertices, colors = _vertices(lines[1 : 1 + vertex_count], keyword, warnings)
    rows = lines[1 + vertex_count : 1 + vertex_count + face_count]
    corners, counts = _faces(rows, warnings)
    return RawSurface(vertices, corners, counts, colors, warnings)


def _counts(lines: list[bytes], size: int) -> tuple[int, int]:
    found = whole(numbers(lines[0], first_line=None), "counts") if lines else np.empty(0)
    if len(found) < 2 or (found < 0).any():
        raise BadContentError("it does not say how many vertices and faces it has")
    vertex_count, face_count = int(found[0]), int(found[1])
    if vertex_count * _LEAST_VERTEX + face_count * _LEAST_FACE > size:
        raise BadContentError(
            f"it promises {vertex_count} vertices and {face_count} faces, more than its "
            f"{size} bytes can hold"
        )
    if len(lines) - 1 < vertex_count + face_count:
        raise BadContentError(
            f"it promises {vertex_count} vertices and {face_count} faces and ends after "
            f"{len(lines) - 1} of {vertex_count + face_count} lines"
        )
    return vertex_count, face_count


def _vertices(
    lines: list[bytes], keyword: re.Match[bytes], warnings: list[str]
) -> tuple[FloatArray, FloatArray | None]:
    widths = np.fromiter(map(len, map(bytes.split, lines)), np.int64)
    width = int(widths[0]) if len(widths) else 3
    # The order of the format: position, normal, colour, texture coordinate.
    start = 6 if keyword.group(3) else 3
    if width < start:
        raise BadContentError(f"vertex 0 has {width} numbers, expected at least {start}")
    if (widths != width).any():
        odd = int(np.argmax(widths != width))
        raise BadContentError(f"vertex {odd} has {widths[odd]} numbers, those before it {width}")
    table = numbers(b"\n".join(lines), first_line=None).reshape(-1, width)
    end = width - (2 if keyword.group(1) else 0)
    colors = None
    # Writers put colours after the position without the C in the keyword, too.
    if len(lines) and end - start in (3, 4):
        colors = normalized(table[:, start : start + 3], warnings)
    return np.ascontiguousarray(table[:, :3]), colors


def _faces(lines: list[bytes], warnings: list[str]) -> tuple[AnyArray, AnyArray]:
    widths = np.fromiter(map(len, map(bytes.split, lines)), np.int64)
    table = numbers(b"\n".join(lines), first_line=None)
    starts = np.cumsum(widths) - widths
    counts = whole(table[starts], "numbers of face corners")
    bad = (counts < 0) | (counts >= widths)
    if bad.any():
        face = int(np.argmax(bad))
        raise BadContentError(
            f"face {face} (from 0) has {widths[face] - 1} numbers, expected {counts[face]} corners"
        )
    # What follows the corners of a face is its colour.
    if (widths > counts + 1).any():
        warnings.append(FACE_COLORS_UNUSED)
    inside = np.arange(len(table)) - np.repeat(starts, widths)
    corner = (inside >= 1) & (inside <= np.repeat(counts, widths))
    return whole(table[corner], "face indices"), counts
