"""How wrong each model will be in a scene: predicted, and found at a sample of its vertices."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from lutcore.arrays import AnyArray, FloatArray
from lutcore.blend import at
from lutcore.checking import Check, Checked, Coverage
from lutcore.color import auto_exposure
from lutcore.costs import Candidate, Cost
from lutcore.exitance import bared, exitance, without_shadows
from lutcore.prediction import Scene
from lutcore.shading import ShadingInputs, ShadingModel, model_registry
from lutcore.table_size import with_samples
from lutcore.tolerance import Tolerance, color_differences, relative

NOT_ASKED = "no check was asked for"
"""Why nothing was checked where only the prediction was wanted."""
_SAMPLE = 2048
_COLORS = 1024
_COLORED_BY = "curvature-lut"
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
        What the tolerance is compared with, in its metric, as predicted; nan where nothing is.
    share : float
        Share of the vertices where the model's predicted error is within the tolerance.
    nanoseconds : float
        For each vertex and light.
    milliseconds : float
        For this mesh and its lights.
    predicted : bool
        Whether the predicted score is within the tolerance.
    checked : Checked or None
        What was found at a sample; None for a model that predicts nothing, for the reference, for
        one that is not local where another is known to be enough, and where nothing was checked.
    adequate : bool
        Whether what was found is within the tolerance for sure, or else what is predicted. The
        reference is where others are checked against it.
    """

    candidate: Candidate
    median: float
    p99: float
    score: float
    share: float
    nanoseconds: float
    milliseconds: float
    predicted: bool
    checked: Checked | None
    adequate: bool

    @property
    def best_score(self) -> float:
        """The score that was found, or else the predicted one."""
        return self.score if self.checked is None else self.checked.score

    @property
    def best_share(self) -> float:
        """The share within the tolerance that was found, or else the predicted one."""
        return self.share if self.checked is None else self.checked.share


class Judge:
    """Judges models in one scene.

    Parameters
    ----------
    inputs : ShadingInputs
        The scene, with its curvatures.
    tolerance : Tolerance
        How wrong a model may be.
    costs : mapping of str to Cost
        By label.
    samples : int
        Of the table of psi.
    seed : int
        Of the choice of vertices.
    checked : bool
        Whether to check at a sample.
    """

    def __init__(
        self,
        inputs: ShadingInputs,
        tolerance: Tolerance,
        costs: Mapping[str, Cost],
        samples: int,
        seed: int,
        checked: bool,
    ) -> None:
        assert inputs.curvatures is not None
        self.inputs, self.tolerance, self.costs, self.samples = inputs, tolerance, costs, samples
        self.count, self.lights = len(inputs.points), len(inputs.lights)
        seen = np.flatnonzero(np.any(inputs.normals != 0.0, axis=1))
        if len(seen) > _SAMPLE:
            seen = np.random.default_rng(seed).choice(seen, _SAMPLE, replace=False)
            seen.sort()
        whole = Scene.of(inputs, inputs.curvatures)
        self.scene, self.irradiance = whole.at(seen), whole.irradiance
        self.some = at(inputs, seen)
        self.base: FloatArray | None = None
        self.check: Check | None = None
        self.coverage, self._spent = Coverage(0.0, NOT_ASKED), 0.0
        if checked:
            check = Check(inputs, tolerance, self.irradiance, seed)
            self.coverage, self._spent = check.coverage, check.seconds
            self.check = None if check.coverage.reason else check

    @property
    def seconds(self) -> float:
        """Spent on the check so far."""
        return self._spent if self.check is None else self.check.seconds

    def milliseconds(self, one: Candidate) -> float:
        """Return what a model costs for the scene.

        Parameters
        ----------
        one : Candidate
            The model.

        Returns
        -------
        float
            Milliseconds.
        """
        each = self.costs[one.label].per_vertex(self.count, max(self.lights, 1))
        return 1e-6 * each * self.count

    def rung(self, one: Candidate, needed: bool = True) -> Rung:
        """Return a model's place on the ladder.

        Parameters
        ----------
        one : Candidate
            The model.
        needed : bool
            Whether no other is known to be enough: one that is not local is checked then only.

        Returns
        -------
        Rung
            Its cost, and how wrong it is.
        """
        spent, lights = self.milliseconds(one), max(self.lights, 1)
        each = self.costs[one.label].per_vertex(self.count, lights) / lights
        errors = one.model.predicted_error(self.scene)
        if errors is None:
            nothing = float("nan")
            return Rung(one, nothing, nothing, nothing, 0.0, each, spent, False, None, False)
        of_vertices = relative(errors, self.irradiance)
        judged = self.judged(errors)
        score, value = self.tolerance.score(judged), self.tolerance.value
        checked = self._checked(one.model) if one.model.local or needed else None
        sure = self.check is not None and one.model.reference
        return Rung(
            candidate=one,
            median=float(np.median(of_vertices)) if len(of_vertices) else 0.0,
            p99=Tolerance(0.0).score(of_vertices),
            score=score,
            share=float(np.mean(judged <= value)) if len(judged) else 1.0,
            nanoseconds=each,
            milliseconds=spent,
            predicted=score <= value,
            checked=checked,
            adequate=sure or (score if checked is None else checked.high) <= value,
        )

    def _checked(self, model: ShadingModel) -> Checked | None:
        if self.check is None or model.reference:
            return None
        check, sized = self.check, with_samples(model, self.samples)
        if not model.local:
            before = time.perf_counter()
            shader = sized.shader_at(bared(self.inputs))
            check.seconds += time.perf_counter() - before
            return check(shader)
        return check(lambda vertices: exitance(sized, check.inputs_at(vertices)))

    @property
    def exposure(self) -> float:
        """The exposure that suits the scene: of the truth where it is known."""
        return auto_exposure(self._exitance()) if self.check is None else self.check.exposure

    def judged(self, errors: FloatArray) -> FloatArray:
        """Return predicted errors of vertices in the metric's unit.

        Parameters
        ----------
        errors : ndarray, shape=(n, 3)
            At the vertices that are predicted for.

        Returns
        -------
        ndarray
            Of colours fewer, because they take long.
        """
        if self.tolerance.metric == "relative":
            return relative(errors, self.irradiance)
        some = slice(None, None, -(-len(errors) // _COLORS) or 1)
        total = self.scene.table.total
        return color_differences(self._exitance()[some], errors[some] * total)

    def _exitance(self) -> FloatArray:
        """Return what an accurate local model gives at the vertices, for its colours."""
        if self.base is None:
            plain = replace(self.some, detail=None)
            self.base = exitance(model_registry.get(_COLORED_BY)(), plain)
        return self.base

    def suffices(self, blend: ShadingModel) -> bool:
        """Tell whether a blend of an adequate model with an inadequate one is adequate.

        Parameters
        ----------
        blend : ShadingModel
            One whose weights keep the predicted error within the tolerance.

        Returns
        -------
        bool
            What the check says, or True where nothing is checked.
        """
        if self.check is None:
            return True
        given = exitance(blend, self.inputs)
        return self.check(_taken(given)).high <= self.tolerance.value

    def unshadowed(self, model: ShadingModel) -> Checked | None:
        """Return how wrong a model is that casts no shadows, beside the light with them.

        Parameters
        ----------
        model : ShadingModel
            Any.

        Returns
        -------
        Checked or None
            None where nothing casts a shadow, nothing is checked or the model is not local.
        """
        if self.check is None or self.inputs.visibility is None or not model.local:
            return None
        return self.check(_taken(exitance(model, without_shadows(self.inputs))))

    def enough(self, known: list[Candidate]) -> float | None:
        """Return how many times as large the body must be for a local model, by prediction.

        Parameters
        ----------
        known : list of Candidate
            Those that predict their error.

        Returns
        -------
        float or None
            None where no size that is tried suffices.
        """
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
            sides=of.sides * factor**2,
            radius=of.radius * factor,
            variance=of.variance / factor**2,
        )
        errors = model.predicted_error(larger)
        return errors is not None and self.tolerance.score(self.judged(errors)) <= (
            self.tolerance.value
        )


def _taken(given: FloatArray) -> Callable[[AnyArray], FloatArray]:
    return lambda vertices: given[vertices]
