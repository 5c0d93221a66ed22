"""What can break beside accuracy: noise in curvature, seams, and the ends of the arguments."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.baking import bake
from lutcore.color import srgb_encode
from lutcore.diffusion import DiffusionProfile
from lutcore.fresnel import mean_transmittance
from lutcore.materials import Material
from lutcore.metrics import ciede2000_lab, lab
from lutcore.shading import ShadingModel
from lutcore.stability_of_shading.bodies import LENGTH, places, sphere_nodes, substance
from lutcore.stability_of_shading.maps import EXCESS

NOISE = 0.1
"""Relative noise of curvature, one sigma."""
SEAM = 1e-6
"""Jump in R_d that is none: the rounding of tables that are read by pieces."""
_TYPICAL, _ETA = (0.05, 0.15, 0.4), 1.3
_BEND, _WHITE = 0.1, 0.85
_DRAWS = 31  # with which the mean of what is clamped at 0 is within 3 %
_COSINES: FloatArray = np.linspace(-1.0, 1.0, 81)
_SCAN, _PARTS, _SMALLEST = 800, 16, 1e-12
# Curvature where all of it is beyond every table, and where nothing can be told from flat, 1/l_u.
_BEYOND, _NEARLY_FLAT = (10.0, 1e3, 1e6), (1e-3, 1e-6, 1e-9, 1e-12)


@dataclass(frozen=True)
class Check:
    """One thing that was tried.

    Parameters
    ----------
    name : str
        Which.
    value : float
        What came of it.
    limit : float
        What it may be at most; infinite where it is only told.
    meaning : str
        What the value is.
    """

    name: str
    value: float
    limit: float
    meaning: str

    @property
    def passed(self) -> bool:
        """Whether the value, if it is a number at all, is within the limit."""
        return bool(np.isfinite(self.value) and self.value <= self.limit)


def checks(model: ShadingModel, profile: DiffusionProfile) -> list[Check]:
    """Try a model.

    Parameters
    ----------
    model : ShadingModel
        A local one.
    profile : DiffusionProfile
        How light spreads.

    Returns
    -------
    list of Check
        The same ones for every model.
    """
    trial = _Trial(model, substance(_TYPICAL, _ETA), profile)
    return [
        *_noise(trial),
        _seam(trial),
        _without_absorption(model, profile),
        _flat(trial),
        _beyond(trial),
    ]


@dataclass(frozen=True, eq=False)
class _Trial:
    """A model, and per R_d what it gives."""

    model: ShadingModel
    material: Material
    profile: DiffusionProfile

    def given(self, cosines: FloatArray, k1: FloatArray, k2: FloatArray) -> FloatArray:
        total = bake(self.material, profile=self.profile).total
        inputs = places(cosines, k1 / LENGTH, k2 / LENGTH, self.material, self.profile)
        return np.asarray(self.model.shade(inputs) / total)


def _noise(trial: _Trial) -> list[Check]:
    """Look at values of k that stand for a normal distribution (Gauss and Hermite)."""
    z, weights = np.polynomial.hermite_e.hermegauss(_DRAWS)
    weights = weights / weights.sum()
    c, n = (grid.ravel() for grid in np.meshgrid(_COSINES, z, indexing="ij"))
    k = _BEND * (1.0 + NOISE * n)
    found = trial.given(c, k, k).reshape(len(_COSINES), len(z), 3)
    mean = np.einsum("czr,z->cr", found, weights)
    spread = np.sqrt(np.einsum("czr,z->cr", (found - mean[:, None]) ** 2, weights))
    still = trial.given(_COSINES, np.full(81, _BEND), np.full(81, _BEND))
    shown = lab(srgb_encode(_WHITE * found.reshape(-1, 3)))
    apart = ciede2000_lab(shown, np.repeat(lab(srgb_encode(_WHITE * still)), len(z), axis=0))
    seen = np.sqrt((apart.reshape(len(_COSINES), -1) ** 2) @ weights)
    # Noise about 0, half of which is clamped: what is added on flat parts, over sigma.
    sigma = 0.01
    flat = trial.given(c, sigma * n, sigma * n).reshape(found.shape)
    none = trial.given(_COSINES, np.zeros(81), np.zeros(81))
    bias = np.abs(np.einsum("czr,z->cr", flat, weights) - none) / sigma
    return [
        Check(
            "noise",
            float(spread.max()),
            np.inf,
            f"most that {100 * NOISE:g} % noise in k moves the exitance, R_d, at k l_u = {_BEND:g}",
        ),
        Check(
            "noise in colour",
            float(seen.max()),
            np.inf,
            "the same as CIEDE2000, where a surface that faces the light is near white",
        ),
        Check(
            "bias",
            float(bias.max()),
            np.inf,
            "most that noise about k = 0 adds for ever, R_d for a sigma of 1/l_u: the clamp's",
        ),
    ]


def _seam(trial: _Trial) -> Check:
    """Look for jumps along every argument, and how much of the largest stays at any distance."""
    jumps = []
    for c in (-0.3, 0.0, 0.4, 1.0):
        # From bowls through flat to beyond every table; sinh has both signs and all sizes.
        bent = (c, c), (-4.0, 8.0), (-4.0, 8.0)
        uneven = (c, c), (0.2, 0.2), (-0.2, 0.4)
        jumps += [_jump(trial, np.sinh, *bent), _jump(trial, _as_it_is, *uneven)]
    for k in (0.0, 0.02, 0.3, 3.0):
        for other in (k, 0.0):
            jumps.append(_jump(trial, _as_it_is, (-1.0, 1.0), (k, k), (other, other)))
    return Check(
        "seams", max(jumps), SEAM, "largest jump along N.w, k and k2, through every clamp, R_d"
    )


def _as_it_is(t: FloatArray) -> FloatArray:
    return t


def _jump(
    trial: _Trial,
    curvature: Callable[[FloatArray], FloatArray],
    *ends: tuple[float, float],
) -> float:
    """Return the jump along a line of N.w, and of what k1 and k2 are a function of."""
    t = np.linspace(0.0, 1.0, _SCAN)
    while True:
        c, first, second = (low + (high - low) * t for low, high in ends)
        found = trial.given(c, curvature(first), curvature(second))
        steps = np.abs(np.diff(found, axis=0)).max(axis=1)
        at = int(np.argmax(steps))
        if t[at + 1] - t[at] < _SMALLEST or not np.isfinite(steps[at]):
            return float(steps[at])
        t = np.linspace(t[at], t[at + 1], _PARTS)


def _without_absorption(model: ShadingModel, profile: DiffusionProfile) -> Check:
    """Let alpha' go to 1, on balls of several radii."""
    cosines, shares = sphere_nodes(20)
    most = 0.0
    for betas in ((0.1, 0.03, 0.01), (3e-3, 1e-4, 0.0)):
        material = substance(betas, _ETA)
        for k in (0.003, 0.03, 0.3):
            found = model.shade(places(cosines, k / LENGTH, k / LENGTH, material, profile))
            energy = shares @ found / (0.25 * mean_transmittance(_ETA))
            most = max(most, float(energy.max())) if np.isfinite(energy).all() else np.inf
    return Check(
        "alpha' to 1",
        most,
        1.0 + EXCESS,
        "most light that leaves a ball over what entered, beta from .1 to 0 and k l_u .003 to .3",
    )


def _flat(trial: _Trial) -> Check:
    """Let b go to 0: the change may be no more than the glow, psi(0) k."""
    glow = bake(trial.material, profile=trial.profile).psi[:, 0]
    none = trial.given(_COSINES, np.zeros(81), np.zeros(81))
    most = 0.0
    for k in _NEARLY_FLAT:
        off = np.abs(trial.given(_COSINES, np.full(81, k), np.full(81, k)) - none)
        # A rounding error is not a change.
        most = max(most, float(np.max((off - 1e-14) / (k * glow))))
    return Check(
        "b to 0",
        max(most, 0.0),
        2.0,
        "most change from flat to k l_u = 1e-3 ... 1e-12, over the glow psi(0) k l_u",
    )


def _beyond(trial: _Trial) -> Check:
    """Leave every table: what is given must stay between nothing and what fell on it."""
    total = bake(trial.material, profile=trial.profile).total
    low, high = 0.0, 0.0
    for k in _BEYOND:
        found = trial.given(_COSINES, np.full(81, k), np.full(81, k)) * total
        if not np.isfinite(found).all():
            return Check("extrapolation", np.inf, 1.0, "not finite beyond the tables")
        low, high = min(low, float(found.min())), max(high, float(found.max()))
    value = high if low > -1e-9 else np.inf
    return Check(
        "extrapolation", value, 1.0, "most exitance over irradiance at k l_u of 10, 1e3 and 1e6"
    )
