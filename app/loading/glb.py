"""GLB, the one-file form of glTF 2.0: all triangles of the scene in world coordinates.

Own code, since trimesh ignores normalised and sparse accessors and fans (vertices come out wrong
or missing without a word) and lets indices out of range pass; VTK's reader can kill the process.
"""

import json
import struct
from typing import Any

import numpy as np

from app.loading.colors import normalized
from app.loading.errors import BadContentError
from app.loading.gltf_arrays import Arrays
from app.loading.gltf_scene import placed_primitives
from app.loading.strips import fan_faces, strip_faces
from app.loading.surface import RawSurface
from lutcore.arrays import AnyArray, FloatArray
from lutcore.color import srgb_encode

_JSON, _BIN = 0x4E4F534A, 0x004E4942
_TRIANGLES = 4
_MODES = (_TRIANGLES, 5, 6)
# A few kilobytes may place one mesh again and again: as much memory as a million vertices and twice
# as many faces take is always granted, and beyond that this many bytes for each of the file.
_GRANTED, _GROWTH = 72_000_000, 64
_VERTEX_BYTES, _CORNER_BYTES = 24, 8
_COMPRESSIONS = ("KHR_draco_mesh_compression", "EXT_meshopt_compression")


def read(content: bytes) -> RawSurface:
    """Read a GLB file.

    Parameters
    ----------
    content : bytes
        The whole file.

    Returns
    -------
    RawSurface
        The primitives of the scene's nodes, one after another, each with all of its vertices; a
        mesh that two nodes use is there twice. Colours are sRGB-encoded, as everywhere; the
        format stores them linear (glTF 2.0, section 3.7.2.1).

    Raises
    ------
    BadContentError
        If it is damaged, cut short or compressed.
    """
    document, binary = _chunks(content)
    try:
        return _surface(document, Arrays(document, binary), len(content))
    except (KeyError, TypeError, ValueError, AttributeError, IndexError, OverflowError) as error:
        # The JSON may hold anything anywhere; what does not fit shows as one of these.
        raise BadContentError(f"its JSON is not valid glTF ({error!r})") from error


def _chunks(content: bytes) -> tuple[dict[str, Any], bytes]:
    if len(content) < 20:
        raise BadContentError(f"it is too short for a GLB header: {len(content)} bytes")
    _, version, total = struct.unpack_from("<4sII", content)
    if version != 2:
        raise BadContentError(f"it is GLB version {version}", "export it as glTF 2.0")
    if total > len(content):
        raise BadContentError(f"its header promises {total} bytes, the file has {len(content)}")
    chunks: dict[int, bytes] = {}
    at = 12
    while at + 8 <= total:
        length, kind = struct.unpack_from("<II", content, at)
        at += 8
        if at + length > total:
            raise BadContentError(f"a chunk of {length} bytes at byte {at} reaches beyond its end")
        chunks.setdefault(kind, content[at : at + length])
        at += length
    try:
        document = json.loads(chunks.get(_JSON, b""))
    except (ValueError, RecursionError) as error:
        raise BadContentError(f"its JSON cannot be read ({error})") from error
    if not isinstance(document, dict):
        raise BadContentError("its JSON is not a glTF document")
    return document, chunks.get(_BIN, b"")


def _surface(document: dict[str, Any], arrays: Arrays, size: int) -> RawSurface:
    for name in document.get("extensionsRequired", []):
        if name in _COMPRESSIONS:
            raise BadContentError(f"it is compressed ({name})", "export it uncompressed")
    vertices: list[FloatArray] = [np.empty((0, 3))]
    faces: list[AnyArray] = [np.empty((0, 3), np.int64)]
    colors: list[FloatArray | None] = []
    warnings: list[str] = []
    offset = 0
    placed = placed_primitives(document)
    drawn = [each for each in placed if each[0].get("mode", _TRIANGLES) in _MODES]
    skipped = len(placed) - len(drawn)
    _check_size(arrays, [primitive for primitive, _ in drawn], size)
    for primitive, matrix in drawn:
        points = _positions(arrays, primitive)
        found = _faces(arrays, primitive, len(points))
        if np.linalg.det(matrix[:3, :3]) < 0.0:
            # A mirrored node turns its faces inside out (glTF 2.0, section 3.7.4).
            found = found[:, ::-1]
        vertices.append(points @ matrix[:3, :3].T + matrix[:3, 3])
        faces.append(found + offset)
        colors.append(_colors(arrays, primitive, len(points), warnings))
        offset += len(points)
    if skipped:
        warnings.append(f"{skipped} parts made of points or lines are left out")
    surface = RawSurface.of_triangles(np.concatenate(vertices), np.concatenate(faces))
    surface.colors = _joined(colors, vertices[1:], warnings)
    # A part that is placed twice is complained of twice.
    surface.warnings = list(dict.fromkeys(warnings))
    return surface


def _check_size(arrays: Arrays, primitives: list[dict[str, Any]], size: int) -> None:
    """Refuse a scene too large for its file, before any of it is expanded."""
    vertices = corners = 0
    for primitive in primitives:
        count = arrays.count(primitive["attributes"]["POSITION"])
        vertices += count
        corners += arrays.count(primitive["indices"]) if "indices" in primitive else count
    if _VERTEX_BYTES * vertices + _CORNER_BYTES * corners > _GRANTED + _GROWTH * size:
        raise BadContentError(
            f"its scene has {vertices} vertices and {corners} face corners, out of a file of "
            f"{size} bytes",
            "check that it is not damaged, or export fewer copies of its meshes",
        )


def _positions(arrays: Arrays, primitive: dict[str, Any]) -> FloatArray:
    points = arrays.get(primitive["attributes"]["POSITION"])
    if points.shape[1] != 3:
        raise BadContentError("its positions have other than three coordinates")
    return points.astype(np.float64)


def _faces(arrays: Arrays, primitive: dict[str, Any], vertex_count: int) -> AnyArray:
    if "indices" in primitive:
        stored = arrays.get(primitive["indices"])
        if stored.dtype.kind != "u" or stored.shape[1] != 1:
            raise BadContentError("its face indices are not whole numbers")
        corners = stored[:, 0].astype(np.int64)
    else:
        corners = np.arange(vertex_count)
    outside = np.flatnonzero(corners >= vertex_count)
    if len(outside):
        # Checked here, for an index beyond one part would be a vertex of the next.
        raise BadContentError(
            f"{len(outside)} face corners use vertices that do not exist, the first is vertex "
            f"{corners[outside[0]]} of {vertex_count}"
        )
    match primitive.get("mode", _TRIANGLES):
        case 5:
            return strip_faces(corners, np.array([len(corners)]))
        case 6:
            return fan_faces(corners)
        case _:
            if len(corners) % 3:
                raise BadContentError(f"{len(corners)} face corners are not triangles")
            return corners.reshape(-1, 3)


def _colors(
    arrays: Arrays, primitive: dict[str, Any], count: int, warnings: list[str]
) -> FloatArray | None:
    if "COLOR_0" not in primitive["attributes"]:
        return None
    stored = arrays.get(primitive["attributes"]["COLOR_0"])
    if len(stored) != count or stored.shape[1] not in (3, 4):
        warnings.append("a part's colours do not fit its vertices: not used")
        return None
    # Floats are 0 to 1 (glTF 2.0, section 3.7.2.1).
    linear = normalized(stored, warnings, floats_are_shares=True)
    return None if linear is None else srgb_encode(linear)


def _joined(
    colors: list[FloatArray | None], vertices: list[FloatArray], warnings: list[str]
) -> FloatArray | None:
    if all(part is None for part in colors):
        return None
    if any(part is None for part in colors):
        warnings.append("some parts have no vertex colours: white there")
    return np.concatenate(
        [
            np.ones((len(points), 3)) if part is None else part
            for part, points in zip(colors, vertices, strict=True)
        ]
    )
