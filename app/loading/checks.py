"""From a file's arrays, which may hold anything, to a mesh that can be trusted."""

import numpy as np

from app.loading.errors import BadContentError
from app.loading.polygons import triangulated
from app.loading.surface import RawSurface
from lutcore.arrays import AnyArray, BoolArray, FloatArray
from lutcore.errors import MeshError
from lutcore.mesh import TriangleMesh

# Squares of larger numbers overflow float32, in which everything is drawn; no unit of length
# makes a scan that large.
_LARGEST = 1e18


def checked(surface: RawSurface) -> tuple[TriangleMesh, FloatArray | None]:
    """Check what a reader found, triangulate it and make it a mesh.

    Parameters
    ----------
    surface : RawSurface
        As read. Its list of warnings grows by what had to be mended.

    Returns
    -------
    TriangleMesh
        All vertices in the file's order.
    ndarray of float64, shape=(n, 3), or None
        Their colours.

    Raises
    ------
    BadContentError
        If faces use vertices that do not exist, or its arrays do not fit together.
    MeshError
        If no usable face is left.
    """
    vertices, counts = surface.vertices, surface.counts
    if len(vertices) == 0:
        raise MeshError("it holds no vertices")
    if len(counts) == 0:
        raise MeshError(f"it holds {len(vertices)} points but no faces, so there is no surface")
    _check_shapes(surface)
    _check_indices(surface.corners, counts, len(vertices))
    corners, counts = _without_slivers(surface)
    # A comparison with NaN is false.
    if not (vertices.min() > -_LARGEST and vertices.max() < _LARGEST):
        good: BoolArray = np.all(np.abs(vertices) < _LARGEST, axis=1)
        corners, counts, vertices = _without_bad_positions(surface, corners, counts, good)
    faces = triangulated(vertices, corners, counts, surface.warnings)
    return TriangleMesh(vertices, faces), surface.colors


def _check_shapes(surface: RawSurface) -> None:
    """Foreign code may return anything, after a file that it nearly died of above all."""
    vertices, corners, counts = surface.vertices, surface.corners, surface.counts
    if vertices.ndim != 2 or vertices.shape[1] != 3 or corners.shape != (int(counts.sum()),):
        raise BadContentError(
            f"its reader found {vertices.shape} coordinates and {len(corners)} corners of "
            f"{len(counts)} faces, which do not fit together"
        )
    if surface.colors is not None and surface.colors.shape != vertices.shape:
        surface.colors = None
        surface.warnings.append("the vertex colours do not fit the vertices: not used")


def _check_indices(corners: AnyArray, counts: AnyArray, vertex_count: int) -> None:
    if len(corners) and (corners.min() < 0 or corners.max() >= vertex_count):
        bad = (corners < 0) | (corners >= vertex_count)
        first = int(np.argmax(bad))
        face = int(np.searchsorted(np.cumsum(counts), first, side="right"))
        raise BadContentError(
            f"{np.count_nonzero(bad)} face corners use vertices that do not exist, the first is "
            f"vertex {corners[first]} in face {face} (from 0), of {vertex_count} vertices"
        )


def _without_slivers(surface: RawSurface) -> tuple[AnyArray, AnyArray]:
    few = surface.counts < 3
    if not few.any():
        return surface.corners, surface.counts
    if few.all():
        raise MeshError("its faces have fewer than three corners, so there is no surface")
    surface.warnings.append(
        f"{np.count_nonzero(few)} faces have fewer than three corners: left out"
    )
    return _kept(surface.corners, surface.counts, ~few)


def _kept(corners: AnyArray, counts: AnyArray, keep: AnyArray) -> tuple[AnyArray, AnyArray]:
    return corners[np.repeat(keep, counts)], counts[keep]


def _without_bad_positions(
    surface: RawSurface, corners: AnyArray, counts: AnyArray, good: BoolArray
) -> tuple[AnyArray, AnyArray, FloatArray]:
    """Scanners mark missing depth by NaN: such vertices stay, to keep the order, without faces."""
    bad_corners = np.repeat(np.arange(len(counts)), counts)[~good[corners]]
    keep = np.ones(len(counts), dtype=bool)
    keep[bad_corners] = False
    lost = int(np.count_nonzero(~keep))
    if 2 * lost > len(counts):
        raise MeshError(
            f"{np.count_nonzero(~good)} of {len(good)} vertex positions are not finite numbers "
            f"below {_LARGEST:g}, and {lost} of {len(counts)} faces use them"
        )
    corners, counts = _kept(corners, counts, keep)
    vertices = surface.vertices.copy()
    # On the surface, so that neither the bounding box nor the camera notices them.
    vertices[~good] = vertices[corners[0]]
    surface.warnings.append(
        f"{np.count_nonzero(~good)} vertices have no finite position (the first is vertex "
        f"{int(np.argmin(good))}): {lost} faces that use them are left out, and they lie, unused, "
        f"on vertex {int(corners[0])}"
    )
    return corners, counts, vertices
