"""The terms of a local shading model's error, vertex by vertex; compiled.

Per R_d and unit irradiance, with the hinges c F_t(c) ~ sum_j w_j max(0, c - c_j) and lengths in
l_u, the exitance of a curved surface is to second order

    M = E(a) + G(b) - X + Y,    a = N.w,  E(a) = c F_t(c),  c = max(a, 0),  b = |S+ w_t|,
    G(b) = sum_j w_j b psi(|a - c_j|/b),    X ~ E2/(1 + E2) (E + G),
    Y ~ <r^2>/4 E'(a) grad(k1 + k2).w,

because the Laplacian of the normal is grad(k1 + k2) - (k1^2 + k2^2) N. On a mesh

    h = <r^2>/(<r^2> + A)

tells how far light crosses facets, A the area of the mesh per vertex. The terms, in the order of
`lutcore.prediction.WEIGHTS`:

- first: |G(b) - G(b')|, b' the bending that the model follows;
- second: X; anisotropy: its part with (k1 - k2)^2, for models that know one curvature;
- higher: e^(5/4), e = E2/(1 + E2), or that of a ball of the body's volume over its area, where that
  is more: light that goes through the body. Found on ellipsoids, tori, cylinders and scans alike,
  over four decades of e^2;
- third: the size of Y with E' = 1, less what the error bar makes of the gradient; concave: G of the
  concave part of S;
- corner: what is known with its sign,

      |D (E + G) + s (E(a) - E(a_0)) + (1 - h^(1/2))^2 B/8 - Y|,

  where

  D is the share of 2 pi that the angles at the vertex lack: light that crosses no facet comes out
  of these angles alone. a_0 = N_0.w is that of the bare normal N_0, the facets' mean by area. One
  scale for all channels smooths what light does not blur: s ~ 1 - h^(1/2), as far as facets are
  rougher than curvature makes them. Normals by channel smooth somewhat less than light does:
  s ~ -(1 - h)/h^(1/2), small as E(a) - E(a_0) is there. B is by how much E bends from end to end of
  a facet's sides e and back,

      B = E(a + d) + E(a - d) - (2 + tr S T S) E(a),  d^2 = w.S T S w,  T = <e e^T>:

  the middles of the sides are off the mean of their ends by B/8, of which gathered light, linear
  over patches, has the integral right and not the value at the corner. It tells the less the
  farther light crosses the facet, and what bends more is cut, so B fades. Nor has it Y right there:
  along a side light rises by half the gradient's share at once, as if <r^2> were larger by
  _CHORD (<r^2> A)^(1/2). Y is small, or the gradient does not last as far as light reaches;
- base: what references and tables resolve;
- bumps: (2 r)^(1/2) h^(1/2) less a share of h, r the mean of 1 - cos between the facets and N_0
  beyond what curvature makes of it: light blurs facets that no normal follows. Half of it where
  normals are those by channel: they do follow. Less of it, and of strays, where the light stands
  high: E bends less there;
- residue: E2/(1 + E2) alone, for tables that are off in the dark;
- beside: G(b*) - G(b), b* what curvature may be beside the vertex: from its size where it turns the
  normal within reach, its error bar, and its gradient over <r^2>^(1/2). What is flat or hollow here
  and faces away may have a lit ridge within reach; third and bumps fade into the dark by b*, too;
- strays: v, by which normals stray within what light sees beyond what curvature makes of it, their
  variance less <r^2>/2 (k1^2 + k2^2): what is flat in the mean may have lit and dark parts;
- unsure: the same four parts without their signs, twice where facets are rough: where they cancel,
  what is off in each is left;
- least: no light's error is foreseen to be less.

psi is not looked up: psi(0)/(1 + u/L)^8, of the same value at 0 and the same integral, costs no
table and is near enough to a bound.
"""

from typing import NamedTuple

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled
from lutcore.lights import light_at

# Half width of the terminator, in N.w.
_EDGE = 0.1
DOUBT = 15.0
"""By how much the error bar of curvature counts in b*."""

# By how much its size and its gradient do.
_SIZE, _CHANGE = 2.0, 1.0
# The error bar over the facets' width, times this, is how much of the gradient may be noise.
_NOISE_OF_SLOPE = 3.0
# Of e for the whole body.
_THROUGH = 0.47
# Share of 1 - h^(1/2), and of (1 - h)/h^(1/2), that s is.
_ONE_SCALE, _BY_CHANNEL = 1.5, 0.5
_LEAST_CROSSED = 1e-3
# Mean of 1 - cos that curvature makes of facets, over tr S T S, and twice what roughness beyond it
# has to be, for normals of one scale to have smoothed something.
_EXPLAINED, _SMOOTHED = 0.31, 0.037
BENT, CUT = 0.125, 0.018
"""Share of B that is off, and the B beyond which gathered light is cut."""
# How steep E is, is read off over this much at least of N.w.
_SECANT = 0.02
# Share of (<r^2> A)^(1/2) that counts as <r^2> in Y, and by how much Y lessens itself.
_CHORD, _LASTS = 0.45, 35.0
# How bumps fade where light crosses facets, and into the dark with b*.
_BLURRED, _WIDER = 0.75, 1.6
# Share of them where normals follow what light sees.
_FOLLOWED = 0.5
# By how much what strays is turned to the light.
_STRAYED = 8.0
# Cosines of the light among which the worst is sought where no light is known: the error is
# largest near the terminator, where F_t bends most, or straight above.
_WORST = np.array([-0.5, -0.2, -0.05, 0.0, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0])


class Where(NamedTuple):
    """As in `lutcore.prediction.Scene`."""

    points: FloatArray
    normals: FloatArray
    variance: FloatArray
    bare: FloatArray
    curvatures: FloatArray
    directions: FloatArray
    error: FloatArray
    slope: FloatArray
    facet: FloatArray
    sides: FloatArray
    grain: FloatArray
    corner: FloatArray
    radius: float
    by_channel: bool


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
def _fall(a: float, b: float, per_width: float) -> float:
    """Return how the glow falls off in the dark, where the light is bent by b."""
    fall = 1.0 / (1.0 + max(-a, 0.0) * per_width / (b + 1e-300))
    fall *= fall
    fall *= fall
    return fall * fall


@compiled()
def _read(curve: FloatArray, cosine: float) -> float:
    at = 0.5 * (min(max(cosine, -1.0), 1.0) + 1.0) * (len(curve) - 1)
    i = min(int(at), len(curve) - 2)
    value: float = curve[i] + (at - i) * (curve[i + 1] - curve[i])
    return value


@compiled()
def _still(
    at: tuple[float, ...],
    variance: float,
    spread: tuple[float, float, float, float],
    radius: float,
    by_channel: bool,
    parts: FloatArray,
) -> tuple[float, ...]:
    """Return what the terms of one vertex and channel have without a light.

    `at` is k1, k2, error, facet, grain, corner, the size of the slope and T, `spread` that of the
    channel. Returned are l_u k1, l_u k2, what b*^2 has beyond b^2, what counts times E + G, what
    counts everywhere, <r^2>/4 in mm^2, what the mesh makes of it, what of the gradient may be
    noise, D, s, the error of bumps, that of what strays and by how much it turns what is dark to
    the light, S T S, the share of B and that of what is unsure.
    """
    length, _, per_width, square = spread
    k1, k2 = length * at[0], length * at[1]
    noise, facet = at[2], at[3]
    reach, both = square * length * length, at[0] * at[0] + at[1] * at[1]
    e2 = square * (2.0 * (k1 * k1 + k2 * k2) + (k1 + k2) ** 2) / 16.0
    e2 /= 1.0 + e2
    uneven = square * (k1 - k2) ** 2 / 16.0
    uneven /= 1.0 + uneven
    change = (reach * at[6]) ** 2
    turned = reach * both
    beyond = length * length * (_SIZE * _SIZE * both * turned / (1.0 + turned))
    beyond += (DOUBT * length * noise) ** 2 + _CHANGE * _CHANGE * change / square
    share = parts[1] * e2 + parts[2] * uneven + parts[7]
    through = _THROUGH * square * (length / radius) ** 2
    through = max(e2, through / (1.0 + through))
    everywhere = parts[3] * through * np.sqrt(np.sqrt(through)) + parts[9] * e2
    h = reach / (reach + facet)
    root, rest = np.sqrt(h), 1.0 - h
    bent, bent_beside = at[7] * at[0] * at[0], at[9] * at[1] * at[1]
    turns = bent + bent_beside
    rougher = 2.0 * max(0.0, at[4] - _EXPLAINED * turns)
    rough = rougher / (rougher + _SMOOTHED * turns + 1e-12)
    if by_channel:
        s = -_BY_CHANNEL * rest / np.sqrt(h + _LEAST_CROSSED)
    else:
        s = _ONE_SCALE * (1.0 - root) * rough
    angle, strays = np.sqrt(rougher), np.sqrt(max(0.0, variance - 0.5 * turned))
    return (
        k1,
        k2,
        beyond,
        share,
        everywhere,
        0.25 * reach,
        0.25 * (reach + _CHORD * np.sqrt(reach * facet) * rest),
        _NOISE_OF_SLOPE * noise / np.sqrt(facet + 1e-300),
        at[5],
        s,
        parts[8] * angle * root * (1.0 - _BLURRED * h) * (_FOLLOWED if by_channel else 1.0),
        parts[11] * strays,
        _STRAYED * per_width * strays,
        bent,
        at[8] * at[0] * at[1],
        bent_beside,
        BENT * (1.0 - root) * (1.0 - root),
        parts[12] * (1.0 + rough),
    )


@compiled()
def _error(
    way: tuple[float, float, float, float, float],
    still: tuple[float, ...],
    spread: tuple[float, float, float, float],
    bend: int,
    w: FloatArray,
    corners: FloatArray,
    entering: FloatArray,
    off: FloatArray,
    parts: FloatArray,
) -> float:
    """Return the bound for one light and channel.

    Numbers and bare arrays instead of named tuples, which would be copied with every call. `way` is
    N.w, N_0.w, w along both principal directions and the slope along w, `still` from `_still`,
    `spread` that of the channel.
    """
    a, bare, u, v, steep = way
    _, psi_0, per_width, _ = spread
    k1, k2, beyond, share, everywhere, reach, on_mesh, noise = still[:8]
    corner, s, bumps, strays, strayed, bent, across, bent_beside, off_by, doubt = still[8:]
    p, q = max(k1, 0.0), max(k2, 0.0)
    convex = (p * u) ** 2 + (q * v) ** 2
    concave = ((k1 - p) * u) ** 2 + ((k2 - q) * v) ** 2
    b, beside = np.sqrt(convex), np.sqrt(convex + beyond)
    followed = b
    if bend == 0:
        followed = 0.0
    elif bend == 1:
        followed = 0.5 * (p + q) * np.sqrt(u * u + v * v)
    elif bend == 2:
        followed = np.sqrt(0.5 * (p * p + q * q) * (u * u + v * v))
    glow, straight = _glow(a, b, psi_0, per_width, w, corners), _read(entering, a)
    lit = straight + glow
    # Where light goes round the terminator, <F_t> is off by as much as at the cosine there.
    if bend == 0:
        error = _read(off, a) + parts[0] * glow
    else:
        fall = _fall(a, b, per_width)
        error = fall * _read(off, min(max(a, 0.0) + followed * psi_0 * fall, 1.0))
        if bend != 3:
            error += parts[0] * abs(glow - _glow(a, followed, psi_0, per_width, w, corners))
    # Next to the terminator a mesh and a table resolve no less than elsewhere.
    edge_ = 1.0 / (1.0 + (a / _EDGE) ** 2)
    error += share * lit + everywhere + parts[7] * 1.5 * edge_ * edge_
    changes = max(0.0, abs(steep) - noise)
    third = reach * changes
    error += parts[4] * third / (1.0 + third) * _fall(a, beside, per_width)
    error += parts[5] * _glow(a, np.sqrt(concave), psi_0, per_width, w, corners)
    width = np.sqrt(max(bent * u * u + 2.0 * across * u * v + bent_beside * v * v, 0.0))
    secant = max(width, _SECANT)
    before, after = _read(entering, a - secant), _read(entering, a + secant)
    bends = (before + after - 2.0 * straight) * (width / secant) ** 2
    bends -= (bent + bent_beside) * straight
    bends /= 1.0 + (bends / CUT) ** 2
    rises = on_mesh * changes * (after - before) / (2.0 * secant)
    rises /= 1.0 + _LASTS * abs(rises)
    if steep < 0.0:
        rises = -rises
    sloped = s * (straight - _read(entering, bare))
    lacking, bent_by = corner * lit, off_by * bends
    unsure = abs(lacking) + abs(sloped) + abs(bent_by) + abs(rises)
    error += parts[6] * abs(lacking + sloped + bent_by - rises) + doubt * unsure
    blurred = bumps * _fall(a, _WIDER * beside, per_width)
    error += (blurred + strays * _fall(a, beside + strayed, per_width)) / (1.0 + max(a, 0.0))
    error += parts[10] * (_glow(a, beside, psi_0, per_width, w, corners) - glow)
    return min(max(error, parts[13]), 1.0)


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
    points, normals, variance = on.points, on.normals, on.variance
    bare, directions = on.bare, on.directions
    k, noise, slope, facet = on.curvatures, on.error, on.slope, on.facet
    sides, grain, corner = on.sides, on.grain, on.corner
    length, psi_0, per_width, square = of.length, of.psi_0, of.per_width, of.square
    w, corners, entering = of.weights, of.corners, of.entering
    radius, by_channel, bend, off, parts = on.radius, on.by_channel, by.bend, by.off, by.parts
    out = np.zeros((len(points), 3))
    for i in prange(len(points)):
        steepest = np.sqrt(slope[i, 0] ** 2 + slope[i, 1] ** 2 + slope[i, 2] ** 2)
        place = (points[i, 0], points[i, 1], points[i, 2])
        around = (noise[i], facet[i], grain[i], corner[i], steepest)
        at = (k[i, 0], k[i, 1], *around, sides[i, 0], sides[i, 1], sides[i, 2])
        for c in range(3):
            n = min(c, len(normals) - 1)
            nx, ny, nz = normals[n, i, 0], normals[n, i, 1], normals[n, i, 2]
            if nx == 0.0 and ny == 0.0 and nz == 0.0:
                continue
            spread = (length[c], psi_0[c], per_width[c], square[c])
            fresnel = (w[c], corners[c], entering[c], off[c])
            still = _still(at, variance[n, i], spread, radius, by_channel, parts)
            total = 0.0
            for light in range(len(lights)):
                x, y, z, strength = light_at(lights, light, *place)
                way = (
                    nx * x + ny * y + nz * z,
                    bare[i, 0] * x + bare[i, 1] * y + bare[i, 2] * z,
                    directions[i, 0, 0] * x + directions[i, 0, 1] * y + directions[i, 0, 2] * z,
                    directions[i, 1, 0] * x + directions[i, 1, 1] * y + directions[i, 1, 2] * z,
                    slope[i, 0] * x + slope[i, 1] * y + slope[i, 2] * z,
                )
                error = _error(way, still, spread, bend, *fresnel, parts)
                total += lights[light, 8 + c] * strength * error
            if len(lights) == 0:
                gap = (nx - bare[i, 0]) ** 2 + (ny - bare[i, 1]) ** 2 + (nz - bare[i, 2]) ** 2
                for a in _WORST:
                    sine = np.sqrt(1.0 - a * a)
                    lean = sine * np.sqrt(gap)
                    for up in (-1.0, 1.0):
                        for u, v in ((sine, 0.0), (0.0, sine)):
                            way = (a, a + up * lean, u, v, up * steepest * sine)
                            error = _error(way, still, spread, bend, *fresnel, parts)
                            total = max(total, error)
            out[i, c] = total
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
