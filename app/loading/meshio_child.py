"""The part of reading that calls meshio; runs in the child process only."""

from pathlib import Path
from typing import Any

import numpy as np

from app.loading.errors import BadContentError
from app.loading.formats import MESHIO
from app.loading.surface import RawSurface
from lutcore.arrays import AnyArray, FloatArray
from lutcore.errors import MeshError

# How many of a cell's points are its corners; the others lie between them.
_FACES = {
    "triangle": 3,
    "triangle6": 3,
    "triangle7": 3,
    "quad": 4,
    "quad8": 4,
    "quad9": 4,
}
_THIN = ("vertex", "line", "line3", "line4")


def read(path: Path) -> RawSurface:
    """Read a file with meshio.

    Parameters
    ----------
    path : Path
        The file, with the ending of its format.

    Returns
    -------
    RawSurface
        All of its points in the file's order, its triangles, quadrilaterals and polygons.

    Raises
    ------
    BadContentError
        If meshio cannot read it.
    lutcore.errors.MeshError
        If it holds cells, and none is a face.
    """
    mesh = _mesh(path)
    warnings: list[str] = []
    corners, counts = _polygons(mesh.cells, warnings)
    return RawSurface(_points(mesh.points), corners, counts, None, warnings)


def _mesh(path: Path) -> Any:
    from meshio._helpers import extension_to_filetypes, reader_map

    reasons = []
    # Not meshio.read, which ends the process where no reader succeeds.
    for name in extension_to_filetypes[path.suffix]:
        try:
            return reader_map[name](str(path))
        except MemoryError:
            raise
        except (Exception, SystemExit) as error:  # whatever it is: foreign code on a broken file
            said = " ".join(str(error).split())[:120]
            reasons.append(f"{type(error).__name__}{': ' if said else ''}{said}")
    raise BadContentError(
        f"meshio cannot read it as {MESHIO[path.suffix[1:]]} ({'; '.join(reasons)})",
        "check that it is such a file, or convert it to PLY",
    )


def _points(points: AnyArray) -> FloatArray:
    try:
        found = np.asarray(points, dtype=np.float64)
    except (TypeError, ValueError):
        raise BadContentError("its points are not rows of numbers") from None
    if found.ndim != 2 or found.shape[1] not in (2, 3):
        raise BadContentError(f"its points have the shape {found.shape}, not two or three numbers")
    return np.column_stack((found, np.zeros((len(found), 3 - found.shape[1]))))


def _polygons(blocks: Any, warnings: list[str]) -> tuple[AnyArray, AnyArray]:
    corners: list[AnyArray] = [np.empty(0, np.int64)]
    counts: list[AnyArray] = [np.empty(0, np.int64)]
    solid = 0
    curved = False
    for block in blocks:
        if block.type in _THIN:
            continue
        width = block.data.shape[-1] if block.type == "polygon" else _FACES.get(block.type)
        if width is None:
            solid += len(block.data)
            continue
        data = np.asarray(block.data)
        if data.dtype.kind not in "iu" or data.ndim != 2 or data.shape[1] < width:
            raise BadContentError(f"its cells of kind {block.type!r} are not rows of indices")
        curved |= data.shape[1] > width
        corners.append(data[:, :width].astype(np.int64).reshape(-1))
        counts.append(np.full(len(data), width))
    if solid and len(counts) == 1:
        raise MeshError(f"its {solid} cells are volumes, and none is a face")
    if solid:
        warnings.append(f"{solid} cells that are no flat faces: left out")
    if curved:
        warnings.append("curved faces are taken as flat: the points between corners are unused")
    return np.concatenate(corners), np.concatenate(counts)
