"""STL, text and binary: triangles without shared vertices, three vertices each.

Own code, since trimesh returns the solids before the cut of a text file cut short as if they were
all, and takes no binary file with bytes after its end.
"""

import re
import struct

import numpy as np

from app.loading.colors import FACE_COLORS_UNUSED
from app.loading.errors import BadContentError
from app.loading.surface import RawSurface
from app.loading.text import line_of, numbers

_HEADER = 84
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX = re.compile(rb"\bvertex\b([^\n]*)", re.IGNORECASE)
_TEXT = re.compile(rb"\s*solid\b.*?(?:facet|endsolid)\b", re.IGNORECASE | re.DOTALL)
# VisCAM marks a triangle's colour by this bit of its attribute, Materialise by this word in the
# header.
_HAS_COLOR, _COLOR_WORD = 0x8000, b"COLOR="
_FACET = re.compile(rb"(?<!end)facet\b", re.IGNORECASE)
_SOLID = re.compile(rb"^[ \t]*(end ?)?solid\b", re.IGNORECASE | re.MULTILINE)


def read(content: bytes) -> RawSurface:
    """Read an STL file.

    Parameters
    ----------
    content : bytes
        The whole file.

    Returns
    -------
    RawSurface
        Three vertices for each triangle, in the file's order.

    Raises
    ------
    BadContentError
        If it is damaged or cut short.
    """
    # A binary header may begin with "solid", too, but is filled up with zeros and holds no lines.
    is_text = _TEXT.match(content[:4096]) and b"\0" not in content[:4096]
    return _read_text(content) if is_text else _read_binary(content)


def _read_binary(content: bytes) -> RawSurface:
    if len(content) < _HEADER:
        raise BadContentError(f"it is too short for an STL header: {len(content)} bytes of 84")
    (count,) = struct.unpack_from("<I", content, 80)
    expected = _HEADER + 50 * count
    if len(content) < expected:
        raise BadContentError(
            f"its header promises {count} triangles ({expected} bytes), the file has "
            f"{len(content)} bytes"
        )
    records = np.frombuffer(content, _RECORD, count, _HEADER)
    vertices = records["corners"].reshape(-1, 3).astype(np.float64)
    surface = RawSurface.of_triangles(vertices, np.arange(3 * count).reshape(-1, 3))
    if len(content) > expected:
        surface.warnings.append(f"{len(content) - expected} bytes after the last triangle ignored")
    if (records["attribute"] & _HAS_COLOR).any() or _COLOR_WORD in content[:80]:
        surface.warnings.append(FACE_COLORS_UNUSED)
    return surface


def _read_text(content: bytes) -> RawSurface:
    content = content.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    ends = [bool(match.group(1)) for match in _SOLID.finditer(content)]
    if not ends or not ends[-1] or ends.count(True) != ends.count(False):
        raise BadContentError(f"line {line_of(content, len(content))}: it ends before 'endsolid'")
    lines = _VERTEX.findall(content)
    facets = len(_FACET.findall(content))
    if len(lines) != 3 * facets:
        raise BadContentError(f"it has {facets} facets but {len(lines)} vertices, not three each")
    if set(map(len, map(bytes.split, lines))) - {3}:
        wrong = next(m for m in _VERTEX.finditer(content) if len(m.group(1).split()) != 3)
        raise BadContentError(
            f"line {line_of(content, wrong.start())}: a vertex without exactly three coordinates"
        )
    vertices = numbers(b"\n".join(lines), first_line=None).reshape(-1, 3)
    return RawSurface.of_triangles(vertices, np.arange(3 * facets).reshape(-1, 3))
