"""Errors of shading models on a ball, over its radius in diffusion lengths."""

from collections.abc import Sequence

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.baking import glowing
from lutcore.diffusion import DiffusionProfile, optics
from lutcore.materials import Material
from lutcore.progress import Progress, silent, tell
from lutcore.revolution import on_sphere
from lutcore.shading import ShadingModel
from lutcore.stability_of_shading.bodies import places, sphere_nodes
from lutcore.walk.bodies import Body
from lutcore.walk.exitance import cells, walk

RATIOS: tuple[float, ...] = (1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 50.0)
"""Radii of the ball, l_d."""
WALKED: tuple[float, ...] = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0)
"""Those at which photons are followed."""
_NODES, _ROWS = 32, 20


def against_profile(
    models: Sequence[ShadingModel],
    material: Material,
    profile: DiffusionProfile,
    channel: int,
    ratios: Sequence[float] = RATIOS,
) -> FloatArray:
    """Return errors against the profile integrated over the true sphere with F_t inside.

    Parameters
    ----------
    models : sequence of ShadingModel
        Local ones.
    material : Material
        The substance.
    profile : DiffusionProfile
        How light spreads in it.
    channel : int
        0 to 2.
    ratios : sequence of float
        Radii in l_d; of a channel that absorbs next to nothing, that of `lutcore.baking.glowing`.

    Returns
    -------
    ndarray, shape=(len(models), len(ratios))
        Relative L2 error over the whole surface, dark side included.
    """
    constants = glowing(optics(material)[channel])
    length = float(material.mean_free_path[channel])
    cosines, shares = sphere_nodes(_NODES)
    errors = np.empty((len(models), len(ratios)))
    for at, ratio in enumerate(ratios):
        radius = ratio / constants.beta
        total = profile.total(constants)
        truth = total * on_sphere(cosines, 1.0 / radius, profile, constants)
        k = 1.0 / (radius * length)
        inputs = places(cosines, k, k, material, profile)
        for row, model in enumerate(models):
            missed = model.shade(inputs)[:, channel] - truth
            errors[row, at] = np.sqrt(shares @ missed**2 / (shares @ truth**2))
    return errors


def against_walk(
    models: Sequence[ShadingModel],
    material: Material,
    profile: DiffusionProfile,
    channel: int,
    photons: int,
    ratios: Sequence[float] = WALKED,
    seed: int = 0,
    progress: Progress = silent,
) -> tuple[FloatArray, FloatArray]:
    """Return errors against a random walk through the ball.

    Parameters
    ----------
    models, material, profile, channel, ratios
        As for `against_profile`.
    photons : int
        How many for each radius.
    seed : int
        Of the walk.
    progress : callable
        Told where the work stands; see `lutcore.progress`.

    Returns
    -------
    errors : ndarray, shape=(len(models), len(ratios))
        Relative L2 error over the whole surface, of means over twenty rings of equal area. The
        walk's own scatter, whose expected square is known, is taken out.
    own : ndarray, shape=(len(ratios),)
        The walk's relative L2 standard error: errors much below it are not resolved.

    Raises
    ------
    CancelledError
        If `progress` asked to stop.
    """
    constants = glowing(optics(material)[channel])
    length = float(material.mean_free_path[channel])
    errors, own = np.empty((len(models), len(ratios))), np.empty(len(ratios))
    up = (0.0, 0.0, 1.0)
    for at, ratio in enumerate(ratios):
        tell(progress, at / len(ratios), f"following photons through a ball of {ratio:g} l_d")
        radius = ratio / constants.beta
        body = Body((radius, radius, radius))
        found = walk(body, up, constants, photons, _ROWS, seed=seed)
        nodes, areas = cells(body, up, _ROWS, 1)
        cosines = np.clip(nodes[..., 2].ravel() / radius, -1.0, 1.0)
        truth, scatter = found.exitance.ravel(), found.error.ravel()
        k = 1.0 / (radius * length)
        inputs = places(cosines, k, k, material, profile)
        whole = truth @ truth
        own[at] = np.sqrt(scatter @ scatter / whole)
        for row, model in enumerate(models):
            value = model.shade(inputs)[:, channel].reshape(areas.shape)
            missed = (value * areas).sum(axis=1) / areas.sum(axis=1) - truth
            square = (missed @ missed - scatter @ scatter) / whole
            errors[row, at] = np.sqrt(max(square, 0.0))
    return errors, own
