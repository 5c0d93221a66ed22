"""How wrong softened shadows are: what local models make of the edges of cast shadows; compiled."""

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled
from lutcore.lights import light_at

# Share of the light that softening may be off by at an edge, and the product of lit and dark share
# below which it is less: with the fourth root, for light fades into a shadow more slowly than the
# filter that softens it. On tori under low light, eight materials, 1 to 30 mm, it is more than what
# is found for 95 % of the vertices whose share is neither 0 nor 1.
_OFF, _EDGE = 0.3, 0.01


@compiled(parallel=True)
def doubt_of_softening(
    points: FloatArray,
    normals: FloatArray,
    lights: FloatArray,
    shares: FloatArray,
    entering: FloatArray,
) -> FloatArray:
    """Return by how much a local model may be wrong where a shadow ends.

    Parameters
    ----------
    points : ndarray, shape=(n, 3)
        Positions, mesh units.
    normals : ndarray, shape=(1, n, 3) or (3, n, 3)
        Unit normals, for all channels or for each.
    lights : ndarray, shape=(l, LIGHT_FIELDS)
        See `lutcore.lights.pack`.
    shares : ndarray, shape=(l, n, 3)
        Of each light, what softened shadows leave, 0 to 1.
    entering : ndarray, shape=(3, k)
        c F_t(c) at even cosines from -1 to 1.

    Returns
    -------
    ndarray, shape=(n, 3)
        In R_d and the lights' unit of irradiance.
    """
    out = np.zeros((len(points), 3))
    last = entering.shape[1] - 1
    for i in prange(len(points)):
        for light in range(len(lights)):
            x, y, z, strength = light_at(lights, light, points[i, 0], points[i, 1], points[i, 2])
            for c in range(3):
                n = min(c, len(normals) - 1)
                cosine = normals[n, i, 0] * x + normals[n, i, 1] * y + normals[n, i, 2] * z
                share = shares[light, i, c]
                edge = min(1.0, max(share * (1.0 - share), 0.0) / _EDGE)
                lit = entering[c, round(0.5 * (min(max(cosine, -1.0), 1.0) + 1.0) * last)]
                out[i, c] += lights[light, 8 + c] * strength * lit * _OFF * np.sqrt(np.sqrt(edge))
    return out
