"""The choice of a model, and the blend of two."""

from dataclasses import dataclass

import numpy as np
import pytest

from lutcore import analytic
from lutcore.arrays import FloatArray
from lutcore.blend import Blend, at
from lutcore.choice import choose
from lutcore.costs import COLORS, PREDICTION, Candidate, Cost, candidates
from lutcore.errors import ParameterError
from lutcore.exitance import exitance
from lutcore.lights import DirectionalLight
from lutcore.prediction import Scene
from lutcore.shading import ShadingInputs, ShadingModel, model_registry, shading_inputs
from lutcore.tolerance import Tolerance

# As on one machine, ns.
LOCAL = {
    "lambert": 4.0,
    "lambert (fresnel directional)": 9.0,
    "curvature-lut": 45.0,
    "wrap": 4.5,
}
COSTS = {label: Cost(each, "n") for label, each in LOCAL.items()} | {
    "jensen2002": Cost(300.0, "n log n"),
    PREDICTION: Cost(12.0, "n"),
    COLORS: Cost(60.0, "n"),
}
LIGHT = DirectionalLight((0.6, 0.3, 0.74))


@dataclass(frozen=True)
class Unknown(ShadingModel):
    """A model of somebody else's that predicts nothing and costs nothing."""

    def shade(self, inputs: ShadingInputs) -> FloatArray:
        """Return darkness."""
        return np.zeros_like(inputs.points)


def models() -> list[Candidate]:
    return [one for one in candidates() if one.label in COSTS]


def inputs_on(body: analytic.Exact, mm: float) -> ShadingInputs:
    return shading_inputs(body.mesh, body.truth, "skin1", [LIGHT], mm)


@pytest.mark.parametrize("checked", [True, False])
def test_large_bodies_need_less(checked: bool) -> None:
    ball, ladder = analytic.sphere(3000), models()
    chosen = [
        choose(inputs_on(ball, mm), Tolerance(0.02), COSTS, ladder, checked=checked)
        for mm in (10_000.0, 28.0 if checked else 40.0, 4.0)
    ]
    labels = [one.chosen.candidate.label for one in chosen]
    assert labels == ["lambert (fresnel directional)", "curvature-lut", "jensen2002"]
    assert all((one.chosen.checked is not None) == checked for one in chosen)


def test_choice_is_the_cheapest_adequate() -> None:
    choice = choose(inputs_on(analytic.sphere(3000), 60.0), Tolerance(0.02), COSTS, models())
    assert choice.chosen.adequate
    spent = [rung.milliseconds for rung in choice.rungs]
    assert spent == sorted(spent)
    cheaper = [r for r in choice.rungs if r.milliseconds < choice.chosen.milliseconds]
    assert cheaper
    assert not any(rung.adequate for rung in cheaper)
    ball = inputs_on(analytic.sphere(3000), 60.0)
    short = choose(ball, Tolerance(0.02), COSTS, models(), whole=False)
    assert short.model == choice.model
    assert len(short.rungs) < len(choice.rungs)


def test_unknown_models_are_listed_and_never_chosen() -> None:
    stranger = Candidate("stranger", Unknown())
    known = COSTS | {"stranger": Cost(0.1, "n")}
    found = choose(
        inputs_on(analytic.sphere(500), 1e4), Tolerance(0.5), known, [*models(), stranger]
    )
    assert found.rungs[0].candidate is stranger
    assert np.isnan(found.rungs[0].score)
    assert found.chosen.candidate.name != "stranger"
    with pytest.raises(ParameterError, match="no model predicts"):
        choose(inputs_on(analytic.sphere(500), 1.0), Tolerance(0.5), known, [stranger])


def test_where_no_local_model_suffices_it_says_what_would() -> None:
    choice = choose(inputs_on(analytic.sphere(2000), 4.0), Tolerance(0.02), COSTS, models())
    assert "no local model suffices" in choice.sentence
    assert choice.enough is not None
    # A body that many times as large does with a local model.
    larger = inputs_on(analytic.sphere(2000), 4.0 * choice.enough)
    assert choose(larger, Tolerance(0.02), COSTS, models()).chosen.candidate.model.local


@pytest.mark.parametrize("metric", ["mean-de2000", "p99-de2000"])
def test_colour_tolerances_order_models_alike(metric: str) -> None:
    ball = inputs_on(analytic.sphere(1500), 60.0)
    strict = choose(ball, Tolerance(0.3, metric), COSTS, models())
    loose = choose(ball, Tolerance(30.0, metric), COSTS, models())
    assert loose.chosen.milliseconds < strict.chosen.milliseconds
    dark = shading_inputs(analytic.sphere(99).mesh, analytic.sphere(99).truth, "skin1", [])
    with pytest.raises(ParameterError, match="needs a light"):
        choose(dark, Tolerance(1.0, metric), COSTS, models())


def test_blend_leaves_no_seam() -> None:
    body = analytic.ellipsoid(12_000, axes=(6.0, 2.0, 2.0))
    inputs = inputs_on(body, 15.0)
    scene = Scene.of(inputs, body.truth)
    limit = 0.03
    cheap = model_registry.get("lambert")(fresnel="directional")
    good = model_registry.get("curvature-lut")()
    blend = Blend(cheap, good, limit)
    weight = blend.weights(scene)
    assert np.mean(weight == 0.0) > 0.1
    assert np.mean(weight > 0.0) > 0.05
    total = inputs.table.total
    mixed, pure = blend.shade(inputs) / total, good.shade(inputs) / total
    # What the blend adds to the better model lies within the limit, and across any edge of the
    # mesh it changes by no more than the weight does.
    added = mixed - pure
    assert np.abs(added).max() <= limit
    faces = body.mesh.faces
    ends, others = faces.ravel(), np.roll(faces, 1, axis=1).ravel()
    step = np.abs(added[ends] - added[others]).max()
    apart = np.abs((cheap.shade(inputs) / total - pure)[weight < 1.0]).max()
    assert step <= np.abs(weight[ends] - weight[others]).max() * apart + 0.1 * limit
    assert step < 0.5 * limit


def test_blend_is_each_model_where_it_is_alone() -> None:
    body = analytic.ellipsoid(2000, axes=(6.0, 2.0, 2.0))
    inputs = inputs_on(body, 15.0)
    cheap, good = model_registry.get("lambert")(), model_registry.get("curvature-lut")()
    blend = Blend(cheap, good, 0.06)
    weight = blend.weights(Scene.of(inputs, body.truth))
    shaded = blend.shade(inputs)
    for model, alone in ((cheap, weight == 0.0), (good, weight == 1.0)):
        assert alone.any()
        np.testing.assert_array_equal(shaded[alone], model.shade(inputs)[alone])


@pytest.mark.parametrize(("checked", "mm"), [(True, 10.0), (False, 20.0)])
def test_a_blend_is_chosen_where_it_pays(checked: bool, mm: float) -> None:
    body = analytic.ellipsoid(6000, axes=(12.0, 3.0, 3.0))
    costly = COSTS | {"curvature-lut": Cost(2000.0, "n")}
    few = [one for one in models() if one.name != "jensen2002"]
    choice = choose(inputs_on(body, mm), Tolerance(0.03), costly, few, checked=checked)
    assert choice.blend is not None
    assert choice.milliseconds < choice.chosen.milliseconds
    assert "blended in on the rest" in choice.sentence
    inputs = inputs_on(body, mm)
    given = exitance(choice.model, inputs)
    some = np.arange(0, 6000, 50)
    np.testing.assert_allclose(
        given[some], exitance(choice.blend, inputs)[some], rtol=0.0, atol=0.0
    )
    assert np.isfinite(at(inputs, some).points).all()
