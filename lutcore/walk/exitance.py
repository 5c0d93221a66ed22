"""Radiant exitance of a body in directional light, with its standard error."""

from dataclasses import dataclass

import numpy as np
from numba import prange
from numpy.typing import ArrayLike

from lutcore.arrays import FloatArray, unit_vector
from lutcore.baking import whole
from lutcore.compiled import compiled
from lutcore.diffusion import Optics
from lutcore.errors import ParameterError
from lutcore.progress import Progress, silent, tell
from lutcore.walk.bodies import FLAT, FULL, ROUND, Body
from lutcore.walk.photons import ABSORBED, REFLECTED, follow

BATCHES = 64
"""Groups of photons whose scatter gives the standard errors."""

_REPORTS = 16  # of progress, and chances to cancel, at most,
_BETWEEN = 20_000  # and photons between them, at least: starting threads costs milliseconds
_NODES = 8


@dataclass(frozen=True, eq=False)
class Walked:
    """What a run found.

    Parameters
    ----------
    exitance : ndarray, shape=(rows, columns)
        Radiant exitance, all that leaves in any direction, per unit irradiance of a surface that
        faces the light: means over the cells. It compares with what `lutcore.exitance.shade`
        returns: R_d counts what leaves, and the exit Fresnel factor only shares it out among
        directions.
    error : ndarray, shape=(rows, columns)
        Standard errors.
    shares : tuple of 3 floats
        Of the light that falls on the body: left, absorbed, reflected without entering.
    share_errors : tuple of 3 floats
        Standard errors of the shares.
    balance : tuple of 2 floats
        Sum of the shares, and its own standard error.
    """

    exitance: FloatArray
    error: FloatArray
    shares: tuple[float, float, float]
    share_errors: tuple[float, float, float]
    balance: tuple[float, float]


def walk(
    body: Body,
    light: ArrayLike,
    optics: Optics,
    photons: int,
    rows: int = 1,
    columns: int = 1,
    seed: int = 0,
    progress: Progress = silent,
) -> Walked:
    """Follow photons from a directional light through a body.

    Parameters
    ----------
    body : Body
        Lengths in l_u.
    light : array_like, shape=(3,)
        Points TO the light; any length.
    optics : Optics
        Reduced albedo and refractive index; scattering is isotropic.
    photons : int
        How many, at least `BATCHES`; rounded down to a multiple of it.
    rows, columns : int
        Cells of the surface, see `lutcore.walk.photons.place`; of the half-space there is one.
    seed : int
        The same seed gives the same bits, with any number of threads.
    progress : callable
        Called between parts of the work.

    Returns
    -------
    Walked
        Exitance by place and the balance of energy.

    Raises
    ------
    ParameterError
        If a number is out of range, or the light does not reach the body.
    CancelledError
        If `progress` asks to stop.
    """
    each = whole("photons", photons, BATCHES, 10**12) // BATCHES
    start = whole("seed", seed, 0, 2**62)
    whole("rows", rows, 1, 10_000)
    whole("columns", columns, 1, 10_000)
    if body.kind == FLAT and (rows, columns) != (1, 1):
        raise ParameterError("a half-space is the same everywhere: rows and columns must be 1")
    if body.kind == ROUND and columns > 2:
        raise ParameterError(f"columns = {columns} of a cylinder must be 1, or 2 for its sides")
    w = unit_vector("light", light)
    tallies = np.zeros((BATCHES, rows * columns + 2))
    arguments = (w, body.inverse, body.frame(w), body.kind, optics.albedo, optics.eta)
    step = -(-BATCHES // min(max(photons // _BETWEEN, 1), _REPORTS))
    for first in range(0, BATCHES, step):
        tell(progress, first / BATCHES, "Following photons")
        count = min(step, BATCHES - first)
        _batches(first, count, each, start, *arguments, rows, columns, tallies)
    tell(progress, 1.0, "Following photons")
    tallies /= each
    return _evaluated(tallies, body, w, rows, columns)


@compiled(parallel=True)
def _batches(
    first: int,
    count: int,
    each: int,
    seed: int,
    light: FloatArray,
    inverse: FloatArray,
    frame: FloatArray,
    kind: int,
    albedo: float,
    eta: float,
    rows: int,
    columns: int,
    tallies: FloatArray,
) -> None:
    for k in prange(count):
        batch = first + k
        # Its own memory: neighbouring rows would share lines of the cache.
        tally = np.zeros(tallies.shape[1])
        for i in range(each):
            follow(
                seed,
                batch * each + i,
                float(i),
                float(each),
                light,
                inverse,
                frame,
                kind,
                albedo,
                eta,
                rows,
                columns,
                tally,
            )
        tallies[batch] = tally


def _evaluated(
    tallies: FloatArray, body: Body, light: FloatArray, rows: int, columns: int
) -> Walked:
    mean, error = _mean(tallies)
    area = cells(body, light, rows, columns)[1].sum(axis=1)
    scale = (body.shadow(light) / area).reshape(rows, columns)
    left = tallies[:, :REFLECTED].sum(axis=1)
    shares = np.stack([left, tallies[:, ABSORBED], tallies[:, REFLECTED]], axis=1)
    share, share_error = _mean(shares)
    balance, off = _mean(shares.sum(axis=1))
    return Walked(
        mean[:REFLECTED].reshape(rows, columns) * scale,
        error[:REFLECTED].reshape(rows, columns) * scale,
        (float(share[0]), float(share[1]), float(share[2])),
        (float(share_error[0]), float(share_error[1]), float(share_error[2])),
        (float(balance), float(off)),
    )


def _mean(batches: FloatArray) -> tuple[FloatArray, FloatArray]:
    return batches.mean(axis=0), batches.std(axis=0, ddof=1) / np.sqrt(len(batches))


def cells(body: Body, light: ArrayLike, rows: int, columns: int) -> tuple[FloatArray, FloatArray]:
    """Return nodes of a quadrature over every cell, so that a model can be averaged over it.

    Parameters
    ----------
    body : Body
        Lengths in l_u.
    light : array_like, shape=(3,)
        Points TO the light; any length.
    rows, columns : int
        Cells, as in `walk`.

    Returns
    -------
    tuple of ndarray, shape=(rows * columns, nodes, 3) and (rows * columns, nodes)
        Places on the surface in l_u, and the surface that each stands for.
    """
    frame = body.frame(light)
    if body.kind == FLAT:
        return np.zeros((1, 1, 3)), np.ones((1, 1))
    x, weights = np.polynomial.legendre.leggauss(_NODES)
    x, weights = 0.5 * (x + 1.0), 0.5 * weights
    height = (np.arange(rows)[:, None] + x) / rows
    if body.kind == FULL:
        along = (2.0 * height - 1.0)[:, None, :, None]
        turn = 2.0 * np.pi * ((np.arange(columns)[:, None] + x) / columns)[None, :, None, :]
        out = np.sqrt(1.0 - along * along)
        parts = (along + 0.0 * turn, out * np.cos(turn), out * np.sin(turn))
        measure = 4.0 * np.pi / (rows * columns) * weights[:, None] * weights
    else:
        sides = np.ones(1) if columns == 1 else np.array([1.0, -1.0])
        angle = np.pi * (1.0 - height)[:, None, :, None] * sides[None, :, None, None]
        parts = (np.cos(angle), np.sin(angle), 0.0 * angle)
        measure = (2.0 * np.pi / (rows * len(sides)) * weights)[:, None]
    s = sum(part[..., None] * axis for part, axis in zip(parts, frame, strict=True))
    s = np.asarray(s).reshape(rows * columns, -1, 3)
    area = body.area(s.reshape(-1, 3)).reshape(s.shape[:2]) * measure.ravel()
    finite = np.where(np.isfinite(body.axes), body.axes, 0.0)
    return s * finite, area
