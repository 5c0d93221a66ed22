"""From shape operators at several scales to one answer for each vertex, with its error bar."""

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import FloatArray, SingleArray
from lutcore.bands import INTERIOR, Bands, bands
from lutcore.borrowing import borrow
from lutcore.compiled import compiled
from lutcore.cosmoothing import Smoothed, Surface
from lutcore.curvature import PrincipalCurvatures
from lutcore.progress import Progress, silent, tell
from lutcore.refinement import refined
from lutcore.rims import jet_radius, jets_at
from lutcore.specks import doubt, specks
from lutcore.tensors import write_principal

# A star that smoothing has closed to less than this share of its extent tells nothing more.
_CLOSED = 0.05
# Bias at a scale, over the change to the next, squared: 1/(g - 1)^2 where that change itself grows
# by g from band to band. A filter of fourth order has g = 4 on wide features; near the scale it
# is less, which the bands tell. Never less than the first of these, nor g - 1 than the second.
_BIAS, _SLOWEST = 0.1, 0.65
# The unsmoothed star has no finer scale to compare with: nearly all the change is its error.
_RAW = 1.5
# A neighbourhood's own noise counts as much as that of its class, up to this many times it.
_OWN, _LOUDEST = 1.5, 3.3
# Nothing is known to be smooth over more than its radius of curvature: relative bias that is
# assumed at (scale k)^4 = 1, with k at half the scale.
_ROUND = 0.15
# Of scales that are as good, or all good enough, the finer one: each costs as much as if its
# squared error were larger by this.
_DEARER = 1.3
# Weights of scales fall with this power of their squared error, so that the choice has no seams.
_SHARPNESS = 2
# Vertices of which a median is taken: within .4 % of the ranks of all.
_SAMPLE = 20_000
# Of two squared errors the smaller is not less than a twentieth of both.
_FULL = 0.9
# Calibration: what the variances above must be multiplied by for one sigma to hold 68 % of the
# vertices of noisy surfaces; near rims neighbours err alike and more.
_CALIBRATION, _CALIBRATION_AT_RIM = 0.72, 1.5
# Joined scales err less than each of them, squared. Near rims not, nor where neighbours' noise is
# alike, which does not average out: white noise of the third band is .15 to .35 of the second's,
# noise correlated over 1.5 edges .7 to 2.3. In between, the first of these to the second.
_JOINED = 0.81
_ALIKE = (0.4, 0.7)
# Classes of vertices near a rim, which take over what inner vertices know better.
_RIM = 4
# A one-sided cubic multiplies noise: worth trying only where that of unsmoothed stars is below
# this share of the typical curvature.
_QUIET = 0.15
# A polyhedron is off by this times k^3 spacing^2 at any scale, as on a clean regular torus; by the
# second of these where its stars are lopsided, as at the ends of a clean cylinder.
_FACETS, _FACETS_AT_RIM = 0.2, 1.0


def tilt_correction(on: Surface, smoothed: Smoothed) -> float:
    """Return by how much noise has shortened the mean of unit normals, as a factor to undo it.

    Unit normals that noise tilts by an angle a have a mean of length <cos a>, and so do their
    differences. 1 - cos a of a tilt in two dimensions is distributed exponentially: its mean is
    its median over ln 2, and sharp edges do not move the median.

    Parameters
    ----------
    on : Surface
        The mesh.
    smoothed : Smoothed
        It, smoothed.

    Returns
    -------
    float
        A factor of at least 1 for every shape operator.
    """
    every = 1 + len(on.fields) // _SAMPLE
    lost = 1.0 - np.einsum("ij,ij->i", on.fields[::every, 3:], smoothed.normals[::every])
    return 1.0 / (1.0 - min(0.5, float(np.median(lost)) / float(np.log(2.0))))


def select(
    on: Surface,
    smoothed: Smoothed,
    lengths: FloatArray | float | None = None,
    precision: float = 0.0,
    steadiness: float = 1.0,
    progress: Progress = silent,
) -> PrincipalCurvatures:
    """Return the curvatures at each vertex's own scale.

    Parameters
    ----------
    on : Surface
        The mesh.
    smoothed : Smoothed
        It, smoothed, at scales that grow by sqrt(2) or so.
    lengths : float or ndarray, shape=(n,), optional
        Scale wanted, for all or for each vertex, mesh units. If not given, the one of least noise
        and bias together.
    precision : float
        Error, as a share of the typical curvature, below which the finer scale is taken.
    steadiness : float
        How much squared noise counts against squared bias in the choice of scales.
    progress : callable
        Told where the work stands.

    Returns
    -------
    PrincipalCurvatures
        One value for each vertex, with the scale that was used there.
    """
    tell(progress, 0.0, "telling noise from bias")
    typical = _typical_square(smoothed)
    floor = precision * precision * typical
    tensors, square, cost, used, lean, found = _chosen(on, smoothed, lengths, floor, steadiness)
    rim = found.place <= _RIM
    jets = np.empty(0, np.int32)
    if lengths is None:
        near = np.flatnonzero(rim).astype(np.int32)
        quiet = float(found.left[INTERIOR, 0]) < _QUIET**2 * typical
        if quiet and len(near):
            jets = jets_at(on, smoothed.normals, near, tensors, square)
            cost[jets] = square[jets]
            used[jets] = 0.0  # as precise as unsmoothed stars, and to be left as they are
    weak = np.flatnonzero((used < 0.0) | rim).astype(np.int32)
    links = (on.operator.start, on.operator.neighbour)
    closed = used[weak] < 0.0
    borrow(*links, smoothed.normals, weak, closed, tensors, square, cost[weak])
    lean[weak] = 0.0  # what they took over errs as it likes
    np.maximum(used, 0.0, out=used)
    few = specks(*links, np.flatnonzero(on.operator.rim).astype(np.int32))
    if len(few) < len(used):
        doubt(few, typical, tensors, square)
    tell(progress, 0.6, "joining scales")
    refined(on, smoothed.normals, used, tensors, square)
    used[jets] = jet_radius(on)
    tell(progress, 0.9, "principal directions")
    facets = np.where(rim, _FACETS_AT_RIM, _FACETS)
    k, directions = np.empty((2, len(used))), np.empty((2, len(used), 3))
    error, tilt = np.empty(len(used)), tilt_correction(on, smoothed)
    given = smoothed.normals, tensors, square, tilt, facets * on.spacing**2
    _principal(*given, k, directions, error)
    return PrincipalCurvatures(
        k[0], k[1], directions[0], directions[1], smoothed.normals, error, used, lean=lean
    )


def scales_chosen(
    on: Surface, smoothed: Smoothed, precision: float, steadiness: float
) -> FloatArray:
    """Return the scale that each vertex chooses.

    Parameters
    ----------
    on, smoothed, precision, steadiness
        As in `select`.

    Returns
    -------
    ndarray, shape=(n,)
        Mesh units; -1 where every star has closed.
    """
    floor = precision * precision * _typical_square(smoothed)
    return _chosen(on, smoothed, None, floor, steadiness)[3]


def _chosen(
    on: Surface,
    smoothed: Smoothed,
    lengths: FloatArray | float | None,
    floor: float,
    steadiness: float,
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray, Bands]:
    """Return what `_mix` does, and what it was judged by; `floor` is of the squared error."""
    found = bands(on, smoothed)
    wanted = np.zeros(len(on.fields))  # 0: let the vertex choose
    if lengths is not None:
        wanted[:] = lengths
    vertices = len(on.fields)
    mixed = np.empty((vertices, 3)), *np.empty((4, vertices))
    kept = found.noise[INTERIOR, 2] / found.noise[INTERIOR, 1]
    _mix(
        smoothed.tensors,
        smoothed.stretch,
        *found,
        np.array(smoothed.scales[:-1]),
        wanted,
        floor,
        steadiness,
        1.0 / on.spacing,
        float(np.interp(kept, _ALIKE, (_JOINED, 1.0))),
        *mixed,
    )
    return *mixed, found


def _typical_square(smoothed: Smoothed) -> float:
    """Return the median of (k1^2 + k2^2)/2 at the middle scale."""
    every = 1 + len(smoothed.tensors) // _SAMPLE
    tensor = smoothed.tensors[::every, len(smoothed.scales) // 2].astype(np.float64)
    return float(np.median(0.5 * (tensor[:, 0] ** 2 + tensor[:, 2] ** 2) + tensor[:, 1] ** 2))


@compiled(parallel=True)
def _mix(
    tensors: SingleArray,
    stretch: SingleArray,
    energy: SingleArray,
    room: SingleArray,
    place: NDArray[np.int8],
    noise: FloatArray,
    left: FloatArray,
    lean: SingleArray,
    scales: FloatArray,
    wanted: FloatArray,
    floor: float,
    steadiness: float,
    unknown: float,
    joined: float,
    mixed: FloatArray,
    square: FloatArray,
    cost: FloatArray,
    used: FloatArray,
    leaning: FloatArray,
) -> None:
    """Write tensors, squared error bars, those with noise counted by `steadiness`, scales, lean.

    The scale is -1 where every star has closed. For the lean see `PrincipalCurvatures`.
    """
    vertices, count = len(energy), noise.shape[1]
    last = count - 1
    for i in prange(vertices):
        typical, rest = np.empty(count), np.empty(count)
        for j in range(count):
            larger = room[i] if j > 0 else np.float32(1.0)
            typical[j], rest[j] = noise[place[i], j] * larger, left[place[i], j] * larger
        calibration = _CALIBRATION if place[i] == INTERIOR else _CALIBRATION_AT_RIM
        errors = np.empty(count)
        steady = np.empty(count)
        # What bias does to k1 more than to k2, over what it does to both; less where noise counts.
        apart = lean[i] / max(energy[i, last], 1e-300)
        costs = np.empty(count)
        biased = np.empty(count)
        best, dearer = np.inf, 1.0
        lost = 0.0
        for j in range(count):
            # A neighbourhood is as noisy as the band that is finer by one tells.
            band = max(j - 1, 0)
            share = min((energy[i, band] / typical[band] + _OWN) / (1.0 + _OWN), _LOUDEST)
            heard = calibration * share * rest[j]
            if j == 0:
                errors[j] = max(_RAW * energy[i, 0], heard)
                steady[j] = steadiness * errors[j]
            else:
                finer, coarser = energy[i, j - 1], energy[i, j]
                bias = max(0.0, coarser - share * typical[j])
                if j + 1 < count:
                    growth = max(0.0, energy[i, j + 1] - share * typical[j + 1]) / (bias + 1e-300)
                    bias /= max(np.sqrt(growth) - 1.0, _SLOWEST) ** 2
                bias = max(bias, _BIAS * max(0.0, coarser - share * typical[j]))
                # What the surface loses for good: the part of a band that stands out from the
                # noise of its class and fades no faster than an edge does, by half a band.
                fading = typical[j] / typical[j - 1]
                edge = (coarser - fading * finer) / max(0.5 - fading, 0.25)
                lost += np.sqrt(max(0.0, min(finer, edge) - _LOUDEST * typical[j - 1]))
                errors[j] = heard + max(bias, lost * lost)
                size = _square(tensors[i, max(j - 2, 1)])
                errors[j] += min(_ROUND**2 * (size * scales[j] ** 2) ** 4, 100.0) * size
                steady[j] = errors[j] + (steadiness - 1.0) * heard
            biased[j] = errors[j] - heard
            if stretch[i, j] < _CLOSED or (j > 0 and stretch[i, j + 1] < _CLOSED):
                errors[j] = steady[j] = np.inf
            costs[j] = max(steady[j], floor) * dearer
            dearer *= _DEARER
            best = min(best, costs[j])
        total = square[i] = cost[i] = used[i] = leaning[i] = 0.0
        mixed[i, 0] = mixed[i, 1] = mixed[i, 2] = 0.0
        for j in range(count):
            if wanted[i] == 0.0:
                weight = (best / costs[j]) ** _SHARPNESS
            else:
                weight = _share_of(scales, j, wanted[i]) if errors[j] < np.inf else 0.0
            if weight > 0.01:
                total += weight
                # Errors of nested scales are much the same one: they add up, not their squares.
                square[i] += weight * np.sqrt(errors[j])
                cost[i] += weight * np.sqrt(steady[j])
                leaning[i] += weight * apart * biased[j]
                used[i] += weight * scales[j]
                for entry in range(3):
                    mixed[i, entry] += weight * tensors[i, j, entry]
        if total > 0.0 and not (used[i] == 0.0 and stretch[i, 1] < _CLOSED):
            square[i] = (square[i] / total) ** 2
            if place[i] == INTERIOR:
                square[i] *= joined
            cost[i] = (cost[i] / total) ** 2
            # Joining scales takes from noise, not from bias: its share is of what is left.
            leaning[i] = min(max(leaning[i] / total / max(square[i], 1e-300), -_FULL), _FULL)
            used[i] /= total
            for entry in range(3):
                mixed[i, entry] /= total
        else:
            used[i] = -1.0
            for entry in range(3):
                mixed[i, entry] = tensors[i, 0, entry]
            # Nothing tells a flat speck from a curved one of the same size.
            square[i] = cost[i] = energy[i, 0] + _square(tensors[i, 0]) + unknown * unknown


@compiled()
def _square(tensor: SingleArray) -> float:
    """Return (k1^2 + k2^2)/2."""
    xx, xy, yy = float(tensor[0]), float(tensor[1]), float(tensor[2])
    return 0.5 * (xx * xx + yy * yy) + xy * xy


@compiled()
def _share_of(scales: FloatArray, j: int, length: float) -> float:
    """Return the weight of scale j in linear interpolation to a length."""
    if length <= scales[1]:
        return 1.0 if j == 1 else 0.0
    if length >= scales[-1]:
        return 1.0 if j == len(scales) - 1 else 0.0
    if j > 0 and scales[j - 1] < length <= scales[j]:
        return (length - scales[j - 1]) / (scales[j] - scales[j - 1])
    if j + 1 < len(scales) and scales[j] < length <= scales[j + 1]:
        return (scales[j + 1] - length) / (scales[j + 1] - scales[j])
    return 0.0


@compiled(parallel=True)
def _principal(
    normals: FloatArray,
    tensors: FloatArray,
    square: FloatArray,
    factor: float,
    facets: FloatArray,
    k: FloatArray,
    directions: FloatArray,
    error: FloatArray,
) -> None:
    for i in prange(len(normals)):
        n = (normals[i, 0], normals[i, 1], normals[i, 2])
        tensor = (factor * tensors[i, 0], factor * tensors[i, 1], factor * tensors[i, 2])
        write_principal(i, n, tensor, k, directions)
        size = 0.5 * (k[0, i] * k[0, i] + k[1, i] * k[1, i])
        error[i] = np.sqrt(factor * factor * square[i] + facets[i] ** 2 * size**3)
