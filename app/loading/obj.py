"""Wavefront OBJ: the positions ``v`` in their order and the faces ``f``, all groups together.

Own code, since trimesh splits vertices by their texture coordinates and normals and regroups the
faces by material, which changes count and order, and counts negative indices from the file's end.
"""

import re
from pathlib import Path

import numpy as np

from app.loading.colors import normalized
from app.loading.errors import BadContentError
from app.loading.obj_texture import texture_of
from app.loading.surface import RawSurface
from app.loading.text import line_of, note_open_end, numbers, whole
from lutcore.arrays import AnyArray, FloatArray

_VERTEX = re.compile(rb"^[ \t]*v[ \t]+([^\n#]*)", re.MULTILINE)
_FACE = re.compile(rb"^[ \t]*fo?[ \t]+([^\n#]*)", re.MULTILINE)
_TEXTURE_AND_NORMAL = re.compile(rb"/[^\s]*")
_WITH_COLOR = 6


def read(content: bytes, folder: Path) -> RawSurface:
    """Read an OBJ file; normals, groups and all of materials but textures are passed over.

    Parameters
    ----------
    content : bytes
        The whole file.
    folder : Path
        Where it lies, for its textures.

    Returns
    -------
    RawSurface
        Its vertices, polygons, and colours where lines read ``v x y z r g b``.

    Raises
    ------
    BadContentError
        If a line cannot be understood.
    """
    lines = content.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    # As long as before, so that a place in the one is the same place in the other.
    joined = lines.replace(b"\\\n", b"  ")
    warnings: list[str] = []
    note_open_end(lines, warnings)
    vertices, colors = _vertices(joined, lines, warnings)
    corners, counts = _faces(joined, len(vertices))
    surface = RawSurface(vertices, corners, counts, colors, warnings)
    lines_of_faces = list(_FACE.finditer(joined)) if b"mtllib" in joined else []
    surface.texture = texture_of(joined, lines_of_faces, counts, folder, warnings, surface.others)
    return surface


def _vertices(
    content: bytes, unjoined: bytes, warnings: list[str]
) -> tuple[FloatArray, FloatArray | None]:
    lines = _VERTEX.findall(content)
    if not lines:
        raise BadContentError("it has no vertex lines 'v x y z'", "check that it is an OBJ file")
    widths = set(map(len, map(bytes.split, lines)))
    if min(widths) < 3:
        wrong = next(m for m in _VERTEX.finditer(content) if len(m.group(1).split()) < 3)
        raise BadContentError(
            f"line {line_of(unjoined, wrong.start())}: a vertex with fewer than three coordinates"
        )
    if len(widths) > 1:
        if max(widths) >= _WITH_COLOR:
            warnings.append("only some vertices have a colour: colours are not used")
        lines = [b" ".join(line.split()[:3]) for line in lines]
        widths = {3}
    (width,) = widths
    table = _table(content, unjoined, lines).reshape(-1, width)
    colors = normalized(table[:, 3:], warnings) if width >= _WITH_COLOR else None
    return np.ascontiguousarray(table[:, :3]), colors


def _table(content: bytes, unjoined: bytes, lines: list[bytes]) -> FloatArray:
    try:
        return numbers(b"\n".join(lines), first_line=None)
    except BadContentError as error:
        for match in _VERTEX.finditer(content):
            try:
                numbers(match.group(1), first_line=None)
            except BadContentError as here:
                line = line_of(unjoined, match.start())
                raise BadContentError(f"line {line}: {here.problem}") from None
        raise error


def _faces(content: bytes, vertex_count: int) -> tuple[AnyArray, AnyArray]:
    lines = _FACE.findall(content)
    joined = _TEXTURE_AND_NORMAL.sub(b"", b"\n".join(lines))
    counts = np.fromiter(map(len, map(bytes.split, joined.split(b"\n"))), np.int64)
    if not lines:
        counts = counts[:0]
    corners = whole(numbers(joined, first_line=None), "face indices")
    if len(corners) != counts.sum():
        raise BadContentError("a face line holds something other than indices")
    if (corners == 0).any():
        raise BadContentError("a face uses vertex 0, and OBJ counts from 1")
    relative = corners < 0
    if relative.any():
        # Relative to the vertices read so far, not to the file's last one.
        starts = np.fromiter((m.start() for m in _VERTEX.finditer(content)), np.int64)
        places = np.fromiter((m.start() for m in _FACE.finditer(content)), np.int64)
        before = np.repeat(np.searchsorted(starts, places), counts)
        corners[relative] += before[relative] + 1
        if (corners < 1).any():
            raise BadContentError("a face counts back beyond the first vertex")
    return corners - 1, counts
