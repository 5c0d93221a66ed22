"""The last step: what neighbouring fits have at random, averaged away.

A fit over one star tells of the star's middle, not of its vertex. On random triangles that is an
error of the order of the spacing which no smoothing of positions and normals takes away, but which
is independent from star to star.
"""

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray, SingleArray
from lutcore.compiled import compiled
from lutcore.cosmoothing import Surface
from lutcore.lowpass import low_pass
from lutcore.tensors import in_space, in_tangent_plane

# Scale of the averaging, in spacings. It is left out where the fit itself was made at less than
# the first of the two, and full from the second on.
_SCALE, _FROM, _FULL = 1.2, 1.0, 2.5
# Share of the squared change that stays as error.
_STAYS = 0.1


def refined(
    on: Surface, normals: FloatArray, used: FloatArray, tensors: FloatArray, square: FloatArray
) -> None:
    """Smooth shape operators over neighbouring stars, in place.

    Parameters
    ----------
    on : Surface
        The mesh.
    normals : ndarray, shape=(n, 3)
        Unit normals; tensors are in their `tangent_frame`.
    used : ndarray, shape=(n,)
        Scales of the fits, mesh units.
    tensors : ndarray, shape=(n, 3)
        Entries xx, xy, yy; rewritten.
    square : ndarray, shape=(n,)
        Squared error bars; what the smoothing cannot vouch for is added.
    """
    space = np.empty((len(normals), 6))
    _in_space(normals, tensors, space)
    change = low_pass(on.operator, space, [_SCALE * on.spacing])
    _apply(normals, space, change, used, on.spacing, tensors, square)


@compiled(parallel=True)
def _in_space(normals: FloatArray, tensors: FloatArray, space: FloatArray) -> None:
    for i in prange(len(normals)):
        xx, xy, xz, yy, yz, zz = in_space(normals[i], tensors[i])
        space[i, 0], space[i, 1], space[i, 2] = xx, xy, xz
        space[i, 3], space[i, 4], space[i, 5] = yy, yz, zz


@compiled(parallel=True)
def _apply(
    normals: FloatArray,
    space: FloatArray,
    change: SingleArray,
    used: FloatArray,
    spacing: float,
    tensors: FloatArray,
    square: FloatArray,
) -> None:
    for i in prange(len(normals)):
        full = min(max((used[i] / spacing - _FROM) / (_FULL - _FROM), 0.0), 1.0)
        for entry in range(6):
            space[i, entry] += full * change[0, i, entry]
        xx, xy, yy = in_tangent_plane(normals[i], space[i])
        d = (xx - tensors[i, 0], xy - tensors[i, 1], yy - tensors[i, 2])
        square[i] += _STAYS * (0.5 * (d[0] * d[0] + d[2] * d[2]) + d[1] * d[1])
        tensors[i, 0], tensors[i, 1], tensors[i, 2] = xx, xy, yy
