"""The part of repairs that calls MeshLab; runs in a child process, which it may crash."""

from collections.abc import Callable
from typing import Any

import numpy as np

from lutcore.arrays import AnyArray
from lutcore.mesh import TriangleMesh


def repair(
    vertices: AnyArray, faces: AnyArray, kind: AnyArray, value: AnyArray, colors: AnyArray
) -> dict[str, AnyArray]:
    """Repair a mesh.

    Parameters
    ----------
    vertices, faces : ndarray
        The mesh.
    kind : ndarray of str, shape=()
        A key of `app.repairs.KINDS`.
    value : ndarray, shape=()
        Its number.
    colors : ndarray, shape=(n, 3) or (0, 3)
        Colours of the vertices, 0 to 1, if there are any.

    Returns
    -------
    dict of str to ndarray
        The repaired ``vertices``, ``faces`` and ``colors``.
    """
    import pymeshlab

    given = {}
    if len(colors):
        given["v_color_matrix"] = np.hstack([colors, np.ones((len(colors), 1))])
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(vertices, faces, **given))
    # A file that repeats the vertices for each face, as STL does, has no edge with two faces.
    meshes.meshing_remove_duplicate_vertices()
    number = float(value)
    if str(kind) in _RELATIVE:
        # A PercentageValue is of the diagonal for some filters, of its hundredth for others.
        number *= 0.01 * TriangleMesh(vertices, faces).diagonal
    _FILTERS[str(kind)](meshes, number)
    mesh = meshes.current_mesh()
    made = mesh.face_matrix()
    if str(kind) == "orient" and len(made):
        made = _turned(mesh.vertex_matrix(), made)
    left = mesh.vertex_color_matrix()[:, :3] if len(colors) else np.empty((0, 3))
    return {"vertices": mesh.vertex_matrix(), "faces": made, "colors": left}


def _turned(vertices: AnyArray, faces: AnyArray) -> AnyArray:
    from lutcore.connectivity import inside_out_faces

    inwards = inside_out_faces(TriangleMesh(vertices, faces))
    return np.where(inwards[:, None], faces[:, ::-1], faces)


def _merge(meshes: Any, length: float) -> None:
    from pymeshlab import PureValue

    meshes.meshing_merge_close_vertices(threshold=PureValue(length))
    meshes.meshing_remove_duplicate_faces()
    meshes.meshing_remove_null_faces()
    meshes.meshing_remove_unreferenced_vertices()


def _islands(meshes: Any, length: float) -> None:
    from pymeshlab import PureValue

    meshes.meshing_remove_connected_component_by_diameter(mincomponentdiag=PureValue(length))


def _manifold(meshes: Any, _: float) -> None:
    meshes.meshing_repair_non_manifold_edges(method="Remove Faces")
    meshes.meshing_repair_non_manifold_vertices(vertdispratio=0.0)
    meshes.meshing_remove_unreferenced_vertices()


def _holes(meshes: Any, edges: float) -> None:
    # MeshLab fills those of fewer edges than it is told.
    meshes.meshing_close_holes(maxholesize=int(edges) + 1, newfaceselected=False)


def _orient(meshes: Any, _: float) -> None:
    meshes.meshing_re_orient_faces_coherently()


def _decimate(meshes: Any, faces: float) -> None:
    meshes.meshing_decimation_quadric_edge_collapse(
        targetfacenum=int(faces), preserveboundary=True, preservenormal=True
    )


_FILTERS: dict[str, Callable[[Any, float], None]] = {
    "merge": _merge,
    "islands": _islands,
    "manifold": _manifold,
    "holes": _holes,
    "orient": _orient,
    "decimate": _decimate,
}
# Those that are set in percent of the diagonal.
_RELATIVE = ("merge", "islands")
