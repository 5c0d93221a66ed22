"""How large a table a scene needs."""

import numpy as np

from lutcore import analytic
from lutcore.exitance import exitance
from lutcore.lights import DirectionalLight
from lutcore.shading import model_registry, shading_inputs
from lutcore.table_size import SIZES, samples_needed, with_samples
from lutcore.tolerance import Tolerance


def test_a_table_of_that_size_does_not_matter_beside_the_tolerance() -> None:
    body = analytic.torus(2000, major=3.0, minor=1.0)
    inputs = shading_inputs(body.mesh, body.truth, "skin1", [DirectionalLight((1, 0, 1))], 5.0)
    model = model_registry.get("curvature-lut")()
    whole = exitance(model, inputs)
    sizes = []
    for value in (0.1, 0.01, 1e-3, 1e-5):
        sizes.append(samples_needed(inputs, Tolerance(value)))
        sized = exitance(with_samples(model, sizes[-1]), inputs)
        assert np.abs((sized - whole) / inputs.table.total).max() < 0.1 * value
    assert sizes == sorted(sizes)
    assert sizes[0] < sizes[-1]
    assert set(sizes) <= set(SIZES)


def test_colours_are_as_strict_as_the_light_they_stand_for() -> None:
    body = analytic.sphere(200)
    inputs = shading_inputs(body.mesh, body.truth, "skin1", [], 5.0)
    as_light = samples_needed(inputs, Tolerance(0.01))
    assert samples_needed(inputs, Tolerance(1.0, "mean-de2000")) == as_light


def test_models_without_a_table_stay_as_they_are() -> None:
    lambert = model_registry.get("lambert")()
    assert with_samples(lambert, 8) is not None
    assert with_samples(lambert, 8) == lambert
    for name in ("curvature-lut", "curvature-lut-physical", "kolchin2007"):
        assert with_samples(model_registry.get(name)(), 16).samples == 16  # type: ignore[attr-defined]


def test_a_profile_that_needs_more_samples_gets_them() -> None:
    body = analytic.sphere(50)
    for profile, usual in (("jensen2001", 64), ("burley2015", 512)):
        inputs = shading_inputs(body.mesh, body.truth, "skin1", [], profile=profile)
        assert inputs.table.psi.shape[1] == usual
        assert inputs.baked(8).psi.shape[1] == usual // 8
