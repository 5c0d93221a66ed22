"""Error, energy and monotonicity of shading models over curvature, absorption and light's angle."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lutcore.arrays import BoolArray, FloatArray
from lutcore.baking import glowing
from lutcore.diffusion import DiffusionProfile, optics
from lutcore.fresnel import mean_transmittance
from lutcore.progress import Progress, silent, tell
from lutcore.revolution import on_sphere
from lutcore.shading import ShadingModel
from lutcore.stability_of_shading.bodies import LENGTH, places, sphere_nodes, substance

CURVATURES: FloatArray = np.geomspace(0.003, 3.0, 25)
"""k l_u of the balls."""
BETAS: FloatArray = np.geomspace(0.01, 1.5, 12)
"""l_u/l_d of their substances."""
_NODES = 20
FALL = 0.005
"""Darkening while light rises, in R_d, that is none: less than a step of 255 where all is white."""
BENT = 0.02
"""E2 above which curvature is to blame, below which the model is wrong in the flat limit."""
EXCESS = 1e-3
"""Light that a model may give out beyond what went in: the error of its tables."""


@dataclass(frozen=True, eq=False)
class Ground:
    """Balls of many curvatures and substances, and what leaves them in truth.

    Parameters
    ----------
    eta : float
        Refractive index of all.
    cosines : ndarray, shape=(c,)
        N.w, ascending.
    shares : ndarray, shape=(c,)
        Of the ball's area.
    truth : ndarray, shape=(betas, curvatures, c)
        The profile integrated over the true sphere with F_t inside, per R_d and unit irradiance.
    total : ndarray, shape=(betas,)
        R_d.
    mean_square : ndarray, shape=(betas,)
        <r^2>, l_u^2.
    """

    eta: float
    cosines: FloatArray
    shares: FloatArray
    truth: FloatArray
    total: FloatArray
    mean_square: FloatArray

    @property
    def second(self) -> FloatArray:
        """E2 = <r^2> k^2/2 of a ball, shape (betas, curvatures)."""
        return 0.5 * self.mean_square[:, None] * CURVATURES**2


@dataclass(frozen=True, eq=False)
class Field:
    """What a model does on that ground.

    Parameters
    ----------
    missed : ndarray, shape=(betas, curvatures, c)
        Its exitance less the truth, per R_d.
    error : ndarray, shape=(betas, curvatures)
        Relative L2 error over the ball.
    energy : ndarray, shape=(betas, curvatures)
        Light that leaves the ball over light that entered it.
    fall : ndarray, shape=(betas, curvatures)
        The most by which a place darkens while the light rises, in R_d.
    least : ndarray, shape=(betas, curvatures)
        Least exitance, in R_d.
    """

    missed: FloatArray
    error: FloatArray
    energy: FloatArray
    fall: FloatArray
    least: FloatArray


def ground(eta: float, profile: DiffusionProfile, progress: Progress = silent) -> Ground:
    """Integrate a profile over the balls.

    Parameters
    ----------
    eta : float
        Refractive index.
    profile : DiffusionProfile
        How light spreads.
    progress : callable
        Told where the work stands; see `lutcore.progress`.

    Returns
    -------
    Ground
        The truth.

    Raises
    ------
    CancelledError
        If `progress` asked to stop.
    """
    cosines, shares = sphere_nodes(_NODES)
    truth = np.empty((len(BETAS), len(CURVATURES), len(cosines)))
    total, mean_square = np.empty(len(BETAS)), np.empty(len(BETAS))
    for row, beta in enumerate(BETAS):
        tell(progress, row / len(BETAS), "integrating over balls")
        constants = optics(substance([beta] * 3, eta))[0]
        total[row] = profile.total(constants)
        mean_square[row] = profile.mean_square(constants)
        for column, k in enumerate(CURVATURES):
            truth[row, column] = on_sphere(cosines, float(k), profile, glowing(constants))
    return Ground(eta, cosines, shares, truth, total, mean_square)


def field(
    model: ShadingModel, of: Ground, profile: DiffusionProfile, progress: Progress = silent
) -> Field:
    """Run a model on all balls.

    Parameters
    ----------
    model : ShadingModel
        A local one.
    of : Ground
        The balls.
    profile : DiffusionProfile
        The same that the ground was made with.
    progress : callable
        Told where the work stands; see `lutcore.progress`.

    Returns
    -------
    Field
        What it does.

    Raises
    ------
    CancelledError
        If `progress` asked to stop.
    """
    given = np.empty(of.truth.shape)
    curvatures, cosines = np.meshgrid(CURVATURES / LENGTH, of.cosines, indexing="ij")
    for first in range(0, len(BETAS), 3):
        tell(progress, first / len(BETAS), "substances")
        material = substance(BETAS[first : first + 3], of.eta)
        k = curvatures.ravel()
        shaded = model.shade(places(cosines.ravel(), k, k, material, profile))
        found = shaded.T.reshape(3, *curvatures.shape)
        given[first : first + 3] = found / of.total[first : first + 3, None, None]
    missed = given - of.truth
    entered = 0.25 * mean_transmittance(of.eta)  # mean of c F_t(c) over the ball
    highest = np.maximum.accumulate(given, axis=2)
    return Field(
        missed=missed,
        error=np.sqrt((missed**2 @ of.shares) / (of.truth**2 @ of.shares)),
        energy=of.total[:, None] * (given @ of.shares) / entered,
        fall=np.max(highest - given, axis=2),
        least=given.min(axis=2),
    )


@dataclass(frozen=True, eq=False)
class Region:
    """Where a model fails in one way.

    Parameters
    ----------
    name : str
        Which way, in a few words.
    mask : ndarray of bool, shape=(betas, curvatures)
        Where.
    worst : float
        By how much where it is worst: an error, an energy, a fall or a negative exitance.
    """

    name: str
    mask: BoolArray
    worst: float


OFF_FLAT = "wrong where nearly flat"
OFF_BENT = "curved within the range of light"
TOO_BRIGHT = "more light out than in"
FALLING = "darker as light rises"
NEGATIVE = "negative light"
REASONS = {
    OFF_FLAT: "relative error above the tolerance although E2 is below .02: the model is not "
    "Lambert with F_t in the limit",
    OFF_BENT: "relative error above the tolerance, E2 above .02: the surface bends within the "
    "distance that light goes",
    TOO_BRIGHT: "the ball gives out more than entered it",
    FALLING: "a place darkens by more than .005 R_d while the light rises towards its zenith",
    NEGATIVE: "less than nothing leaves some place",
}
"""What each name means."""


def regions(of: Ground, found: Field, tolerance: float) -> list[Region]:
    """Return where a model fails, and how.

    Parameters
    ----------
    of : Ground
        The balls.
    found : Field
        What the model does on them.
    tolerance : float
        Relative L2 error that is accepted.

    Returns
    -------
    list of Region
        Those that are not empty.
    """
    off, bent = found.error > tolerance, of.second > BENT
    candidates: Sequence[tuple[str, BoolArray, FloatArray]] = (
        (OFF_FLAT, off & ~bent, found.error),
        (OFF_BENT, off & bent, found.error),
        (TOO_BRIGHT, found.energy > 1.0 + EXCESS, found.energy),
        (FALLING, found.fall > FALL, found.fall),
        (NEGATIVE, found.least < -1e-9, -found.least),
    )
    return [
        Region(name, mask, float(values[mask].max()))
        for name, mask, values in candidates
        if mask.any()
    ]
