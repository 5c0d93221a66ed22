"""The exact quadratic patch, against shapes it must agree with; see also test_monge."""

import numpy as np
import pytest

from lutcore.exitance import shade
from lutcore.lights import DirectionalLight
from lutcore.materials import material
from tests.quadrature import sphere_exitance
from tests.surfaces import bent, sphere


def test_it_is_nearer_to_a_large_sphere_than_the_first_order() -> None:
    from lutcore.diffusion import optics

    cosines = np.linspace(-1.0, 1.0, 41)
    constants = optics(material("skin1"))[0]
    errors = {}
    for radius in (10.0, 20.0):  # l_d
        truth = sphere_exitance(cosines, radius / constants.beta, constants)
        surface = sphere(cosines, radius / constants.beta * constants.mean_free_path)
        for model, parameters in (
            ("monge-patch", {}),
            ("curvature-lut", {"hinges": 16, "area": "flat"}),
        ):
            light = [DirectionalLight((0.0, 0.0, 1.0))]
            shaded = shade(*surface, "skin1", light, model, **parameters)[:, 0]
            errors[model, radius] = np.abs(shaded - truth).max()
    assert errors["monge-patch", 10.0] < 0.1 * errors["curvature-lut", 10.0]
    # A sphere differs from its parabola at fourth order; the first order ends at the second.
    assert errors["monge-patch", 10.0] > 8.0 * errors["monge-patch", 20.0]


@pytest.mark.parametrize("height", [-0.2, 0.0, 0.05, 0.6])
def test_a_slight_bend_is_first_order(height: float) -> None:
    # Along and across a ridge, and on all between: second order is E2 < 1e-4 here.
    k1, k2 = np.full(5, 5e-3), np.array([0.0, 1e-3, 2.5e-3, 4e-3, 5e-3])
    for azimuth in (0.0, 0.4, 1.2, 0.5 * np.pi):
        light = [DirectionalLight((np.cos(azimuth), np.sin(azimuth), height))]
        exact = shade(*bent(k1, k2), "skin1", light, "monge-patch")
        parameters = {"hinges": 16, "area": "flat"}
        first = shade(*bent(k1, k2), "skin1", light, "curvature-lut", **parameters)
        # The hinges are within 6e-4.
        assert np.abs(exact - first).max() < 7e-4


def test_the_order_of_the_curvatures_does_not_matter() -> None:
    generator = np.random.default_rng(4)
    k1, k2 = generator.uniform(0.0, 1.0, (2, 50))
    here = shade(*bent(k1, k2), "skin1", [DirectionalLight((0.7, 0.2, 0.1))], "monge-patch")
    there = shade(*bent(k2, k1), "skin1", [DirectionalLight((0.2, 0.7, 0.1))], "monge-patch")
    np.testing.assert_allclose(here, there, rtol=0.0, atol=1e-13)
