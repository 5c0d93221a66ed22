"""One photon: from where it enters until its weight is gone.

Its weight falls by the albedo at each collision and by what leaves at each meeting with the
surface; what leaves is counted where it does. Scattering is isotropic, with the reduced
coefficients.
"""

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled
from lutcore.fresnel import compiled_transmittance
from lutcore.walk.bodies import FLAT, FULL, distance_out, normal_at
from lutcore.walk.boundary import inner_reflectance, refracted
from lutcore.walk.generator import draw, stream

ABSORBED, REFLECTED = -1, -2
"""Cells of a tally after the places: weight absorbed inside and reflected without entering."""

# Below the first, a photon lives on with the second as its chance and its weight raised by the
# inverse: short enough walks, and few heavy photons that carry the noise.
_LIGHT, _CHANCE = 0.05, 0.2
_TURN = 2.0 * np.pi


@compiled()
def place(
    x: float,
    y: float,
    z: float,
    inverse: FloatArray,
    frame: FloatArray,
    kind: int,
    rows: int,
    columns: int,
) -> int:
    """Return the cell of the tally that a place on the surface belongs to.

    Parameters
    ----------
    x, y, z : float
        The place.
    inverse : ndarray, shape=(3,)
        `Body.inverse`.
    frame : ndarray, shape=(3, 3)
        `Body.frame`.
    kind : int
        `Body.kind`.
    rows, columns : int
        Cells. Rows run from the dark pole to the lit one, evenly in the cosine on an ellipsoid
        and in the angle on a cylinder; columns run round the pole, on a cylinder from one side to
        the other.

    Returns
    -------
    int
        Row x columns + column.
    """
    if kind == FLAT:
        return 0
    x, y, z = x * inverse[0], y * inverse[1], z * inverse[2]
    along = x * frame[0, 0] + y * frame[0, 1] + z * frame[0, 2]
    across = x * frame[1, 0] + y * frame[1, 1] + z * frame[1, 2]
    if kind == FULL:
        over = x * frame[2, 0] + y * frame[2, 1] + z * frame[2, 2]
        height = 0.5 * (1.0 + along)
        around = np.arctan2(over, across) / _TURN
        around = around + 1.0 if around < 0.0 else around
    else:
        height = 1.0 - abs(np.arctan2(across, along)) / np.pi
        around = 0.25 if across >= 0.0 else 0.75
    row = min(max(int(height * rows), 0), rows - 1)
    return row * columns + min(int(around * columns), columns - 1)


@compiled()
def _isotropic(state: np.uint64) -> tuple[np.uint64, float, float, float]:
    # Marsaglia 1972: a point in the unit circle gives a point on the unit sphere.
    while True:
        state, u = draw(state)
        state, v = draw(state)
        u, v = 2.0 * u - 1.0, 2.0 * v - 1.0
        q = u * u + v * v
        if q < 1.0:
            break
    r = 2.0 * np.sqrt(1.0 - q)
    return state, r * u, r * v, 1.0 - 2.0 * q


@compiled()
def _entrance(
    state: np.uint64,
    stratum: float,
    strata: float,
    inverse: FloatArray,
    frame: FloatArray,
    kind: int,
) -> tuple[np.uint64, float, float, float]:
    if kind == FLAT:
        return state, 0.0, 0.0, 0.0
    # Even over the shadow of the unit sphere or circle; in equal parts of it, one for a photon.
    state, u = draw(state)
    u = (stratum + u) / strata
    if kind == FULL:
        state, v = draw(state)
        r, height = np.sqrt(u), np.sqrt(1.0 - u)
        p, q = r * np.cos(_TURN * v), r * np.sin(_TURN * v)
    else:
        p, q = 2.0 * u - 1.0, 0.0
        height = np.sqrt(max(1.0 - p * p, 0.0))
    x = height * frame[0, 0] + p * frame[1, 0] + q * frame[2, 0]
    y = height * frame[0, 1] + p * frame[1, 1] + q * frame[2, 1]
    z = height * frame[0, 2] + p * frame[1, 2] + q * frame[2, 2]
    # No axis is 0; an infinite one has no part in x, y, z.
    x = x / inverse[0] if inverse[0] > 0.0 else 0.0
    y = y / inverse[1] if inverse[1] > 0.0 else 0.0
    z = z / inverse[2] if inverse[2] > 0.0 else 0.0
    return state, x, y, z


@compiled()
def follow(
    seed: int,
    photon: int,
    stratum: float,
    strata: float,
    light: FloatArray,
    inverse: FloatArray,
    frame: FloatArray,
    kind: int,
    albedo: float,
    eta: float,
    rows: int,
    columns: int,
    tally: FloatArray,
) -> None:
    """Follow one photon and add its weight to the tally.

    Parameters
    ----------
    seed, photon : int
        What its random numbers depend on.
    stratum, strata : float
        Which part of the body's shadow it enters through, and of how many.
    light : ndarray, shape=(3,)
        Unit vector TO the light.
    inverse, frame, kind
        `Body.inverse`, `Body.frame` and `Body.kind`.
    albedo : float
        alpha'.
    eta : float
        Refractive index relative to the outside.
    rows, columns : int
        See `place`.
    tally : ndarray, shape=(rows * columns + 2,)
        Added to: what leaves by place, then `REFLECTED` and `ABSORBED`. The sum grows by 1, on
        average exactly.
    """
    square = inverse * inverse
    state = stream(seed, photon)
    state, x, y, z = _entrance(state, stratum, strata, inverse, frame, kind)
    nx, ny, nz = normal_at(x, y, z, square, kind)
    cosine = max(light[0] * nx + light[1] * ny + light[2] * nz, 0.0)
    weight = compiled_transmittance(cosine, eta)
    tally[REFLECTED] += 1.0 - weight
    dx, dy, dz = refracted(light[0], light[1], light[2], nx, ny, nz, eta)
    while weight > 0.0:
        state, u = draw(state)
        path = -np.log(u)
        edge = distance_out(x, y, z, dx, dy, dz, square, kind)
        while path >= edge:
            x, y, z = x + edge * dx, y + edge * dy, z + edge * dz
            nx, ny, nz = normal_at(x, y, z, square, kind)
            out = dx * nx + dy * ny + dz * nz
            kept = inner_reflectance(min(out, 1.0), eta)
            tally[place(x, y, z, inverse, frame, kind, rows, columns)] += (1.0 - kept) * weight
            weight *= kept
            dx, dy, dz = dx - 2.0 * out * nx, dy - 2.0 * out * ny, dz - 2.0 * out * nz
            # An exponential path has no memory of what lies behind.
            path -= edge
            edge = distance_out(x, y, z, dx, dy, dz, square, kind)
            if weight < _LIGHT:
                state, u = draw(state)
                weight = weight / _CHANCE if u < _CHANCE else 0.0
                if weight == 0.0:
                    return
        x, y, z = x + path * dx, y + path * dy, z + path * dz
        tally[ABSORBED] += (1.0 - albedo) * weight
        weight *= albedo
        if weight < _LIGHT:
            state, u = draw(state)
            weight = weight / _CHANCE if u < _CHANCE else 0.0
        state, dx, dy, dz = _isotropic(state)
