"""The terms of a local shading model's error, vertex by vertex; compiled.

Per R_d and unit irradiance, with the hinges c F_t(c) ~ sum_j w_j max(0, c - c_j) and lengths in
l_u, the exitance of a curved surface is to second order

    M = c F_t(c) + G(b) - X + Y,    a = N.w,  c = max(a, 0),  b = |S+ w_t|,
    G(b) = sum_j w_j b psi(|a - c_j|/b),    X ~ E2/(1 + E2) (c F_t(c) + G),
    Y ~ <r^2>/4 |grad(k1 + k2).w|,

because the Laplacian of the normal is -grad(k1 + k2) - (k1^2 + k2^2) N. The terms, in the order of
`lutcore.prediction.WEIGHTS`:

- first: |G(b) - G(b')|, b' the bending that the model follows;
- second: X; anisotropy: its part with (k1 - k2)^2, for models that know one curvature;
- higher: e^2 + e G(<r^2>^(1/2) b)/2, e = E2/(1 + E2), light that goes through the body; in e^2 it
  is that of a ball of the body's volume over its area, where that is more;
- third: Y, less what the error bar makes of the gradient; concave: G of the concave part of S;
- facet: the area of the mesh per vertex times k1^2 + k2^2, what lies between a facet and the body;
- base: what references and tables resolve;
- rough: faces that the normals given do not follow; tilt: the error bar times its scale, where
  one scale serves all channels; bumps: where each has its own, the angle of the faces to the
  normal, to a power near 1 that was measured; it hardly depends on h, the share of the light that
  crosses facets, until light blurs all (h -> 1) or none (h -> 0);
- residue: E2/(1 + E2) alone, for tables that are off in the dark;
- beside: G(b*), b* what curvature may be beside the vertex: from its size whatever its sign and
  direction, its error bar, and its gradient over <r^2>^(1/2). What is flat or hollow here and
  faces away may have a lit ridge within reach; third, tilt and bumps fade into the dark by b*, too;
- least: no light's error is foreseen to be less.

psi is not looked up: psi(0)/(1 + u/L)^8, of the same value at 0 and the same integral, costs no
table and is near enough to a bound.
"""

from typing import NamedTuple

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.geometry import edge
from lutcore.lights import light_at

# Half width of the terminator, in N.w.
_EDGE = 0.1
DOUBT = 3.1
"""By how much the error bar of curvature counts in b*."""

# By how much its size and its gradient do.
_SIZE, _CHANGE = 1.1, 1.5
# The error bar over the facets' width, times this, is how much of the gradient may be noise.
_NOISE_OF_SLOPE = 1.2
# Power of the angle of bumps; that of the light that does and does not cross facets is 1/6.
_STEEPER = 1.2
# Share of that angle by which cosines beside the normal's count for what is off on flat surfaces.
_WOBBLE = 0.5
_CLOSED = 1e-6
# Cosines of the light among which the worst is sought where no light is known: the error is
# largest near the terminator, where F_t bends most, or straight above.
_WORST = np.array([-0.5, -0.2, -0.05, 0.0, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0])


class Where(NamedTuple):
    """As in `lutcore.prediction.Scene`."""

    points: FloatArray
    normals: FloatArray
    curvatures: FloatArray
    directions: FloatArray
    error: FloatArray
    slope: FloatArray
    facet: FloatArray
    rough: FloatArray
    tilt: FloatArray
    bumps: FloatArray
    radius: float


class Spread(NamedTuple):
    """How light spreads, by channel.

    Parameters
    ----------
    length : ndarray, shape=(3,)
        l_u, mm.
    psi_0 : ndarray, shape=(3,)
        psi(0).
    per_width : ndarray, shape=(3,)
        1/L, per l_u.
    square : ndarray, shape=(3,)
        <r^2>, l_u^2.
    weights, corners : ndarray, shape=(3, hinges)
        w_j and c_j.
    entering : ndarray, shape=(3, k)
        c F_t(c) at even cosines from -1 to 1.
    """

    length: FloatArray
    psi_0: FloatArray
    per_width: FloatArray
    square: FloatArray
    weights: FloatArray
    corners: FloatArray
    entering: FloatArray


class Known(NamedTuple):
    """What a model has right.

    Parameters
    ----------
    off : ndarray, shape=(3, k)
        Its error on a flat surface, at the cosines of `Spread.entering`.
    bend : int
        Index into `lutcore.prediction.BENDS`.
    parts : ndarray
        Weights of the terms.
    """

    off: FloatArray
    bend: int
    parts: FloatArray


@compiled()
def _glow(
    a: float, b: float, psi_0: float, per_width: float, w: FloatArray, corners: FloatArray
) -> float:
    if b == 0.0:
        return 0.0
    total, inverse = 0.0, per_width / b
    for j in range(len(corners)):
        t = 1.0 / (1.0 + abs(a - corners[j]) * inverse)
        t *= t
        t *= t
        total += w[j] * (t * t)
    return b * psi_0 * max(total, 0.0)


@compiled()
def _read(curve: FloatArray, cosine: float) -> float:
    at = 0.5 * (min(max(cosine, -1.0), 1.0) + 1.0) * (len(curve) - 1)
    i = min(int(at), len(curve) - 2)
    value: float = curve[i] + (at - i) * (curve[i + 1] - curve[i])
    return value


@compiled()
def _error(
    at: tuple[float, float, float, float, float, float, float, float, float],
    way: tuple[float, float, float, float],
    spread: tuple[float, float, float, float],
    radius: float,
    bend: int,
    w: FloatArray,
    corners: FloatArray,
    entering: FloatArray,
    off: FloatArray,
    parts: FloatArray,
) -> float:
    """Return the bound for one light and channel.

    Numbers and bare arrays instead of named tuples, which would be copied with every call. `at` is
    k1, k2, error, facet, rough, tilt, bumps, their power and the size of the slope, `way` N.w, w
    along both principal directions and the slope along w, `spread` that of the channel.
    """
    a, u, v, steep = way
    length, psi_0, per_width, square = spread
    k1, k2 = length * at[0], length * at[1]
    noise, facet, rough, tilt, bumps, slope = at[2], at[3], at[4], at[5], at[6], at[8]
    p, q = max(k1, 0.0), max(k2, 0.0)
    sine = np.sqrt(u * u + v * v)
    b = np.sqrt((p * u) ** 2 + (q * v) ** 2)
    hollow = np.sqrt(((k1 - p) * u) ** 2 + ((k2 - q) * v) ** 2)
    followed = b
    if bend == 0:
        followed = 0.0
    elif bend == 1:
        followed = 0.5 * (p + q) * sine
    elif bend == 2:
        followed = np.sqrt(0.5 * (p * p + q * q)) * sine
    e2 = square * (2.0 * (k1 * k1 + k2 * k2) + (k1 + k2) ** 2) / 16.0
    e2 /= 1.0 + e2
    uneven = square * (k1 - k2) ** 2 / 16.0
    uneven /= 1.0 + uneven
    glow = _glow(a, b, psi_0, per_width, w, corners)
    lit = _read(entering, a) + glow
    fall = _fall(a, b, per_width)
    reach = square * length * length
    beside = _SIZE * _SIZE * (k1 * k1 + k2 * k2) + (DOUBT * length * noise) ** 2
    beside = np.sqrt(beside + (_CHANGE * length * slope) ** 2 * reach)
    fall_beside = _fall(a, max(beside, b), per_width)
    # Where light goes round the terminator, <F_t> is off by as much as at the cosine there.
    round_ = a if bend == 0 else min(max(a, 0.0) + followed * psi_0 * fall, 1.0)
    # Facets that turn to and from the light see what the model is off by on either side.
    apart = _WOBBLE * bumps * sine
    flat = max(_read(off, round_), _read(off, round_ - apart), _read(off, round_ + apart))
    error = flat * (1.0 if bend == 0 else fall)
    if bend != 3:
        error += parts[0] * abs(glow - _glow(a, followed, psi_0, per_width, w, corners))
    error += (parts[1] * e2 + parts[2] * uneven) * lit
    wide = _glow(a, np.sqrt(square) * b, psi_0, per_width, w, corners)
    through = 0.5 * square * (length / radius) ** 2
    through = max(e2, through / (1.0 + through))
    error += parts[3] * (through * through + 0.5 * e2 * min(wide, 1.0))
    third = 0.25 * reach * max(0.0, abs(steep) - _NOISE_OF_SLOPE * noise / np.sqrt(facet + 1e-300))
    error += parts[4] * third / (1.0 + third) * fall_beside
    error += parts[5] * _glow(a, hollow, psi_0, per_width, w, corners)
    # Faces larger than light reaches do not blur it.
    held = reach / (reach + facet)
    error += parts[6] * facet * (k1 * k1 + k2 * k2) / (length * length) * lit
    # Next to the terminator a mesh and a table resolve no less than elsewhere.
    edge_ = 1.0 / (1.0 + (a / _EDGE) ** 2)
    error += parts[7] * (lit + 1.5 * edge_ * edge_)
    error += parts[8] * held * rough * lit
    crossed = np.sqrt(np.cbrt(4.0 * held * (1.0 - held))) * at[7]
    error += (parts[9] * tilt + parts[10] * crossed) * sine * fall_beside
    error += parts[11] * e2 + parts[12] * _glow(a, beside, psi_0, per_width, w, corners)
    return min(max(error, parts[13]), 1.0)


@compiled()
def _fall(a: float, b: float, per_width: float) -> float:
    """Return how the glow falls off in the dark, where the light is bent by b."""
    fall = 1.0 / (1.0 + max(-a, 0.0) * per_width / (b + 1e-300))
    fall *= fall
    fall *= fall
    return fall * fall


@compiled(parallel=True)
def errors(on: Where, lights: FloatArray, of: Spread, by: Known) -> FloatArray:
    """Return the sum of the terms over the lights, or the worst over all directions without any.

    Parameters
    ----------
    on : Where
        The vertices.
    lights : ndarray, shape=(l, LIGHT_FIELDS)
        See `lutcore.lights.pack`.
    of : Spread
        How light spreads.
    by : Known
        What the model has right.

    Returns
    -------
    ndarray, shape=(n, 3)
        In R_d and the lights' unit of irradiance, at most 1 for each light; 0 without a normal.
    """
    points, normals, directions, slope = on.points, on.normals, on.directions, on.slope
    k, noise, facet, rough, tilt = on.curvatures, on.error, on.facet, on.rough, on.tilt
    bumps = on.bumps
    length, psi_0, per_width, square = of.length, of.psi_0, of.per_width, of.square
    w, corners, entering = of.weights, of.corners, of.entering
    radius, bend, off, parts = on.radius, by.bend, by.off, by.parts
    out = np.zeros((len(points), 3))
    for i in prange(len(points)):
        if normals[i, 0] == 0.0 and normals[i, 1] == 0.0 and normals[i, 2] == 0.0:
            continue
        steepest = np.sqrt(slope[i, 0] ** 2 + slope[i, 1] ** 2 + slope[i, 2] ** 2)
        grain = (bumps[i], bumps[i] ** _STEEPER)
        at = (k[i, 0], k[i, 1], noise[i], facet[i], rough[i], tilt[i], *grain, steepest)
        for light in range(len(lights)):
            x, y, z, strength = light_at(lights, light, points[i, 0], points[i, 1], points[i, 2])
            a = normals[i, 0] * x + normals[i, 1] * y + normals[i, 2] * z
            u = directions[i, 0, 0] * x + directions[i, 0, 1] * y + directions[i, 0, 2] * z
            v = directions[i, 1, 0] * x + directions[i, 1, 1] * y + directions[i, 1, 2] * z
            way = (a, u, v, slope[i, 0] * x + slope[i, 1] * y + slope[i, 2] * z)
            for c in range(3):
                spread = (length[c], psi_0[c], per_width[c], square[c])
                fresnel = (w[c], corners[c], entering[c], off[c])
                error = _error(at, way, spread, radius, bend, *fresnel, parts)
                out[i, c] += lights[light, 8 + c] * strength * error
        if len(lights) == 0:
            for a in _WORST:
                sine = np.sqrt(1.0 - a * a)
                for way in ((a, sine, 0.0, steepest * sine), (a, 0.0, sine, steepest * sine)):
                    for c in range(3):
                        spread = (length[c], psi_0[c], per_width[c], square[c])
                        fresnel = (w[c], corners[c], entering[c], off[c])
                        error = _error(at, way, spread, radius, bend, *fresnel, parts)
                        out[i, c] = max(out[i, c], error)
    return out


@compiled(parallel=True)
def irradiances(points: FloatArray, lights: FloatArray) -> FloatArray:
    """Return the irradiance at vertices that would face all lights.

    Parameters
    ----------
    points : ndarray, shape=(n, 3)
        Positions, mesh units.
    lights : ndarray, shape=(l, LIGHT_FIELDS)
        See `lutcore.lights.pack`.

    Returns
    -------
    ndarray, shape=(n, 3)
        By channel.
    """
    out = np.zeros((len(points), 3))
    for i in prange(len(points)):
        for light in range(len(lights)):
            strength = light_at(lights, light, points[i, 0], points[i, 1], points[i, 2])[3]
            for c in range(3):
                out[i, c] += strength * lights[light, 8 + c]
    return out


@compiled()
def around(
    points: FloatArray, faces: IndexArray, normals: FloatArray, values: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, float]:
    """Return what the faces at each vertex tell.

    Parameters
    ----------
    points : ndarray, shape=(n, 3)
        Positions, mesh units.
    faces : ndarray, shape=(m, 3)
        Triangles.
    normals : ndarray, shape=(n, 3)
        Unit normals.
    values : ndarray, shape=(n,)
        A field.

    Returns
    -------
    slope : ndarray, shape=(n, 3)
        The field's gradient, the mean of the faces' by area.
    area : ndarray, shape=(n,)
        A third of the faces'.
    rough : ndarray, shape=(n,)
        Mean by area of 1 - cos of the angle between a face's normal and the vertex's.
    radius : float
        Thrice the volume over the area, mesh units: that of a ball; infinite for an open surface.
    """
    slope, area = np.zeros((len(points), 3)), np.zeros(len(points))
    rough = np.zeros(len(points))
    six, whole, open_x, open_y, open_z = 0.0, 0.0, 0.0, 0.0, 0.0
    for face in range(len(faces)):
        i, j, k = faces[face, 0], faces[face, 1], faces[face, 2]
        ux, uy, uz = edge(points, i, j)
        vx, vy, vz = edge(points, i, k)
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        twice = np.sqrt(nx * nx + ny * ny + nz * nz)
        if twice == 0.0:
            continue
        whole += twice
        open_x, open_y, open_z = open_x + nx, open_y + ny, open_z + nz
        six += points[i, 0] * nx + points[i, 1] * ny + points[i, 2] * nz
        uu, uv = ux * ux + uy * uy + uz * uz, ux * vx + uy * vy + uz * vz
        vv = vx * vx + vy * vy + vz * vz
        along, across = values[j] - values[i], values[k] - values[i]
        s, t = (along * vv - across * uv) / twice, (across * uu - along * uv) / twice
        for corner in range(3):
            v = faces[face, corner]
            area[v] += twice
            slope[v, 0] += s * ux + t * vx
            slope[v, 1] += s * uy + t * vy
            slope[v, 2] += s * uz + t * vz
            rough[v] += twice - (nx * normals[v, 0] + ny * normals[v, 1] + nz * normals[v, 2])
    for v in range(len(points)):
        if area[v] > 0.0:
            rough[v] /= area[v]
            for axis in range(3):
                slope[v, axis] /= area[v]
    # The normals of a closed surface, by area, add up to nothing.
    unclosed = np.sqrt(open_x * open_x + open_y * open_y + open_z * open_z)
    closed = whole > 0.0 and unclosed < _CLOSED * whole and six > 0.0
    return slope, area / 6.0, rough, six / whole if closed else np.inf
