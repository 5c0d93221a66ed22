"""The cheapest model that suffices for a scene: predicted errors, costs, and one sentence."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.blend import Blend, at
from lutcore.costs import PREDICTION, Candidate, Cost, candidates
from lutcore.errors import ParameterError
from lutcore.prediction import Scene
from lutcore.shading import ShadingInputs, ShadingModel, model_registry
from lutcore.tolerance import Tolerance, color_differences, relative

_SAMPLE = 2048
_COLORS = 1024
_COLORED_BY = "curvature-lut"
# A blend must save this share of the cost to be worth two models.
_WORTH = 0.1
# Sizes of the body that are tried where no local model suffices.
_LARGER = 2.0 ** (0.5 * np.arange(1, 15))


@dataclass(frozen=True)
class Rung:
    """One model on the ladder.

    Parameters
    ----------
    candidate : Candidate
        The model.
    median, p99 : float
        Predicted error over the vertices, relative to R_d and the largest irradiance; nan where a
        model predicts none.
    score : float
        What the tolerance is compared with, in its metric; nan where nothing is predicted.
    share : float
        Share of the vertices where the model's error is within the tolerance.
    nanoseconds : float
        For each vertex and light.
    milliseconds : float
        For this mesh and its lights.
    adequate : bool
        Whether the score is within the tolerance.
    """

    candidate: Candidate
    median: float
    p99: float
    score: float
    share: float
    nanoseconds: float
    milliseconds: float
    adequate: bool


@dataclass(frozen=True)
class Choice:
    """What a scene is to be shaded with, and why.

    Parameters
    ----------
    rungs : tuple of Rung
        The ladder, cheapest first.
    chosen : Rung
        The cheapest adequate one; the most accurate where none is.
    blend : Blend or None
        A cheaper model mixed in where it suffices, if that pays.
    cheaper : Rung or None
        That model.
    milliseconds : float
        Of what is chosen, blend included.
    tolerance : Tolerance
        What was asked for.
    sentence : str
        The reason; empty where the ladder was not climbed to its end.
    enough : float or None
        Where no local model suffices, how many times as large the body must be for one.
    """

    rungs: tuple[Rung, ...]
    chosen: Rung
    blend: Blend | None
    cheaper: Rung | None
    milliseconds: float
    tolerance: Tolerance
    sentence: str
    enough: float | None

    @property
    def model(self) -> ShadingModel:
        """The model to shade with."""
        return self.blend or self.chosen.candidate.model


def choose(
    inputs: ShadingInputs,
    tolerance: Tolerance,
    costs: Mapping[str, Cost],
    models: Sequence[Candidate] | None = None,
    seed: int = 0,
    whole: bool = True,
) -> Choice:
    """Choose the cheapest model whose predicted error is within a tolerance.

    Errors are predicted on at most 2048 vertices, so that a choice costs the same on any mesh.
    Models that predict no error are listed and never chosen. Without lights the error is that
    under the worst one.

    Parameters
    ----------
    inputs : ShadingInputs
        The scene, with its curvatures.
    tolerance : Tolerance
        How wrong it may be.
    costs : mapping of str to Cost
        By label; see `lutcore.costs.costs`.
    models : sequence of Candidate, optional
        The models; all that can be run if not given.
    seed : int
        Seed of the choice of vertices.
    whole : bool
        Whether to climb the ladder to its end; if not, only as far as the choice, which is the
        same, and `enough` is not sought.

    Returns
    -------
    Choice
        The ladder and the choice.

    Raises
    ------
    ParameterError
        If the scene has no curvatures, or no model predicts its error.
    """
    if inputs.curvatures is None:
        raise ParameterError("choosing a model needs the curvatures, to predict errors from")
    if tolerance.metric != "relative" and not len(inputs.lights):
        raise ParameterError(f"{tolerance.metric} needs a light: without one there is no colour")
    judge = _Judge(inputs, tolerance, costs, seed)
    every = candidates() if models is None else models
    rungs: list[Rung] = []
    for one in sorted(every, key=judge.milliseconds):
        rungs.append(judge.rung(one))
        if rungs[-1].adequate and not whole:
            break
    known = [rung for rung in rungs if not np.isnan(rung.score)]
    if not known:
        raise ParameterError("no model predicts its error, so that none can be chosen")
    adequate = [rung for rung in known if rung.adequate]
    chosen = adequate[0] if adequate else min(known, key=lambda rung: rung.score)
    blend, cheaper, spent = judge.blended(chosen, known)
    enough = None
    if whole and not any(rung.candidate.model.local for rung in adequate):
        enough = judge.enough([rung.candidate for rung in known])
    choice = Choice(tuple(rungs), chosen, blend, cheaper, spent, tolerance, "", enough)
    return replace(choice, sentence=_sentence(choice, known)) if whole else choice


class _Judge:
    def __init__(
        self, inputs: ShadingInputs, tolerance: Tolerance, costs: Mapping[str, Cost], seed: int
    ) -> None:
        assert inputs.curvatures is not None
        self.tolerance, self.costs = tolerance, costs
        count = len(inputs.points)
        self.count, self.lights = count, len(inputs.lights)
        seen = np.flatnonzero(np.einsum("ij,ij->i", inputs.normals, inputs.normals) > 0.0)
        if len(seen) > _SAMPLE:
            seen = np.random.default_rng(seed).choice(seen, _SAMPLE, replace=False)
            seen.sort()
        self.scene = Scene.of(inputs, inputs.curvatures).at(seen)
        self.irradiance = self.scene.irradiance
        self.some = at(inputs, seen)
        self.base: FloatArray | None = None

    def milliseconds(self, one: Candidate) -> float:
        each = self.costs[one.label].per_vertex(self.count, max(self.lights, 1))
        return 1e-6 * each * self.count

    def rung(self, one: Candidate) -> Rung:
        spent, lights = self.milliseconds(one), max(self.lights, 1)
        each = self.costs[one.label].per_vertex(self.count, lights) / lights
        errors = one.model.predicted_error(self.scene)
        if errors is None:
            nothing = float("nan")
            return Rung(one, nothing, nothing, nothing, 0.0, each, spent, False)
        of_vertices = relative(errors, self.irradiance)
        judged = self.judged(errors)
        score = self.tolerance.score(judged)
        return Rung(
            candidate=one,
            median=float(np.median(of_vertices)) if len(of_vertices) else 0.0,
            p99=Tolerance(0.0).score(of_vertices),
            score=score,
            share=float(np.mean(judged <= self.tolerance.value)) if len(judged) else 1.0,
            nanoseconds=each,
            milliseconds=spent,
            adequate=score <= self.tolerance.value,
        )

    def judged(self, errors: FloatArray) -> FloatArray:
        """Return errors of vertices in the metric's unit."""
        if self.tolerance.metric == "relative":
            return relative(errors, self.irradiance)
        some = slice(None, None, -(-len(errors) // _COLORS) or 1)
        total = self.scene.table.total
        return color_differences(self._exitance()[some], errors[some] * total)

    def _exitance(self) -> FloatArray:
        """Return what an accurate local model gives at the sample, for its colours."""
        if self.base is None:
            self.base = model_registry.get(_COLORED_BY)().shade(self.some)
        return self.base

    def blended(self, chosen: Rung, known: list[Rung]) -> tuple[Blend | None, Rung | None, float]:
        """Return the blend that saves most, with what it costs in milliseconds."""
        best: tuple[Blend | None, Rung | None, float] = None, None, chosen.milliseconds
        if not (chosen.candidate.model.local and chosen.adequate):
            return best
        if self.tolerance.metric != "relative" or not self.lights:
            return best
        for rung in known:
            model = rung.candidate.model
            if not model.local or rung.milliseconds >= chosen.milliseconds:
                continue
            blend = Blend(model, chosen.candidate.model, self.tolerance.value)
            weights = blend.weights(self.scene)
            predicting = (
                1e-6 * self.count * self.costs[PREDICTION].per_vertex(self.count, self.lights)
            )
            spent = predicting + float(
                np.mean(weights < 1.0) * rung.milliseconds
                + np.mean(weights > 0.0) * chosen.milliseconds
            )
            if spent < min(best[2], (1.0 - _WORTH) * chosen.milliseconds):
                best = blend, rung, spent
        return best

    def enough(self, known: list[Candidate]) -> float | None:
        """Return how many times as large the body must be for a local model."""
        local = [one.model for one in known if one.model.local]
        return next((float(f) for f in _LARGER if any(self._fits(m, f) for m in local)), None)

    def _fits(self, model: ShadingModel, factor: float) -> bool:
        of = self.scene
        larger = replace(
            of,
            curvatures=of.curvatures / factor,
            error=of.error / factor,
            slope=of.slope / factor**2,
            facet=of.facet * factor**2,
            radius=of.radius * factor,
        )
        errors = model.predicted_error(larger)
        return errors is not None and self.tolerance.score(self.judged(errors)) <= (
            self.tolerance.value
        )


def _sentence(choice: Choice, known: list[Rung]) -> str:
    chosen, tolerance = choice.chosen, choice.tolerance
    label, value = chosen.candidate.label, f"{tolerance.value:g}"
    measure = _MEASURES[tolerance.metric].format(value=value)
    local = [rung for rung in known if rung.candidate.model.local]
    if choice.blend is not None and choice.cheaper is not None:
        saved = choice.milliseconds / chosen.milliseconds
        return (
            f"{choice.cheaper.candidate.label} suffices on {_percent(choice.cheaper.share)} of the "
            f"vertices ({measure}), {label} is blended in on the rest, for {saved:.2g} times the "
            f"cost of {label} alone"
        )
    if chosen.adequate and (chosen.candidate.model.local or any(one.adequate for one in local)):
        cheaper = [rung for rung in local if rung.milliseconds < chosen.milliseconds]
        reason = f"{label} is the cheapest that suffices ({measure}: {chosen.score:.2g} predicted)"
        if not cheaper:
            return reason + "; nothing is cheaper"
        best = max(cheaper, key=lambda rung: rung.share)
        part = f"{best.candidate.label} suffices on {_percent(best.share)} of the vertices"
        return f"{reason}; {part}, and no cheaper one on more"
    larger = (
        f"a body {choice.enough:.2g} times as large would do with a local one"
        if choice.enough
        else "no larger body would do with a local one"
    )
    if not local:
        return f"{label} is all there is to choose"
    best = max(local, key=lambda rung: rung.share)
    no_local = (
        f"no local model suffices ({measure}): the widest, {best.candidate.label}, does on "
        f"{_percent(best.share)} of the vertices"
    )
    if chosen.adequate:
        return f"{no_local}; {label} suffices, gathering the light of the whole mesh; {larger}"
    return f"nothing suffices, {label} comes closest ({chosen.score:.2g}); {no_local}; {larger}"


_MEASURES = {
    "relative": "99 % of vertices within {value} R_d",
    "mean-de2000": "mean CIEDE2000 within {value}",
    "p99-de2000": "99 % of vertices within a CIEDE2000 of {value}",
}


def _percent(share: float) -> str:
    # No share is rounded to all or nothing.
    percent = 100.0 * share
    digits = 0 if 0.95 <= percent <= 99.0 or percent in (0.0, 100.0) else 1
    return f"{percent:.{digits}f} %"
