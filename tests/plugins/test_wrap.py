"""Wrap lighting."""

import numpy as np
import pytest

from lutcore.exitance import shade
from lutcore.lights import DirectionalLight
from tests.surfaces import sphere

LIGHT = [DirectionalLight((0.0, 0.0, 1.0))]
COSINES = np.array([-1.0, -0.3, -0.2, -0.1, 0.0, 0.5, 1.0])


def test_green_2004_at_the_default_width() -> None:
    shaded = shade(*sphere(COSINES, 5.0), "skin1", LIGHT, "wrap")[:, 0]
    expected = np.array([0.0, 0.0, 0.0, 0.1 / 1.2, 0.2 / 1.2, 0.7 / 1.2, 1.0])
    np.testing.assert_allclose(shaded / shaded[-1], expected, atol=1e-15)


def test_no_width_is_lambert() -> None:
    surface = sphere(COSINES, 5.0)
    np.testing.assert_allclose(
        shade(*surface, "skin1", LIGHT, "wrap", width=0.0),
        shade(*surface, "skin1", LIGHT, "lambert"),
        rtol=1e-15,
    )


@pytest.mark.parametrize("radius", [0.1, np.inf])
def test_curvature_does_not_matter(radius: float) -> None:
    np.testing.assert_allclose(
        shade(*sphere(COSINES, radius), "skin1", LIGHT, "wrap"),
        shade(*sphere(COSINES, 5.0), "skin1", LIGHT, "wrap"),
        atol=1e-15,
    )
