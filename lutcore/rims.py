"""Jets at rims: where a mesh ends, smoothing is lopsided, and a polynomial is not."""

import numba
import numpy as np
from numba import prange

from lutcore.arrays import BoolArray, FloatArray, IndexArray
from lutcore.balls import gather_ball
from lutcore.compiled import compiled
from lutcore.cosmoothing import Surface
from lutcore.jets import TERMS, fit_jet, operator_of
from lutcore.tensors import in_space, in_tangent_plane, tangent_frame

# Radii of the balls, in spacings: half a ball of the first holds some 25 vertices, twice the
# unknowns of a cubic. The jet of the first is taken; its bias, of order r^2, is judged by the
# second: (r2/r1)^2 - 1 times it.
_RADIUS, _WIDER = 4.0, 6.0
_CUBIC = 3


def jets_at(
    on: Surface, normals: FloatArray, rim: IndexArray, tensors: FloatArray, square: FloatArray
) -> IndexArray:
    """Replace what smoothing said at the rim by cubic jets, wherever those are the more precise.

    Smoothing over half a neighbourhood has a bias of first order in the scale, a jet one of
    second order; but it passes many times the noise.

    Parameters
    ----------
    on : Surface
        The mesh.
    normals : ndarray, shape=(n, 3)
        Unit normals; tensors are in their `tangent_frame`.
    rim : ndarray of int32, shape=(r,)
        Vertices near the rim.
    tensors : ndarray, shape=(n, 3)
        Entries xx, xy, yy; rewritten.
    square : ndarray, shape=(n,)
        Squared error bars; rewritten.

    Returns
    -------
    ndarray of int32
        The vertices whose jet was taken.
    """
    seen, ball = np.zeros((2, numba.get_num_threads(), len(normals)), np.int32)
    taken = _fit(
        on.operator.start,
        on.operator.neighbour,
        on.points,
        on.fields,
        normals,
        rim,
        jet_radius(on),
        _WIDER * on.spacing,
        seen,
        ball,
        tensors,
        square,
    )
    return rim[taken]


def jet_radius(on: Surface) -> float:
    """Return the radius of the balls that jets are fitted to.

    Parameters
    ----------
    on : Surface
        The mesh.

    Returns
    -------
    float
        Mesh units.
    """
    return _RADIUS * on.spacing


@compiled(parallel=True)
def _fit(
    start: IndexArray,
    neighbour: IndexArray,
    points: FloatArray,
    fields: FloatArray,
    normals: FloatArray,
    rim: IndexArray,
    narrow: float,
    wide: float,
    seen: IndexArray,
    ball: IndexArray,
    tensors: FloatArray,
    square: FloatArray,
) -> BoolArray:
    taken = np.zeros(len(rim), np.bool_)
    growth = (wide / narrow) ** 2 - 1.0
    chunks = len(seen)
    for chunk in prange(chunks):
        mine = ball[chunk]
        local = np.empty((0, 3))
        for w in range(len(rim) * chunk // chunks, len(rim) * (chunk + 1) // chunks):
            i = rim[w]
            count = gather_ball(
                i, wide, 2 * TERMS[_CUBIC], points, start, neighbour, seen[chunk], mine
            )
            if count > len(local):
                local = np.empty((2 * count, 3))
            n = (fields[i, 3], fields[i, 4], fields[i, 5])
            u, v = tangent_frame(n[0], n[1], n[2])
            all_of = near = 0
            for at in range(count):
                j = mine[at]
                if fields[j, 3] * n[0] + fields[j, 4] * n[1] + fields[j, 5] * n[2] <= 0.0:
                    continue
                x = y = z = 0.0
                for axis in range(3):
                    d = points[j, axis] - points[i, axis]
                    x, y, z = x + d * u[axis], y + d * v[axis], z + d * n[axis]
                x, y, z = x / narrow, y / narrow, z / narrow
                if x * x + y * y + z * z <= 1.0:  # those of the smaller ball first
                    for axis in range(3):
                        local[all_of, axis] = local[near, axis]
                    local[near, 0], local[near, 1], local[near, 2] = x, y, z
                    near += 1
                else:
                    local[all_of, 0], local[all_of, 1], local[all_of, 2] = x, y, z
                all_of += 1
            fitted, jet, noise = fit_jet(local[:near], _CUBIC)
            judged, wider, _ = fit_jet(local[:all_of], _CUBIC)
            if not (fitted and judged) or near <= TERMS[_CUBIC]:
                continue
            m, tensor = operator_of(jet, n, u, v, narrow)
            found = in_tangent_plane(normals[i], in_space(m, tensor))
            other, second = operator_of(wider, n, u, v, narrow)
            after = in_tangent_plane(normals[i], in_space(other, second))
            xx, xy, yy = found[0] - after[0], found[1] - after[1], found[2] - after[2]
            bias = (0.5 * (xx * xx + yy * yy) + xy * xy) / growth**2
            error = (noise / narrow) ** 2 + bias
            if error < square[i]:
                tensors[i, 0], tensors[i, 1], tensors[i, 2] = found
                square[i] = error
                taken[w] = True
    return taken
