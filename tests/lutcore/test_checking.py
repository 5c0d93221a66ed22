"""The check of models at a sample of vertices."""

import numpy as np
import pytest
from numpy.typing import NDArray

from lutcore import analytic
from lutcore.analytic import Exact
from lutcore.arrays import FloatArray
from lutcore.checking import CONFIDENCE, STAGES, Check, Checked
from lutcore.errors import CancelledError
from lutcore.exitance import exitance
from lutcore.gather.exitance import exact, gathered
from lutcore.lights import DirectionalLight
from lutcore.shading import ShadingInputs, model_registry, shading_inputs
from lutcore.tolerance import Tolerance, color_distances, relative

LIGHT = DirectionalLight((0.6, 0.3, 0.74))
ONE = np.ones(3)


def inputs_on(body: Exact, mm: float = 20.0, lit: bool = True, **more: object) -> ShadingInputs:
    lights = [LIGHT] if lit else []
    return shading_inputs(body.mesh, body.truth, "skin1", lights, mm, **more)  # type: ignore[arg-type]


def found(check: Check, given: FloatArray) -> Checked:
    return check(lambda vertices: given[vertices])


@pytest.fixture(scope="module")
def torus() -> ShadingInputs:
    return inputs_on(analytic.torus(3000, major=3.0, minor=1.0))


def test_of_a_small_mesh_every_vertex_is_judged() -> None:
    torus = inputs_on(analytic.torus(1500, major=3.0, minor=1.0))
    given = exitance(model_registry.get("lambert")(), torus)
    off = relative(np.abs(given - exact(torus, torus.points)) / torus.table.total, ONE)
    score = float(np.percentile(off, 99.0))
    for limit in (score * 1.002, score * 0.998):  # so near that the first stage does not tell
        checked = found(Check(torus, Tolerance(limit), ONE), given)
        assert checked.vertices == len(torus.points)
        assert checked.low == checked.high == checked.score
        assert checked.score == pytest.approx(score, rel=0.01)
        assert checked.share == pytest.approx(np.mean(off <= limit), abs=0.002)


def test_what_is_far_from_the_tolerance_takes_few_vertices(torus: ShadingInputs) -> None:
    given = exitance(model_registry.get("lambert")(), torus)
    for limit in (0.5, 0.001):
        checked = found(Check(torus, Tolerance(limit), ONE), given)
        assert checked.vertices == STAGES[0]
        assert (checked.high <= limit) == (limit == 0.5)
        assert checked.low <= checked.score <= checked.high


def test_the_same_seed_draws_the_same_and_order_does_not_matter(torus: ShadingInputs) -> None:
    far = exitance(model_registry.get("lambert")(), torus)
    near = exitance(model_registry.get("curvature-lut")(), torus)
    tolerance = Tolerance(found(Check(torus, Tolerance(0.5), ONE), far).score)
    one, other = Check(torus, tolerance, ONE, 3), Check(torus, tolerance, ONE, 3)
    first = [found(one, far), found(one, near)]
    second = [found(other, near), found(other, far)]
    assert first == second[::-1]
    assert found(Check(torus, Tolerance(0.5), ONE, 4), far) != found(
        Check(torus, Tolerance(0.5), ONE, 5), far
    )


class Drawn(Check):
    """A check whose truth is darkness, of a surface with as many vertices as wanted."""

    def __init__(self, count: int, tolerance: Tolerance, seed: int) -> None:
        body = analytic.sphere(12)
        super().__init__(inputs_on(body), tolerance, ONE, seed)
        order = np.random.default_rng(seed).permutation(count)
        stages = [min(stage, count) for stage in STAGES]
        self._parts = [np.sort(one) for one in np.split(order[: stages[-1]], stages[:-1])]
        self._held, self._whole = count, stages[-1] == count

    def _errors(self, given: FloatArray, stage: int) -> FloatArray:
        return given[:, 0]


@pytest.mark.parametrize("metric", ["relative", "mean-de2000"])
def test_the_confidence_is_as_stated(metric: str) -> None:
    # Models just beyond the tolerance, by a twentieth of a per cent of the vertices or of the mean.
    generator, wrong, trials = np.random.default_rng(0), 0, 300
    for seed in range(trials):
        errors = generator.exponential(size=(60_000, 1))
        score = Tolerance(0.0, metric).score(errors[:, 0])
        check = Drawn(len(errors), Tolerance(0.999 * score, metric), seed)
        wrong += found(check, errors).high <= 0.999 * score
    # 1 % of 300 are 3; more than 9 has a probability of .001.
    assert CONFIDENCE == 0.99
    assert wrong <= 9


def test_more_stages_tell_closer() -> None:
    errors = np.random.default_rng(1).exponential(size=(400_000, 1))
    score = Tolerance(0.0).score(errors[:, 0])
    sizes: list[int] = []
    for factor in (3.0, 1.15, 1.02):
        checked = found(Drawn(len(errors), Tolerance(factor * score), 0), errors)
        sizes.append(checked.vertices)
        assert checked.low <= score <= checked.high
    assert sizes == sorted(sizes)
    assert (sizes[0], sizes[-1]) == (STAGES[0], STAGES[-1])


def test_colours_are_compared_as_they_are_shown(torus: ShadingInputs) -> None:
    truth = gathered(torus, 1e-4)
    given = exitance(model_registry.get("lambert")(), torus)
    exposure = 0.85 / np.percentile(truth.max(axis=1), 99.0)
    mean = float(color_distances(given, truth, exposure).mean())
    checked = found(Check(torus, Tolerance(1.001 * mean, "mean-de2000"), ONE), given)
    assert checked.vertices == len(torus.points)
    assert checked.score == pytest.approx(mean, rel=0.01)


def test_borders_are_left_out() -> None:
    body = analytic.cylinder(6000, radius=1.0, length=10.0)
    inputs = inputs_on(body, 3.0)
    check = Check(inputs, Tolerance(0.02), ONE)
    assert 0.05 < check.coverage.share < 0.8
    drawn: list[NDArray[np.integer]] = []

    def shade(vertices: NDArray[np.integer]) -> FloatArray:
        drawn.append(vertices)
        return np.zeros((len(vertices), 3))

    check(shade)
    height = inputs.points[np.concatenate(drawn), 2]
    assert height.min() > 1.0
    assert height.max() < 9.0
    # What is left of the cylinder between its borders is lit as the endless one.
    whole = exact(inputs, inputs.points[np.argsort(np.abs(inputs.points[:, 2] - 5.0))[:40]])
    assert whole.max() > 0.0
    tiny = Check(inputs_on(body, 0.01), Tolerance(0.02), ONE)
    assert "borders" in tiny.coverage.reason


def test_of_meshes_too_large_to_gather_from_it_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("lutcore.checking._MOST", 99)
    check = Check(inputs_on(analytic.sphere(100)), Tolerance(0.02), ONE)
    assert "more than 99 vertices" in check.coverage.reason


def test_without_light_there_is_nothing_to_check() -> None:
    check = Check(inputs_on(analytic.sphere(100), lit=False), Tolerance(0.02), ONE)
    assert check.coverage.reason == "there is no light"


def test_it_can_be_cancelled() -> None:
    inputs = inputs_on(analytic.sphere(2000), progress=lambda share, step: share < 0.4)
    given = np.zeros((len(inputs.points), 3))
    with pytest.raises(CancelledError):
        found(Check(inputs, Tolerance(0.02), ONE), given)
