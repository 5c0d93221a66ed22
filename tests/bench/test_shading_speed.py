"""That plain NumPy and the compiled models are the same, and that their times are taken."""

import numpy as np
import pytest

from lutcore.exitance import shade
from lutcore.gather.exitance import exact
from lutcore.shading import shading_inputs
from tests import numpy_shading
from tests.bench.shading_speed import GATHERING, LIGHTS, MODELS, PLAIN, gathering_speeds, speeds
from tests.surfaces import torus


@pytest.mark.parametrize("label", sorted(MODELS))
@pytest.mark.parametrize("name", ["skin1", "marble"])
def test_plain_numpy_gives_the_same(label: str, name: str) -> None:
    surface = torus(3000)
    model, parameters = MODELS[label]
    np.testing.assert_allclose(
        shade(*surface, name, LIGHTS, model, **parameters),
        PLAIN[label](*surface, name, LIGHTS),
        rtol=0.0,
        # The compiled logarithm is good to 5e-13, slopes and the sum of lights are of order 1.
        atol=1e-11,
    )


def test_plain_numpy_gathers_the_same() -> None:
    surface = torus(3000)
    some = surface[0].vertices[::300]
    found = numpy_shading.gather(*surface, "skin1", LIGHTS, some)
    truth = exact(shading_inputs(*surface, "skin1", LIGHTS), some)
    # Parts are 1 mm long at most, where the profile of blue falls within .7 mm.
    assert np.linalg.norm(found - truth) < 0.02 * np.linalg.norm(truth)


def test_every_model_that_gathers_is_timed() -> None:
    times = gathering_speeds(500, 1)["gathering_ns_per_vertex_light_channel"]
    assert isinstance(times, dict)
    assert set(times) == set(GATHERING)
    assert all(value > 0.0 for value in times.values())


def test_every_local_model_is_timed() -> None:
    found = speeds(2000, 1)
    times = found["ns_per_vertex_light_channel"]
    assert isinstance(times, dict)
    assert set(times) == set(MODELS)
    assert all(value > 0.0 for value in times.values())
    assert isinstance(found["numpy_ns_per_vertex_light_channel"], dict)
    assert set(found["numpy_ns_per_vertex_light_channel"]) == set(MODELS)
