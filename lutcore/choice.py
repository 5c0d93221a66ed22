"""The cheapest model that suffices for a scene, and why."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from lutcore.blend import Blend
from lutcore.checking import Checked, Coverage
from lutcore.costs import Candidate, Cost, candidates
from lutcore.errors import ParameterError
from lutcore.exitance import without_shadows
from lutcore.judging import Judge, Rung
from lutcore.mixing import mixed
from lutcore.shading import ShadingInputs, ShadingModel
from lutcore.table_size import samples_needed, with_samples
from lutcore.tolerance import Tolerance


@dataclass(frozen=True)
class Choice:
    """What a scene is to be shaded with, and why.

    Parameters
    ----------
    rungs : tuple of Rung
        The ladder, cheapest first.
    chosen : Rung
        The cheapest adequate one; the most accurate where none is.
    by_prediction : Rung
        What would have been chosen by prediction alone, of the rungs that were climbed.
    blend : Blend or None
        A cheaper model mixed in where it suffices, if that pays.
    cheaper : Rung or None
        That model.
    cheaper_share : float
        Share of the vertices where it is taken, alone or in part.
    milliseconds : float
        Of what is chosen, blend included, each time it shades; the check is paid once.
    samples : int
        Of the table of psi: as many as keep it from mattering.
    tolerance : Tolerance
        What was asked for.
    coverage : Coverage
        Where models were checked, or why none was.
    check_milliseconds : float
        What the check took, once.
    enough : float or None
        Where no local model suffices, how many times as large the body must be for one, by
        prediction; None where none would do, or the prediction is content with one as it is.
    shadowed : bool
        Whether something casts a shadow: it is then on both sides of the check, and in no
        prediction.
    unshadowed : Checked or None
        How wrong what is chosen would be without cast shadows; None where there are none, nothing
        was checked, or it gathers.
    """

    rungs: tuple[Rung, ...]
    chosen: Rung
    by_prediction: Rung
    blend: Blend | None
    cheaper: Rung | None
    cheaper_share: float
    milliseconds: float
    samples: int
    tolerance: Tolerance
    coverage: Coverage
    check_milliseconds: float
    enough: float | None
    shadowed: bool
    unshadowed: Checked | None

    @property
    def model(self) -> ShadingModel:
        """The model to shade with, its table included."""
        return self.blend or with_samples(self.chosen.candidate.model, self.samples)

    @property
    def sentence(self) -> str:
        """The reason in a sentence, of a ladder that was climbed to its end."""
        from lutcore.reasons import reason

        return reason(self)

    @property
    def overruled(self) -> bool:
        """Whether the prediction alone would have chosen otherwise."""
        return self.chosen.candidate != self.by_prediction.candidate


def choose(
    inputs: ShadingInputs,
    tolerance: Tolerance,
    costs: Mapping[str, Cost],
    models: Sequence[Candidate] | None = None,
    seed: int = 0,
    whole: bool = True,
    checked: bool = True,
) -> Choice:
    """Choose the cheapest model whose error is within a tolerance.

    Errors are predicted on at most 2048 vertices, a bound that is often far above them, and then
    local models are checked against light that is gathered at some thousand vertices over the
    mesh's own triangles (`lutcore.checking`). One is taken if what was found is within the
    tolerance at a confidence of 99 %; where nothing can be checked, because there is no light or
    nothing of the mesh is far enough from its borders, if what is predicted is. Models that predict
    no error are listed and never chosen. Without lights the error is that under the worst one.
    Where no local model is enough, what gathers is checked in the same way, against the same light:
    what lies between mesh and body counts in its prediction only. Cast shadows are in both, where
    the scene has visibility.

    Parameters
    ----------
    inputs : ShadingInputs
        The scene, with its curvatures, and with visibility where something casts a shadow:
        `softened` for local models, as it is for what gathers.
    tolerance : Tolerance
        How wrong it may be.
    costs : mapping of str to Cost
        By label; see `lutcore.costs.costs`.
    models : sequence of Candidate, optional
        The models; all that can be run if not given.
    seed : int
        Seed of the choice of vertices: the same seed chooses the same on every machine where the
        costs are in the same order.
    whole : bool
        Whether to climb the ladder to its end; if not, only as far as the choice, which is the
        same, and `enough` is not sought.
    checked : bool
        Whether to check; if not, what is predicted decides.

    Returns
    -------
    Choice
        The ladder and the choice.

    Raises
    ------
    ParameterError
        If the scene has no curvatures, or no model predicts its error.
    CancelledError
        If the progress of the inputs asked to stop.
    """
    if inputs.curvatures is None:
        raise ParameterError("choosing a model needs the curvatures, to predict errors from")
    if tolerance.metric != "relative" and not len(inputs.lights):
        raise ParameterError(f"{tolerance.metric} needs a light: without one there is no colour")
    inputs = _cast(inputs)
    samples = samples_needed(inputs, tolerance)
    judge = Judge(inputs, tolerance, costs, samples, seed, checked)
    every = candidates() if models is None else models
    rungs: list[Rung] = []
    for one in sorted(every, key=judge.milliseconds):
        rungs.append(judge.rung(one, not any(rung.adequate for rung in rungs)))
        if rungs[-1].adequate and not whole:
            break
    known = [rung for rung in rungs if not np.isnan(rung.score)]
    if not known:
        raise ParameterError("no model predicts its error, so that none can be chosen")
    adequate = [rung for rung in known if rung.adequate]
    chosen = adequate[0] if adequate else min(known, key=lambda rung: rung.best_score)
    predicted = [rung for rung in known if rung.predicted]
    by_prediction = predicted[0] if predicted else min(known, key=lambda rung: rung.score)
    blended = mixed(judge, chosen, known)
    enough = None
    # Where the prediction is content with a local model, it tells nothing of what would do.
    content = by_prediction.predicted and by_prediction.candidate.model.local
    if whole and not content and not any(rung.candidate.model.local for rung in adequate):
        enough = judge.enough([rung.candidate for rung in known])
    model = blended.blend or with_samples(chosen.candidate.model, samples)
    return Choice(
        rungs=tuple(rungs),
        chosen=chosen,
        by_prediction=by_prediction,
        blend=blended.blend,
        cheaper=blended.cheaper,
        cheaper_share=blended.share,
        milliseconds=blended.milliseconds,
        samples=samples,
        tolerance=tolerance,
        coverage=judge.coverage,
        check_milliseconds=1e3 * judge.seconds,
        enough=enough,
        shadowed=inputs.visibility is not None,
        unshadowed=judge.unshadowed(model) if whole else None,
    )


def _cast(inputs: ShadingInputs) -> ShadingInputs:
    """Return the scene without visibility if every light reaches everything."""
    seen = inputs.visibility
    if seen is not None and seen.min(initial=1.0) == 1.0:
        return without_shadows(inputs)
    return inputs
