"""Principal directions as short strokes on the surface. Knows no VTK."""

from dataclasses import dataclass

import numpy as np

from lutcore.arrays import BoolArray, FloatArray, IndexArray
from lutcore.curvature import PrincipalCurvatures
from lutcore.geometry import face_areas
from lutcore.mesh import TriangleMesh

# About as many crosses as one can see at once.
_CROSSES = 1600
# Lengths as shares of the spacing: of k1's stroke, of k2's, their widths, and above the surface.
_LONG, _SHORT, _WIDTH, _LIFT = 0.80, 0.55, 0.11, 0.06
# Stations along a stroke, which follows the surface's normal curvature.
_STATIONS = np.linspace(-0.5, 0.5, 5)
# A stroke bends no further than to this share of a half circle of its own length.
_MOST_BENT = 2.0
_BLACK, _WHITE = (0.05, 0.05, 0.05), (1.0, 1.0, 1.0)


@dataclass(frozen=True, eq=False)
class Strokes:
    """Ribbons along the principal directions.

    Parameters
    ----------
    points : ndarray, shape=(p, 3)
        World coordinates.
    quads : ndarray of int, shape=(q, 4)
        Their corners.
    colors : ndarray, shape=(q, 3)
        sRGB-encoded, 0 to 1: k1's direction is black, k2's white.
    at : ndarray of int, shape=(c,)
        Vertices that have a cross.
    """

    points: FloatArray
    quads: IndexArray
    colors: FloatArray
    at: IndexArray


def strokes_of(mesh: TriangleMesh, curvatures: PrincipalCurvatures) -> Strokes:
    """Return crosses of two strokes, evenly spread over a surface.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    curvatures : PrincipalCurvatures
        Its estimate; `directed`.

    Returns
    -------
    Strokes
        None where k1 and k2 are not told apart: their difference is below its error.
    """
    spacing = float(np.sqrt(face_areas(mesh).sum() / _CROSSES))
    at = _spread(mesh.vertices, _told_apart(curvatures), spacing)
    quads, points, colors = [], [], []
    count = 0
    for direction, k, share, color in (
        (curvatures.d1, curvatures.k1, _LONG, _BLACK),
        (curvatures.d2, curvatures.k2, _SHORT, _WHITE),
    ):
        ribbon = _ribbons(mesh, curvatures, at, direction, k, share * spacing, _WIDTH * spacing)
        corners = _corners(len(at)) + count
        points.append(ribbon)
        quads.append(corners)
        colors.append(np.tile(color, (len(corners), 1)))
        count += len(ribbon)
    return Strokes(np.concatenate(points), np.concatenate(quads), np.concatenate(colors), at)


def _told_apart(curvatures: PrincipalCurvatures) -> BoolArray:
    # Of a difference of two values, each with that error.
    error = np.sqrt(2.0) * curvatures.error
    apart: BoolArray = curvatures.estimated & (curvatures.k1 - curvatures.k2 > error)
    return apart


def _spread(points: FloatArray, allowed: BoolArray, spacing: float) -> IndexArray:
    """Return vertices no two of which are nearer than the spacing, and that leave no gap.

    Those that may not have a stroke take part, so that the others do not crowd around them.
    """
    from scipy.spatial import cKDTree

    order = np.random.default_rng(0).permutation(len(points))
    tree = cKDTree(points)
    free = np.ones(len(points), dtype=bool)
    taken = []
    for vertex in order:
        if free[vertex]:
            taken.append(vertex)
            free[tree.query_ball_point(points[vertex], spacing)] = False
    found = np.array(taken, dtype=np.int32)
    return found[allowed[found]]


def _ribbons(
    mesh: TriangleMesh,
    curvatures: PrincipalCurvatures,
    at: IndexArray,
    direction: FloatArray,
    k: FloatArray,
    length: float,
    width: float,
) -> FloatArray:
    normal, along = curvatures.normals[at], direction[at]
    across = np.cross(normal, along)
    # Convex surfaces fall away from their tangent plane, by k s^2 / 2 to second order.
    bend = np.clip(k[at], -_MOST_BENT / length, _MOST_BENT / length)
    s = _STATIONS * length
    middle = (
        mesh.vertices[at][:, None]
        + s[None, :, None] * along[:, None]
        + (_LIFT * length / _LONG - 0.5 * bend[:, None] * s**2)[..., None] * normal[:, None]
    )
    side = 0.5 * width * across[:, None]
    return np.stack([middle - side, middle + side], axis=2).reshape(-1, 3)


def _corners(count: int) -> IndexArray:
    stations = len(_STATIONS)
    first = 2 * np.arange(stations - 1)
    one = np.stack([first, first + 2, first + 3, first + 1], axis=1)
    each = (2 * stations * np.arange(count))[:, None, None] + one
    return each.reshape(-1, 4).astype(np.int32)
