"""The truth at a sample of a scene's vertices, which models are checked against.

The share of vertices beyond a tolerance follows a binomial law, whatever the errors look like: with
none beyond it among n, less than 1 % of all are, at the confidence 1 - a, from n = ln a/ln .99 on:
299 for 95 %, 459 for 99 %, and 580 where three looks at growing samples share the risk. A model
with .2 % beyond it takes some 800 vertices to be told from 1 %, one with .5 % 2400, one with .8 %
17 000. So the sample grows while it does not tell, and of a mesh that has no more takes all. One
that is nearer still to the tolerance is not taken.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from lutcore.arrays import AnyArray, FloatArray
from lutcore.blend import at
from lutcore.color import auto_exposure
from lutcore.exitance import bared
from lutcore.gather.exitance import Hierarchy, hierarchy
from lutcore.open_mesh import light_lost
from lutcore.progress import part
from lutcore.shading import ShadingInputs
from lutcore.tolerance import Tolerance, color_distances, relative

STAGES = (1024, 4096, 16384)
"""Vertices of the sample, while the smaller does not tell."""
CONFIDENCE = 0.99
"""That a model which is taken meets the tolerance, all stages together."""

# The gathered light errs by a third of what it is allowed at the 99th percentile, on the sample
# scan: by .7 % of the tolerance.
_REFERENCE = 1.0 / 50.0
_FINEST, _COARSEST = 1e-4, 5e-3
# Of the tolerance, what a border may take of the light where the truth is to be known.
_LOST = 0.25
# So many vertices tell at the least, with none beyond the tolerance, at each stage.
_LEAST = 600
_QUANTILE = 0.99
# Up to 760 bytes each, more where light varies within the triangles.
_MOST = 4_000_000


class Checked(NamedTuple):
    """How wrong a model was found to be.

    Parameters
    ----------
    score : float
        What the tolerance is compared with, over the sample.
    low, high : float
        Bounds on the same over all vertices whose truth is known; equal where all were looked at.
    share : float
        Share of the sample within the tolerance.
    vertices : int
        Of the sample.
    """

    score: float
    low: float
    high: float
    share: float
    vertices: int


@dataclass(frozen=True)
class Coverage:
    """Where the truth of a scene is known.

    Parameters
    ----------
    share : float
        Share of the vertices that lose too little light at borders to matter.
    reason : str
        Why nothing can be checked; empty where it can.
    """

    share: float
    reason: str = ""


class Check:
    """Checks models against light gathered at a few vertices.

    Where the scene has visibility, cast shadows are on both sides: the light that enters is what
    they leave of it, and a local model gets them as pictures give it. So what is found includes the
    error of softening them. Vertices near borders are left out, because the gathered light is no
    truth there; see `lutcore.open_mesh`.

    Parameters
    ----------
    inputs : ShadingInputs
        The scene, with visibility where something casts a shadow.
    tolerance : Tolerance
        How wrong a model may be.
    irradiance : ndarray, shape=(3,)
        Largest on the surface.
    seed : int
        Of the draw.

    Attributes
    ----------
    coverage : Coverage
        Where models are checked; it must have no reason against it before one is.
    seconds : float
        Spent so far.
    """

    def __init__(
        self, inputs: ShadingInputs, tolerance: Tolerance, irradiance: FloatArray, seed: int = 0
    ) -> None:
        self._inputs, self._tolerance, self._irradiance = inputs, tolerance, irradiance
        self.seconds = 0.0
        self.coverage = Coverage(0.0, _refusal(inputs))
        if self.coverage.reason:
            return
        start = time.perf_counter()
        seen = np.any(inputs.normals != 0.0, axis=1)
        held = seen & (light_lost(inputs) <= _LOST * tolerance.light)
        order = np.random.default_rng(seed).permutation(np.flatnonzero(held))
        whole = max(int(np.count_nonzero(seen)), 1)
        self.coverage = Coverage(len(order) / whole)
        if len(order) < min(whole, _LEAST):
            reason = "light from beyond its borders would reach almost all of the mesh"
            self.coverage = Coverage(len(order) / whole, reason)
            return
        stages = sorted({min(stage, len(order)) for stage in STAGES})
        # Sorted within each stage: neighbours walk the same clusters.
        self._parts = [np.sort(one) for one in np.split(order[: stages[-1]], stages[:-1])]
        self._held = len(order)
        self._whole = stages[-1] == len(order)
        self._light: Hierarchy | None = None
        self._truth: list[FloatArray] = []
        self._exposure = 0.0
        self.seconds += time.perf_counter() - start

    def __call__(self, shade: Callable[[AnyArray], FloatArray]) -> Checked:
        """Check a model.

        Parameters
        ----------
        shade : callable
            Gets indices of vertices and returns what the model gives there, shape (m, 3).

        Returns
        -------
        Checked
            The same whatever was checked before.

        Raises
        ------
        CancelledError
            If the progress asked to stop.
        """
        start, errors = time.perf_counter(), np.zeros(0)
        for stage, vertices in enumerate(self._parts):
            errors = np.concatenate([errors, self._errors(shade(vertices), stage)])
            every = self._whole and stage == len(self._parts) - 1
            found = self._judged(errors, every)
            if found.high <= self._tolerance.value or found.low > self._tolerance.value:
                break
        self.seconds += time.perf_counter() - start
        return found

    def inputs_at(self, vertices: AnyArray) -> ShadingInputs:
        """Return what a local model gets at some of the vertices.

        Parameters
        ----------
        vertices : ndarray of int, shape=(m,)
            Indices.

        Returns
        -------
        ShadingInputs
            See `lutcore.blend.at`.
        """
        return at(self._inputs, vertices)

    @property
    def exposure(self) -> float:
        """The exposure that suits the truth at the first stage's vertices."""
        self._truth_of(0)
        return self._exposure

    def _errors(self, given: FloatArray, stage: int) -> FloatArray:
        truth = self._truth_of(stage)
        if self._tolerance.metric != "relative":
            return color_distances(given, truth, self._exposure)
        return relative(np.abs(given - truth) / self._inputs.table.total, self._irradiance)

    def _truth_of(self, stage: int) -> FloatArray:
        """Return what is gathered at the vertices of a stage, once."""
        bare = bared(self._inputs)
        progress = self._inputs.progress
        if self._light is None:
            wanted = min(max(_REFERENCE * self._tolerance.light, _FINEST), _COARSEST)
            self._light = hierarchy(bare, wanted, part(progress, 0.0, 0.5))
        while len(self._truth) <= stage:
            points = bare.points[self._parts[len(self._truth)]]
            self._truth.append(self._light.at(points, part(progress, 0.5, 1.0)))
            if len(self._truth) == 1:
                self._exposure = auto_exposure(self._truth[0])
        return self._truth[stage]

    def _judged(self, errors: FloatArray, every: bool) -> Checked:
        score, value = self._tolerance.score(errors), self._tolerance.value
        share = float(np.mean(errors <= value))
        if every:
            return Checked(score, score, score, share, len(errors))
        risk = (1.0 - CONFIDENCE) / len(STAGES)
        # A draw without replacement tells as much as so many with it.
        count = len(errors)
        worth = count * (self._held - 1) / (self._held - count)
        if self._tolerance.metric == "mean-de2000":
            from scipy.special import ndtri

            margin = float(-ndtri(risk) * errors.std() / np.sqrt(worth))
            return Checked(score, score - margin, score + margin, share, count)
        low, high = (rank / int(worth) for rank in _ranks(int(worth), risk))
        ordered = np.concatenate([[0.0], np.sort(errors), [np.inf]])
        ends = int(low * count), int(np.ceil(high * count - 1e-9))
        return Checked(score, float(ordered[ends[0]]), float(ordered[ends[1]]), share, count)


def _refusal(inputs: ShadingInputs) -> str:
    """Say why a scene cannot be checked; empty where it may."""
    if not len(inputs.lights):
        return "there is no light"
    if len(inputs.points) > _MOST:
        return f"gathering from more than {_MOST:,} vertices takes more memory than it is worth"
    return ""


@lru_cache(maxsize=16)
def _ranks(count: int, risk: float) -> tuple[int, int]:
    """Return ranks, from 1, of the values that bound the 99th percentile of all.

    P(x_(r) >= the percentile) = P(Bin(count, .99) < r), for any continuous law.
    """
    from scipy.special import bdtr

    below = bdtr(np.arange(count), count, _QUANTILE)  # of rank r at index r - 1
    high = int(np.searchsorted(below, 1.0 - risk)) + 1
    low = int(np.searchsorted(below, risk, side="right"))
    return low, high
