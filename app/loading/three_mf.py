"""3MF: a zip with a model in XML; the objects that are to be built, each where it is placed.

Own code, since MeshLab reads it in a process that may die of it and tells no unit, and trimesh
needs packages that are not ours.
"""

import re

import numpy as np

from app.loading.colors import FACE_COLORS_UNUSED
from app.loading.errors import BadContentError
from app.loading.scene_size import check_scene_size
from app.loading.surface import RawSurface
from app.loading.three_mf_model import Model, ModelObject, Part, parse_model
from app.loading.zipped import Archive
from lutcore.arrays import AnyArray, FloatArray

_MM = {
    "micron": 0.001,
    "millimeter": 1.0,
    "centimeter": 10.0,
    "inch": 25.4,
    "foot": 304.8,
    "meter": 1000.0,
}
_RELATIONS = "_rels/.rels"
_ROOT = "3D/3dmodel.model"
_TARGET = re.compile(rb"<Relationship\b[^>]*>")
_MOST_PLACES, _MOST_DEPTH = 100_000, 100
_SUPPORTS = ("support", "solidsupport")


def read(content: bytes) -> RawSurface:
    """Read a 3MF file.

    Parameters
    ----------
    content : bytes
        The whole file.

    Returns
    -------
    RawSurface
        The objects of its build items, one after another, each with all of its vertices; an object
        that is placed twice is there twice. The size of its unit in millimetres.

    Raises
    ------
    BadContentError
        If the archive or its XML is damaged, or objects refer to others that are not there.
    """
    archive = Archive(content)
    root = _root(archive)
    models = {root: parse_model(archive.get(root), root)}
    main = models[root]
    warnings: list[str] = []
    if main.unit not in _MM:
        raise BadContentError(f"its unit is {main.unit!r}, none of {', '.join(_MM)}")
    items = main.items
    if not items and main.objects:
        warnings.append("it places no object: all are shown where they were made")
        used = {part.target for each in main.objects.values() for part in each.parts}
        items = [Part((root, name), None) for name in main.objects if (root, name) not in used]
    surface = _joined(_placed(items, models, archive, warnings), len(content))
    surface.warnings = list(dict.fromkeys(warnings))
    surface.mm_per_unit = _MM[main.unit]
    return surface


def _root(archive: Archive) -> str:
    if _RELATIONS in archive.names:
        for tag in _TARGET.findall(archive.get(_RELATIONS)):
            target = re.search(rb"\bTarget\s*=\s*[\"']([^\"']*)", tag)
            if target and re.search(rb"\bType\s*=\s*[\"'][^\"']*/3dmodel[\"']", tag):
                return target.group(1).decode("utf-8", "replace").lstrip("/")
    return _ROOT


def _placed(
    items: list[Part], models: dict[str, Model], archive: Archive, warnings: list[str]
) -> list[tuple[ModelObject, FloatArray]]:
    """List the objects with triangles, each as often as it is placed, with its transform."""
    placed: list[tuple[ModelObject, FloatArray]] = []
    waiting = [(item, np.eye(4), 0) for item in reversed(items)]
    places = len(waiting)
    while waiting:
        part, parent, depth = waiting.pop()
        path, name = part.target
        if path not in models:
            models[path] = parse_model(archive.get(path), path)
        found = models[path].objects.get(name)
        if found is None:
            raise BadContentError(f"it places object {name!r}, which {path} does not have")
        if found.kind in _SUPPORTS:
            warnings.append("supports are left out")
            continue
        # Rows times matrices, as the format has it.
        matrix = parent if part.transform is None else part.transform @ parent
        if found.colored:
            warnings.append(FACE_COLORS_UNUSED)
        if len(found.faces):
            placed.append((found, matrix))
        places += len(found.parts)
        if depth > _MOST_DEPTH or places > _MOST_PLACES:
            raise BadContentError(
                f"its components lie more than {_MOST_DEPTH} deep or are more than {_MOST_PLACES}",
                "check that no object is made of itself, or join its parts to one mesh",
            )
        waiting.extend((each, matrix, depth + 1) for each in reversed(found.parts))
    return placed


def _joined(placed: list[tuple[ModelObject, FloatArray]], size: int) -> RawSurface:
    check_scene_size(
        sum(len(each.vertices) for each, _ in placed),
        sum(each.faces.size for each, _ in placed),
        size,
    )
    vertices: list[FloatArray] = [np.empty((0, 3))]
    faces: list[AnyArray] = [np.empty((0, 3), np.int64)]
    offset = 0
    for each, matrix in placed:
        turned = np.linalg.det(matrix[:3, :3]) < 0.0  # a mirrored object is inside out
        vertices.append(each.vertices @ matrix[:3, :3] + matrix[3, :3])
        faces.append((each.faces[:, ::-1] if turned else each.faces) + offset)
        offset += len(each.vertices)
    return RawSurface.of_triangles(np.concatenate(vertices), np.concatenate(faces))
