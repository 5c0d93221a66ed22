"""Repaired meshes: MeshLab's filters in a child process that they may crash."""

from dataclasses import replace

import numpy as np

from app.loading import LoadedMesh
from app.repairs import KINDS
from app.session import Repair
from lutcore.arrays import FloatArray
from lutcore.errors import MeshError
from lutcore.isolated import IsolatedError, run_isolated
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress

# Its libraries map some GiB; MeshLab keeps about 1 KiB for a vertex with its faces.
_BYTES, _BYTES_PER_VERTEX = 6 << 30, 16 << 10
# Start of the interpreter and the libraries on a busy machine, and time for each vertex.
_SECONDS, _SECONDS_PER_VERTEX = 60.0, 1e-3


def repaired(loaded: LoadedMesh, repair: Repair, progress: Progress) -> LoadedMesh:
    """Return a mesh with one repair done; coincident vertices are joined before it.

    Parameters
    ----------
    loaded : LoadedMesh
        The mesh.
    repair : Repair
        What to do.
    progress : callable
        Asked now and then whether to stop.

    Returns
    -------
    LoadedMesh
        The repaired mesh, with what changed as its last warning.

    Raises
    ------
    MeshError
        If it cannot be done, or leaves nothing.
    CancelledError
        If `progress` asked to stop.
    """
    mesh, colors = loaded.mesh, _colors(loaded)
    try:
        found = run_isolated(
            "app.repair_child:repair",
            {
                "vertices": mesh.vertices,
                "faces": mesh.faces,
                "kind": np.array(repair.kind),
                "value": np.array(KINDS[repair.kind].check(repair.kind, repair.value)),
                "colors": np.empty((0, 3)) if colors is None else colors,
            },
            label="MeshLab",
            seconds=_SECONDS + _SECONDS_PER_VERTEX * len(mesh.vertices),
            memory=_BYTES + _BYTES_PER_VERTEX * len(mesh.vertices),
            keep=True,
            progress=progress,
        )
    except IsolatedError as error:
        raise MeshError(
            f"{loaded.path}: the repair {repair.words!r} was not possible: {error}; "
            "take it back, or do another repair before it"
        ) from None
    if not len(found["faces"]):
        raise MeshError(
            f"{loaded.path}: the repair {repair.words!r} leaves no face; take it back, or set it "
            "lower"
        )
    made = TriangleMesh(found["vertices"], found["faces"])
    remark = (
        f"repaired ({repair.words}): {len(made.vertices):,} vertices and {len(made.faces):,} faces "
        f"of {len(mesh.vertices):,} and {len(mesh.faces):,}"
    )
    if loaded.texture is not None:
        remark += "; the texture's colours are now those of the vertices"
    return replace(
        loaded,
        mesh=made,
        colors=None if colors is None else found["colors"],
        texture=None,
        warnings=(*loaded.warnings, remark),
    )


def _colors(loaded: LoadedMesh) -> FloatArray | None:
    """Return the colours of the vertices; a texture has no place on other faces."""
    if loaded.texture is None:
        return loaded.colors
    from lutcore.color import srgb_decode, srgb_encode

    albedo = loaded.texture.albedo(len(loaded.mesh.vertices))
    return srgb_encode(albedo if loaded.colors is None else albedo * srgb_decode(loaded.colors))
