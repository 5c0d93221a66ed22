"""Lambert, against plain NumPy."""

import numpy as np

from lutcore.baking import bake
from lutcore.exitance import shade
from lutcore.fresnel import transmittance
from lutcore.lights import DirectionalLight
from tests import numpy_shading
from tests.bench.shading_speed import LIGHTS
from tests.surfaces import sphere, torus


def test_the_mean_form() -> None:
    surface = torus(1000)
    np.testing.assert_allclose(
        shade(*surface, "marble", LIGHTS, "lambert"),
        numpy_shading.lambert(*surface, "marble", LIGHTS),
        rtol=1e-12,
    )


def test_facing_light_the_mean_form_is_r_d_times_the_mean_transmittance() -> None:
    shaded = shade(*sphere(np.ones(3), 5.0), "skin1", [DirectionalLight((0, 0, 2))], "lambert")
    # R_d = alpha'/2 (exp(-beta) + exp(-B beta)) and <F_t> = .93887 for eta 1.3, by hand.
    alpha, beta = 0.74 / 0.772, np.sqrt(3.0 * 0.032 / 0.772)
    reflectance = 0.5 * alpha * (np.exp(-beta) + np.exp(-4.46944 * beta))
    np.testing.assert_allclose(shaded[0, 0], 0.938868 * reflectance, rtol=1e-5)


def test_the_directional_form() -> None:
    cosines = np.linspace(-1.0, 1.0, 41)
    light = DirectionalLight((0.0, 0.0, 1.0), (1.0, 2.0, 3.0))
    shaded = shade(*sphere(cosines, 5.0), "skin1", [light], "lambert", fresnel="directional")
    lit = np.maximum(cosines, 0.0)
    expected = np.outer(lit * transmittance(lit, 1.3), bake("skin1").total * [1.0, 2.0, 3.0])
    np.testing.assert_allclose(shaded, expected, rtol=0.0, atol=1e-14)
