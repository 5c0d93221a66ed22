"""Cast shadows in the check of models."""

from dataclasses import replace

import numpy as np
import pytest

from lutcore import analytic
from lutcore.checking import Check
from lutcore.choice import choose
from lutcore.costs import COLORS, PREDICTION, Candidate, Cost, candidates
from lutcore.exitance import exitance, shade, without_shadows
from lutcore.gather.exitance import gathered
from lutcore.lights import DirectionalLight, Light
from lutcore.mesh import TriangleMesh
from lutcore.prediction import Scene
from lutcore.shading import ShadingInputs, model_registry, shading_inputs
from lutcore.tolerance import Tolerance
from lutcore.visibility import softened, visibility

LOW: list[Light] = [DirectionalLight((0.9, 0.2, 0.35)), DirectionalLight((0.0, 0.0, 1.0), 0.3)]
NAMES = ("lambert", "lambert (fresnel directional)", "curvature-lut", "jensen2002")
COSTS = {
    "lambert": Cost(4.0, "n"),
    "lambert (fresnel directional)": Cost(9.0, "n"),
    "curvature-lut": Cost(45.0, "n"),
    "jensen2002": Cost(300.0, "n log n"),
    PREDICTION: Cost(12.0, "n"),
    COLORS: Cost(60.0, "n"),
}
LUT = model_registry.get("curvature-lut")()
ONE = np.ones(3)


def models() -> list[Candidate]:
    return [one for one in candidates() if one.label in NAMES]


def cast(body: analytic.Exact, mm: float) -> ShadingInputs:
    """Return a scene with the shadows that its surface casts."""
    inputs = shading_inputs(body.mesh, body.truth, "skin1", LOW, mm)
    seen = visibility(body.mesh, inputs.lights)
    glow = inputs.table.mean_free_path * inputs.table.psi[:, 0] / mm
    soft = softened(seen, TriangleMesh(inputs.points, inputs.faces), glow)
    return replace(inputs, visibility=seen, softened=soft)


@pytest.fixture(scope="module")
def ring() -> ShadingInputs:
    return cast(analytic.torus(4000, major=10.0, minor=4.0), 3.0)


def test_the_truth_is_the_light_that_shadows_leave(ring: ShadingInputs) -> None:
    truth = gathered(ring, 1e-4)
    check = Check(ring, Tolerance(0.02), ONE)
    assert check(lambda vertices: truth[vertices]).score < 1e-3
    bright = gathered(without_shadows(ring), 1e-4)
    assert check(lambda vertices: bright[vertices]).score > 0.1


def test_local_models_get_softened_shadows_and_others_hard_ones(ring: ShadingInputs) -> None:
    check = Check(ring, Tolerance(0.02), ONE)
    whole = exitance(LUT, ring)
    some = np.arange(0, len(ring.points), 7)
    np.testing.assert_array_equal(exitance(LUT, check.inputs_at(some)), whole[some])
    np.testing.assert_array_equal(whole, exitance(LUT, replace(ring, visibility=ring.softened)))
    gather = model_registry.get("jensen2002")()
    np.testing.assert_array_equal(
        exitance(gather, ring), exitance(gather, replace(ring, softened=None))
    )
    # Softening is what makes a local model come near.
    hard = check(lambda v: exitance(LUT, replace(check.inputs_at(v), softened=None)))
    assert check(lambda v: exitance(LUT, check.inputs_at(v))).score < hard.score


def test_the_choice_is_of_a_scene_with_its_shadows(ring: ShadingInputs) -> None:
    tolerance = Tolerance(0.03)
    plain = choose(without_shadows(ring), tolerance, COSTS, models())
    shadowed = choose(ring, tolerance, COSTS, models())
    assert not plain.shadowed
    assert plain.unshadowed is None
    assert shadowed.shadowed
    for one, other in zip(plain.rungs, shadowed.rungs, strict=True):
        if one.candidate.model.local:
            assert one.checked.score < other.checked.score
    assert plain.chosen.candidate.model.local
    assert shadowed.chosen.candidate.name == "jensen2002"
    assert shadowed.unshadowed is None  # nothing local suffices


def test_it_says_what_leaving_shadows_out_would_do(ring: ShadingInputs) -> None:
    for value in (0.2, 1.5):
        choice = choose(ring, Tolerance(value), COSTS, models())
        assert choice.chosen.candidate.model.local
        assert choice.unshadowed is not None
        assert choice.chosen.checked is not None
        assert choice.chosen.checked.score < choice.unshadowed.score
        assert (choice.unshadowed.high <= value) == (value == 1.5)


@pytest.mark.parametrize("metric", ["relative", "p99-de2000"])
def test_where_nothing_casts_a_shadow_the_choice_is_the_same(metric: str) -> None:
    body = cast(analytic.ellipsoid(2500, axes=(3.0, 2.0, 1.0)), 20.0)
    assert body.visibility is not None
    assert body.visibility.all()
    tolerance = Tolerance(0.02 if metric == "relative" else 2.0, metric)
    both = [choose(one, tolerance, COSTS, models()) for one in (body, without_shadows(body))]
    one, other = (replace(found, check_milliseconds=0.0) for found in both)
    assert one == other


def test_shares_that_a_caller_gives_are_on_both_sides() -> None:
    # `shade` with `auto` judges local models by the light that it gives them.
    body = analytic.torus(3000, major=10.0, minor=4.0)
    seen = visibility(body.mesh, shading_inputs(body.mesh, body.truth, "skin1", LOW).lights)
    args = (body.mesh, body.truth, "skin1", LOW)
    given = {"mm_per_unit": 3.0, "visibility": seen}
    from lutcore.costs import forget, remember

    forget()
    remember(
        COSTS | {c.label: Cost(1e4, c.model.growth) for c in candidates() if c.label not in COSTS}
    )
    try:
        auto = shade(*args, "auto", **given)  # type: ignore[arg-type]
    finally:
        forget()
    gathered = shade(*args, "jensen2002", **given)  # type: ignore[arg-type]
    np.testing.assert_array_equal(auto, gathered)


def test_predictions_see_shadows_and_where_they_end(ring: ShadingInputs) -> None:
    assert ring.curvatures is not None
    assert ring.softened is not None
    scene = Scene.of(ring, ring.curvatures)
    plain = Scene.of(without_shadows(ring), ring.curvatures)
    second = replace(plain, lights=plain.lights[1:])
    soft = ring.softened[0]  # the second light reaches everything that faces it
    lit, dark = (soft == 1.0).all(axis=1), (soft == 0.0).all(axis=1)
    lit &= (ring.softened[1] == 1.0).all(axis=1)
    dark &= (ring.softened[1] == 1.0).all(axis=1)
    edge = (soft > 0.0) & (soft < 1.0)
    assert min(np.count_nonzero(lit), np.count_nonzero(dark)) > 50
    found = LUT.predicted_error(scene)
    np.testing.assert_allclose(found[lit], LUT.predicted_error(plain)[lit], rtol=1e-12)
    np.testing.assert_allclose(found[dark], LUT.predicted_error(second)[dark], rtol=1e-12)
    off = np.abs(exitance(LUT, ring) - gathered(ring, 1e-4)) / ring.table.total
    assert np.mean(off[edge] <= found[edge]) > 0.9
    assert np.mean(off[edge] <= LUT.predicted_error(plain)[edge]) < 0.8


def test_in_the_dark_what_gathers_errs_no_more_than_there_is_light(ring: ShadingInputs) -> None:
    # A tolerance of colour that no local model meets where a shadow ends: predicted alone, with
    # what lies between mesh and body, nothing would meet it; checked, what gathers does.
    tolerance = Tolerance(0.8, "p99-de2000")
    choice = choose(ring, tolerance, COSTS, models())
    found = choice.chosen
    assert found.candidate.name == "jensen2002"
    assert found.score > tolerance.value
    assert found.checked is not None
    assert found.checked.high <= tolerance.value
    assert all(rung.checked is not None for rung in choice.rungs[:-1])
