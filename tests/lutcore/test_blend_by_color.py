"""The blend of two models for tolerances of colour."""

from dataclasses import replace
from functools import cache

import numba
import numpy as np
import pytest

from lutcore import analytic
from lutcore.arrays import FloatArray
from lutcore.blend import Blend, at
from lutcore.choice import Choice, choose
from lutcore.color import auto_exposure
from lutcore.costs import COLORS, PREDICTION, Candidate, Cost
from lutcore.detail import detail_seen
from lutcore.errors import ParameterError
from lutcore.exitance import exitance
from lutcore.gather.exitance import exact
from lutcore.lights import DirectionalLight
from lutcore.prediction import Scene
from lutcore.shading import ShadingInputs, model_registry, shading_inputs
from lutcore.tolerance import Tolerance, color_distances

LIGHTS = [DirectionalLight((0.6, 0.3, 0.74)), DirectionalLight((-0.9, 0.1, 0.2), 0.4)]
CHEAP = model_registry.get("lambert")(fresnel="directional")
GOOD = model_registry.get("curvature-lut")()
COSTS = {
    "lambert (fresnel directional)": Cost(9.0, "n"),
    "curvature-lut": Cost(2000.0, "n"),
    PREDICTION: Cost(12.0, "n"),
    COLORS: Cost(60.0, "n"),
}


def cigar(mm: float, count: int = 6000) -> ShadingInputs:
    body = analytic.ellipsoid(count, axes=(12.0, 3.0, 3.0))
    return shading_inputs(body.mesh, body.truth, "skin1", LIGHTS, mm)


@cache
def gathered(mm: float) -> FloatArray:
    """Return the light that leaves every fifth vertex."""
    scene = cigar(mm)
    return exact(scene, scene.points[::5])


@pytest.fixture(scope="module")
def inputs() -> ShadingInputs:
    return cigar(20.0)


def blended(inputs: ShadingInputs, limit: float) -> tuple[Blend, FloatArray]:
    """Return a blend under the picture's exposure, with its weights."""
    assert inputs.curvatures is not None
    blend = Blend(CHEAP, GOOD, limit, auto_exposure(exitance(GOOD, inputs)))
    scene = Scene.of(inputs, inputs.curvatures)
    return blend, blend.weights(scene, exitance(CHEAP, inputs))


def test_what_is_compiled_for_all_vertices_serves_for_some() -> None:
    body = analytic.torus(500, major=20.0, minor=8.0)
    seen = detail_seen(body.mesh, "skin1")
    inputs = shading_inputs(body.mesh, body.truth, "skin1", LIGHTS, detail=seen)
    chosen = np.arange(0, len(body.mesh.vertices), 3)
    some, scene = at(inputs, chosen), Scene.of(inputs, body.truth)
    pairs = [
        (getattr(some, name), getattr(inputs, name)) for name in ("points", "normals", "shape")
    ]
    assert some.detail is not None
    for field in ("normals", "shape"):
        pairs += zip(getattr(some.detail, field), getattr(seen, field), strict=True)
    pairs.append((scene.at(chosen).points, scene.points))
    for one, other in pairs:
        assert numba.typeof(one) == numba.typeof(other)


def test_it_leaves_no_seam_that_is_seen(inputs: ShadingInputs) -> None:
    limit = 4.0
    blend, weight = blended(inputs, limit)
    assert blend.exposure is not None
    assert np.mean(weight == 0.0) > 0.05
    assert np.mean(weight > 0.0) > 0.05
    mixed, pure, poor = (exitance(one, inputs) for one in (blend, GOOD, CHEAP))
    for model, alone in ((poor, weight == 0.0), (pure, weight == 1.0)):
        np.testing.assert_array_equal(mixed[alone], model[alone])
    # What the blend changes of the better model is within the limit, and across an edge of the
    # mesh colours step by no more than the weights do beyond what they would without.
    apart = color_distances(mixed, pure, blend.exposure)
    assert apart.max() <= limit
    faces = inputs.faces
    ends, others = faces.ravel(), np.roll(faces, 1, axis=1).ravel()
    steps = [color_distances(one[ends], one[others], blend.exposure) for one in (mixed, pure, poor)]
    beyond = steps[0] - np.maximum(steps[1], steps[2])
    distance = color_distances(poor, pure, blend.exposure)[weight < 1.0].max()
    assert np.all(beyond <= np.abs(weight[ends] - weight[others]) * distance + 0.05 * limit)
    assert beyond.max() < 0.25 * limit


def test_all_lights_share_its_weights_and_shadows_are_cast_on_both(inputs: ShadingInputs) -> None:
    blend, _ = blended(inputs, 4.0)
    shares = np.random.default_rng(0).uniform(0.0, 1.0, (len(LIGHTS), len(inputs.points), 3))
    for given in (inputs, replace(inputs, visibility=shares)):
        assert given.curvatures is not None
        poor, good = exitance(CHEAP, given), exitance(GOOD, given)
        weight = blend.weights(Scene.of(given, given.curvatures), poor)[:, None]
        mixed = (1.0 - weight) * poor + weight * good
        np.testing.assert_allclose(exitance(blend, given), mixed, rtol=0.0, atol=1e-12)


def chosen(inputs: ShadingInputs, tolerance: Tolerance, checked: bool = True) -> Choice:
    models = [Candidate("lambert", CHEAP), Candidate("curvature-lut", GOOD)]
    return choose(inputs, tolerance, COSTS, models, checked=checked)


@pytest.mark.parametrize(
    ("metric", "value", "mm", "checked"),
    [
        ("mean-de2000", 0.3, 12.0, True),
        ("p99-de2000", 2.5, 20.0, True),
        ("mean-de2000", 1.0, 20.0, False),
        ("p99-de2000", 12.0, 20.0, False),
    ],
)
def test_it_is_chosen_where_it_pays_and_meets_the_tolerance(
    metric: str, value: float, mm: float, checked: bool
) -> None:
    scene, tolerance = cigar(mm), Tolerance(value, metric)
    choice = chosen(scene, tolerance, checked)
    assert choice.blend is not None
    assert choice.blend.exposure is not None
    assert choice.milliseconds < 0.9 * choice.chosen.milliseconds
    assert "blended in on the rest" in choice.sentence
    truth = gathered(mm)
    off = color_distances(exitance(choice.model, scene)[::5], truth, auto_exposure(truth))
    assert tolerance.score(off) <= value
    assert chosen(scene, tolerance, checked).model == choice.model


def test_it_costs_the_cheaper_model_everywhere(inputs: ShadingInputs) -> None:
    choice = chosen(inputs, Tolerance(2.5, "p99-de2000"))
    assert choice.blend is not None and choice.cheaper is not None
    count, lights = len(inputs.points), len(LIGHTS)
    least = choice.cheaper.milliseconds + 1e-6 * count * (12.0 * lights + 60.0)
    _, weight = blended(inputs, 2.5)
    share = (choice.milliseconds - least) / choice.chosen.milliseconds
    assert share == pytest.approx(np.mean(weight > 0.0), abs=0.03)


def test_a_mean_leaves_room_for_larger_errors() -> None:
    limits = []
    for value in (0.25, 0.3, 0.4):
        choice = chosen(cigar(12.0), Tolerance(value, "mean-de2000"))
        assert choice.blend is not None
        limits.append(choice.blend.limit / value)
    # The more the better model spares, the more the cheaper one may use.
    assert 1.0 < limits[0] < limits[1] <= limits[2]
    # Of one vertex in a hundred no limit is a larger one.
    strict = chosen(cigar(20.0), Tolerance(2.5, "p99-de2000"))
    assert strict.blend is not None
    assert strict.blend.limit == 2.5


def test_colours_are_asked_for(inputs: ShadingInputs) -> None:
    blend, _ = blended(inputs, 4.0)
    assert inputs.curvatures is not None
    with pytest.raises(ParameterError, match="what the cheaper model gives"):
        blend.weights(Scene.of(inputs, inputs.curvatures))
