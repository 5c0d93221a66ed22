"""PLY, text and binary of both byte orders.

Own code, since trimesh refuses binary files that mix triangles with other polygons, fans polygons,
and cannot say where a file is wrong; VTK's reader dies of most files cut short.
"""

import numpy as np

from app.loading import ply_binary, ply_header, ply_text
from app.loading.colors import FACE_COLORS_UNUSED, normalized
from app.loading.errors import BadContentError
from app.loading.ply_table import Table
from app.loading.strips import strip_faces
from app.loading.surface import RawSurface
from app.loading.text import note_open_end
from lutcore.arrays import AnyArray, FloatArray
from lutcore.errors import MeshError

_COLOR_NAMES = (
    ("red", "green", "blue"),
    ("diffuse_red", "diffuse_green", "diffuse_blue"),
    ("r", "g", "b"),
)
_INDEX_NAMES = ("vertex_indices", "vertex_index")


def read(content: bytes) -> RawSurface:
    """Read a PLY file.

    Parameters
    ----------
    content : bytes
        The whole file.

    Returns
    -------
    RawSurface
        Its vertices, polygons (or triangle strips, taken apart) and vertex colours.

    Raises
    ------
    BadContentError
        If it is damaged or cut short.
    MeshError
        If it has no vertices with x, y and z.
    """
    header = ply_header.parse(content)
    tables, extra = (ply_text if header.ascii else ply_binary).read_tables(content, header)
    warnings: list[str] = []
    if header.ascii:
        note_open_end(content, warnings)
    if extra:
        warnings.append(f"{extra} {'values' if header.ascii else 'bytes'} after the end ignored")
    points = tables.get("vertex", Table()).columns
    if not {"x", "y", "z"} <= points.keys():
        raise MeshError("it holds no vertices with x, y and z")
    vertices = np.column_stack([points[name] for name in "xyz"]).astype(np.float64)
    corners, counts = _polygons(tables, warnings)
    if _color_names(tables.get("face", Table()).columns):
        warnings.append(FACE_COLORS_UNUSED)
    return RawSurface(vertices, corners, counts, _colors(points, warnings), warnings)


def _polygons(tables: dict[str, Table], warnings: list[str]) -> tuple[AnyArray, AnyArray]:
    lists = tables.get("face", Table()).lists
    for name in _INDEX_NAMES:
        if name in lists:
            corners, counts = lists[name]
            return _indices(corners), counts
    strips = tables.get("tristrips", Table()).lists
    for name in _INDEX_NAMES:
        if name in strips:
            faces = strip_faces(_indices(strips[name][0]), strips[name][1])
            warnings.append(f"{len(faces)} triangles come from triangle strips")
            return faces.reshape(-1), np.full(len(faces), 3)
    return np.empty(0, np.int64), np.empty(0, np.int64)


def _indices(corners: AnyArray) -> AnyArray:
    if corners.dtype.kind == "f":
        raise BadContentError("its face indices are declared as fractions", "export it again")
    # Most are whole numbers of 32 bits, as meshes keep them: twice as wide they take twice as long.
    return corners if corners.dtype == np.int32 else corners.astype(np.int64)


def _colors(points: dict[str, AnyArray], warnings: list[str]) -> FloatArray | None:
    names = _color_names(points)
    if names is None:
        return None
    return normalized(np.column_stack([points[name] for name in names]), warnings)


def _color_names(columns: dict[str, AnyArray]) -> tuple[str, str, str] | None:
    return next((names for names in _COLOR_NAMES if columns.keys() >= set(names)), None)
