"""The part of reading that calls MeshLab; runs in the child process only."""

from pathlib import Path

import numpy as np

from app.loading.errors import BadContentError
from app.loading.formats import MESHLAB
from app.loading.surface import RawSurface
from lutcore.arrays import AnyArray


def read(path: Path) -> RawSurface:
    """Read a file with MeshLab.

    Parameters
    ----------
    path : Path
        The file, with the ending of its format.

    Returns
    -------
    RawSurface
        The triangles of all of its layers, and vertex colours where every layer has them.

    Raises
    ------
    BadContentError
        If MeshLab cannot read it.
    """
    import pymeshlab

    layers = pymeshlab.MeshSet()
    try:
        layers.load_new_mesh(str(path))
    except pymeshlab.PyMeshLabException as error:
        said = " ".join(str(error).replace(str(path), "it").split())[:200]
        raise BadContentError(
            f"MeshLab cannot read it as {MESHLAB[path.suffix[1:]]} ({said})",
            "check that it is such a file, or convert it to PLY",
        ) from None
    vertices: list[AnyArray] = []
    faces: list[AnyArray] = []
    colors: list[AnyArray] = []
    offset = 0
    for layer in layers:
        points = layer.transformed_vertex_matrix()
        found = np.asarray(layer.face_matrix(), dtype=np.int64).reshape(-1, 3)
        if found.size and (found.min() < 0 or found.max() >= len(points)):
            # Checked here, for an index beyond one layer would be a vertex of the next.
            raise BadContentError("its face corners use vertices that do not exist")
        vertices.append(points)
        faces.append(found + offset)
        if layer.has_vertex_color():
            colors.append(layer.vertex_color_matrix()[:, :3])
        offset += len(points)
    surface = RawSurface.of_triangles(
        np.concatenate([np.empty((0, 3)), *vertices]),
        np.concatenate([np.empty((0, 3), np.int64), *faces]),
    )
    if colors and len(colors) == len(vertices):
        surface.colors = np.clip(np.concatenate(colors), 0.0, 1.0)
    surface.warnings.append(
        "read by MeshLab: number and order of its vertices may differ from the file's"
    )
    return surface
