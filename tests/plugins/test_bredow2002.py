"""Wrap lighting by angle."""

import numpy as np
import pytest

from lutcore.exitance import shade
from lutcore.lights import DirectionalLight
from tests.surfaces import sphere

LIGHT = [DirectionalLight((0.0, 0.0, 1.0))]
DEGREES = np.array([0.0, 45.0, 90.0, 99.0, 110.0, 120.0, 180.0])


def on_sphere(radius: float, **parameters: float) -> np.ndarray:
    surface = sphere(np.cos(np.radians(DEGREES)), radius)
    return shade(*surface, "skin1", LIGHT, "bredow2002", **parameters)[:, 0]


@pytest.mark.parametrize("angle", [90.0, 110.0, 180.0])
def test_light_falls_evenly_with_the_angle_and_ends_where_it_is_told(angle: float) -> None:
    shaded = on_sphere(5.0, angle=angle)
    expected = np.maximum(1.0 - DEGREES / angle, 0.0)
    # The arc cosine of a cosine near -1 or 1 keeps half of the digits.
    np.testing.assert_allclose(shaded / shaded[0], expected, atol=1e-7)


@pytest.mark.parametrize("radius", [0.1, np.inf])
def test_curvature_does_not_matter(radius: float) -> None:
    np.testing.assert_allclose(on_sphere(radius), on_sphere(5.0), atol=1e-15)


def test_facing_the_light_it_is_lambert() -> None:
    surface = sphere(np.ones(3), 5.0)
    np.testing.assert_allclose(
        shade(*surface, "skin1", LIGHT, "bredow2002"), shade(*surface, "skin1", LIGHT, "lambert")
    )
