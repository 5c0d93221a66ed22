"""What curvature gains or loses from one scale to the next, and how much of it is noise.

Band j of a vertex is the difference of its shape operators at scales j and j + 1. Noise fills the
fine bands and fades towards the coarse ones; the bias of smoothing grows with the scale.
"""

from typing import NamedTuple

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import BoolArray, FloatArray, IndexArray, SingleArray
from lutcore.compiled import compiled
from lutcore.cosmoothing import Smoothed, Surface

# Rings from the rim where a new class of vertices begins; beyond the last, the interior. Near a
# rim noise is averaged along the rim alone and fades more slowly with the scale.
_RINGS = np.array([1, 2, 3, 5, 8, 12])
INTERIOR = len(_RINGS)
"""The class of vertices that no rim is near to."""
# Classes of fewer vertices are judged as the interior.
_LEAST_CLASS = 30
# Passes over one-rings that average the energies: a Gaussian of two spacings.
_PASSES = 8
# Bands that one loop averages together; constant columns become vector instructions.
_TOGETHER = 8
# Stands for no energy at all, mesh sizes being about 1.
_NONE = 1e-30
# Bounds of the areas over their median that noise follows.
_ROOM = (0.125, 8.0)
# Vertices that vote on the noise of a class: their quartile is within .7 % of the ranks.
_VOTERS = 4_000
# The quiet quarter of a mesh tells the noise, the rest may hold detail; of pure noise, averaged as
# here, the 25th percentile is this share of the mean.
_QUARTER, _QUARTER_OF_MEAN = 0.25, 0.7
# Noise is alike everywhere: of pure noise the 75th percentile is 1.6 to 2.2 times the 25th. The
# more it is, from the first to the second of these, and at more spacings than neighbours' noise may
# be correlated over, energy that does not fade from band to band by at least a factor (white noise:
# 4 to 8) is not noise.
_ALIKE, _UNLIKE, _CORRELATED = 2.5, 6.0, 4.1
_FADING, _FADING_AT_RIM = 4.0, 2.5


class Bands(NamedTuple):
    """The bands of a mesh.

    Parameters
    ----------
    energy : ndarray of float32, shape=(n, S or more)
        Mean square of a principal curvature's change from each scale to the next, averaged over
        the neighbourhood, 1/mesh unit squared; columns behind the S of `noise` are none.
    room : ndarray of float32, shape=(n,)
        Vertex area over the median, averaged likewise: what white noise of a scale that spans
        several vertices is in proportion to.
    place : ndarray of int8, shape=(n,)
        Class of each vertex by its distance from the rim.
    noise : ndarray, shape=(INTERIOR + 1, S)
        The part of a class's energy that is noise, where `room` is 1.
    left : ndarray, shape=(INTERIOR + 1, S)
        Noise of the curvature itself at each scale: that of its band and of all coarser ones.
    lean : ndarray of float32, shape=(n,)
        By how much k1 changes more than k2 in the coarsest band: the mean of half the difference
        of their squared changes, 1/mesh unit squared; noise changes both alike.
    """

    energy: SingleArray
    room: SingleArray
    place: NDArray[np.int8]
    noise: FloatArray
    left: FloatArray
    lean: SingleArray


def bands(on: Surface, smoothed: Smoothed) -> Bands:
    """Return the bands of a smoothed mesh.

    Parameters
    ----------
    on : Surface
        The mesh.
    smoothed : Smoothed
        It, smoothed, at three scales or more beside 0.

    Returns
    -------
    Bands
        One band fewer than there are scales.
    """
    start, neighbour = on.operator.start, on.operator.neighbour
    middle = len(smoothed.scales) // 2
    count = len(smoothed.scales) - 1
    # Areas and lean are averaged along; filled up with zeros.
    groups = (count + 1) // _TOGETHER + 1
    table = np.empty((groups, len(on.areas), _TOGETHER), np.float32)
    _energies(smoothed.tensors, on.areas / on.spacing**2, middle, table)
    spare = np.empty_like(table)
    links = on.operator.links
    for _ in range(_PASSES):
        for group in range(groups):
            _average(*links, table[group], spare[group])
        table, spare = spare, table
    columns = table[0] if groups == 1 else np.concatenate(table, axis=1)
    room, lean = np.clip(columns[:, count], *_ROOM), columns[:, count + 1].copy()
    place = _places(start, neighbour, on.operator.rim)
    noise = _noise(columns, room, place, np.array(smoothed.scales[:-1]) / on.spacing)
    # Beyond the last band the noise goes on fading as it did between the last two.
    ratio = np.clip(noise[:, -1] / noise[:, -2], 0.1, 0.6)
    left = (
        np.cumsum(noise[:, ::-1], axis=1)[:, ::-1] + (noise[:, -1] * ratio / (1 - ratio))[:, None]
    )
    return Bands(columns, room, place, noise, left, lean)


def _noise(
    energy: SingleArray, room: SingleArray, place: NDArray[np.int8], spacings: FloatArray
) -> FloatArray:
    """Return the part of each class's energy that is noise, where room is 1."""
    noise = np.empty((INTERIOR + 1, len(spacings)))
    for kind in (INTERIOR, *range(INTERIOR)):
        members = np.flatnonzero(place == kind)
        if len(members) < _LEAST_CLASS:
            if kind != INTERIOR:
                noise[kind] = noise[INTERIOR]
                continue
            members = np.arange(len(energy))
        members = members[:: 1 + len(members) // _VOTERS]
        voters = np.ascontiguousarray(energy[members, : len(spacings)].T)
        voters[1:] /= room[members]
        noise[kind] = _faded(voters, spacings, _FADING if kind == INTERIOR else _FADING_AT_RIM)
    return noise


def _faded(voters: SingleArray, spacings: FloatArray, fading: float) -> FloatArray:
    """Return the noise in the bands of one class, each a row of its voters."""
    # As `np.percentile`, which takes three times as long as sorting.
    ranked = np.sort(voters, axis=1).astype(np.float64)
    quiet, loud = (_quarter(one) + _NONE for one in (ranked, ranked[:, ::-1]))
    noise = quiet / _QUARTER_OF_MEAN
    for band in range(1, len(noise)):
        apart = np.log(loud[band] / quiet[band])
        doubt = np.interp(apart, np.log([_ALIKE, _UNLIKE]), [0.0, 1.0])
        if spacings[band] > _CORRELATED:
            doubt = 1.0
        faded = min(1.0, noise[band - 1] / fading / noise[band])
        noise[band] *= faded**doubt
    return noise


def _quarter(ranked: FloatArray) -> FloatArray:
    """Return the value that a quarter of each sorted row lies before."""
    rank = _QUARTER * (ranked.shape[1] - 1)
    before = int(rank)
    after = min(before + 1, ranked.shape[1] - 1)
    found: FloatArray = ranked[:, before] + (rank - before) * (ranked[:, after] - ranked[:, before])
    return found


@compiled(parallel=True)
def _energies(tensors: SingleArray, areas: FloatArray, middle: int, table: SingleArray) -> None:
    """Write half the squared change of k1 and k2 from each scale to the next, areas, and lean.

    To first order k1 and k2 change by the entries of the difference on the diagonal of the
    principal frame, and by the one off it only where k1 and k2 are closer than it is large.
    """
    count, scales = tensors.shape[0], tensors.shape[1] - 1
    width = table.shape[2]
    for i in prange(count):
        table[scales // width, i, scales % width] = areas[i]
        for band in range(scales + 1, table.shape[0] * width):
            table[band // width, i, band % width] = 0.0
        # Of the principal frame it takes the cosine and sine of twice its angle.
        skew = 0.5 * (float(tensors[i, middle, 0]) - float(tensors[i, middle, 2]))
        shear = float(tensors[i, middle, 1])
        radius = np.sqrt(skew * skew + shear * shear)  # (k1 - k2)/2; no float32's square underflows
        gap = 4.0 * radius * radius
        cosine, sine = (skew / radius, shear / radius) if radius > 0.0 else (1.0, 0.0)
        for band in range(scales):
            xx = tensors[i, band, 0] - tensors[i, band + 1, 0]
            xy = tensors[i, band, 1] - tensors[i, band + 1, 1]
            yy = tensors[i, band, 2] - tensors[i, band + 1, 2]
            mean, half = 0.5 * (xx + yy), 0.5 * (xx - yy)
            along = cosine * half + sine * xy
            across = cosine * xy - sine * half
            size = 4.0 * (along * along + across * across)
            mixed = size / (gap + size + 1e-300)
            energy = mean * mean + along * along + mixed * across * across
            table[band // width, i, band % width] = energy
            if band == scales - 1:
                after = scales + 1
                table[after // width, i, after % width] = 2.0 * mean * along


@compiled(parallel=True, packed=True)
def _average(
    start: NDArray[np.uint32],
    neighbour: NDArray[np.uint32],
    values: SingleArray,
    out: SingleArray,
) -> None:
    """Write the mean of each vertex and its neighbours, in `_TOGETHER` columns."""
    for i in prange(len(values)):
        share = np.float32(1.0) / np.float32(1 + start[i + 1] - start[i])
        s0, s1, s2, s3 = values[i, 0], values[i, 1], values[i, 2], values[i, 3]
        s4, s5, s6, s7 = values[i, 4], values[i, 5], values[i, 6], values[i, 7]
        for at in range(start[i], start[i + 1]):
            j = neighbour[at]
            s0, s1 = s0 + values[j, 0], s1 + values[j, 1]
            s2, s3 = s2 + values[j, 2], s3 + values[j, 3]
            s4, s5 = s4 + values[j, 4], s5 + values[j, 5]
            s6, s7 = s6 + values[j, 6], s7 + values[j, 7]
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = share * s0, share * s1, share * s2, share * s3
        out[i, 4], out[i, 5], out[i, 6], out[i, 7] = share * s4, share * s5, share * s6, share * s7


def _places(start: IndexArray, neighbour: IndexArray, rim: BoolArray) -> NDArray[np.int8]:
    """Return the class of each vertex: its ring from the rim, in steps."""
    if not rim.any():
        return np.full(len(rim), INTERIOR, np.int8)
    rings = _rings_from(start, neighbour, np.flatnonzero(rim).astype(np.int32), int(_RINGS[-1]))
    return np.searchsorted(_RINGS, rings, side="right").astype(np.int8)


@compiled()
def _rings_from(
    start: IndexArray, neighbour: IndexArray, seeds: IndexArray, farthest: int
) -> NDArray[np.int16]:
    """Return in which ring around the seeds each vertex lies; `farthest` for all beyond."""
    ring = np.full(len(start) - 1, farthest, np.int16)
    front = seeds
    for seed in seeds:
        ring[seed] = 0
    for distance in range(1, farthest):
        reached = np.empty(len(ring), np.int32)
        found = 0
        for vertex in front:
            for at in range(start[vertex], start[vertex + 1]):
                other = neighbour[at]
                if ring[other] == farthest:
                    ring[other] = distance
                    reached[found] = other
                    found += 1
        front = reached[:found].copy()
    return ring
