"""A glTF document's triangles in world coordinates."""

from typing import Any

import numpy as np

from app.loading.colors import normalized
from app.loading.errors import BadContentError
from app.loading.gltf_arrays import Arrays
from app.loading.gltf_buffers import Buffers
from app.loading.gltf_scene import placed_primitives
from app.loading.gltf_texture import Textures
from app.loading.scene_size import check_scene_size
from app.loading.strips import fan_faces, strip_faces
from app.loading.surface import RawSurface
from lutcore.arrays import AnyArray, FloatArray
from lutcore.color import srgb_encode

_TRIANGLES = 4
_MODES = (_TRIANGLES, 5, 6)
_COMPRESSIONS = ("KHR_draco_mesh_compression", "EXT_meshopt_compression")


def scene_surface(document: Any, buffers: Buffers) -> RawSurface:
    """Join the primitives of the scene's nodes.

    Parameters
    ----------
    document : object
        The JSON, which may hold anything anywhere.
    buffers : Buffers
        Where its numbers are.

    Returns
    -------
    RawSurface
        One primitive after another, each with all of its vertices; a mesh that two nodes use is
        there twice. Colours are sRGB-encoded, as everywhere; the format stores them linear (glTF
        2.0, section 3.7.2.1).

    Raises
    ------
    BadContentError
        If it is damaged, cut short or compressed.
    """
    if not isinstance(document, dict):
        raise BadContentError("its JSON is not a glTF document")
    try:
        return _surface(document, Arrays(document, buffers), buffers)
    except (
        KeyError,
        TypeError,
        ValueError,
        AttributeError,
        IndexError,
        OverflowError,
        RecursionError,
    ) as error:
        # What does not fit shows as one of these.
        raise BadContentError(f"its JSON is not valid glTF ({error!r:.200})") from error


def _surface(document: dict[str, Any], arrays: Arrays, buffers: Buffers) -> RawSurface:
    for name in document.get("extensionsRequired", []):
        if name in _COMPRESSIONS:
            raise BadContentError(f"it is compressed ({name})", "export it uncompressed")
    vertices: list[FloatArray] = [np.empty((0, 3))]
    faces: list[AnyArray] = [np.empty((0, 3), np.int64)]
    colors: list[FloatArray | None] = []
    warnings: list[str] = []
    textures = Textures(document, arrays, buffers, warnings)
    offset = 0
    placed = placed_primitives(document)
    drawn = [each for each in placed if each[0].get("mode", _TRIANGLES) in _MODES]
    skipped = len(placed) - len(drawn)
    _check_size(arrays, [primitive for primitive, _ in drawn], buffers.size)
    for primitive, matrix in drawn:
        points = _positions(arrays, primitive)
        found = _faces(arrays, primitive, len(points))
        if np.linalg.det(matrix[:3, :3]) < 0.0:
            # A mirrored node turns its faces inside out (glTF 2.0, section 3.7.4).
            found = found[:, ::-1]
        vertices.append(points @ matrix[:3, :3].T + matrix[:3, 3])
        faces.append(found + offset)
        textures.add(primitive, found, len(points))
        colors.append(_colors(arrays, primitive, len(points), warnings))
        offset += len(points)
    if skipped:
        warnings.append(f"{skipped} parts made of points or lines are left out")
    surface = RawSurface.of_triangles(np.concatenate(vertices), np.concatenate(faces))
    surface.colors = _joined(colors, vertices[1:], warnings)
    # A part that is placed twice is complained of twice.
    surface.warnings = list(dict.fromkeys(warnings))
    surface.texture = textures.joined()
    surface.others = buffers.others
    return surface


def _check_size(arrays: Arrays, primitives: list[dict[str, Any]], size: int) -> None:
    """Refuse a scene too large for its file, before any of it is expanded."""
    vertices = corners = 0
    for primitive in primitives:
        count = arrays.count(primitive["attributes"]["POSITION"])
        vertices += count
        corners += arrays.count(primitive["indices"]) if "indices" in primitive else count
    check_scene_size(vertices, corners, size)


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
    index = primitive["attributes"]["COLOR_0"]
    # Counted first: a part of three vertices must not unfold millions of colours.
    stored = arrays.get(index) if arrays.count(index) == count else None
    if stored is None or stored.shape[1] not in (3, 4):
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
