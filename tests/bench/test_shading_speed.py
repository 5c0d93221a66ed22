"""That plain NumPy and the compiled models are the same, and that their times are taken."""

import numpy as np
import pytest

from lutcore.shading import shade
from tests.bench.shading_speed import LIGHTS, MODELS, PLAIN, speeds
from tests.surfaces import torus


@pytest.mark.parametrize("model", sorted(PLAIN))
@pytest.mark.parametrize("name", ["skin1", "marble"])
def test_plain_numpy_gives_the_same(model: str, name: str) -> None:
    surface = torus(3000)
    np.testing.assert_allclose(
        shade(*surface, name, LIGHTS, model),
        PLAIN[model](*surface, name, LIGHTS),
        rtol=0.0,
        # The compiled logarithm is good to 5e-13, slopes and the sum of lights are of order 1.
        atol=1e-11,
    )


def test_every_local_model_is_timed() -> None:
    found = speeds(2000, 1)
    times = found["ns_per_vertex_light_channel"]
    assert isinstance(times, dict)
    assert set(times) == set(MODELS)
    assert all(value > 0.0 for value in times.values())
    assert isinstance(found["numpy_ns_per_vertex_light_channel"], dict)
    assert set(found["numpy_ns_per_vertex_light_channel"]) == set(PLAIN)
