"""The curvature-dependent reflectance function, against its Fourier series."""

import numpy as np
import pytest

from lutcore.baking import bake
from lutcore.exitance import shade
from lutcore.fresnel import mean_transmittance
from lutcore.lights import DirectionalLight
from plugins.shading.kubo2010 import gaussian_table
from tests import numpy_shading
from tests.surfaces import bent

FloatArray = numpy_shading.FloatArray


def series(theta: FloatArray, sigma: float) -> FloatArray:
    """Return max(cos, 0) blurred by a Gaussian: each harmonic n falls by exp(-n^2 sigma^2/2)."""
    n = np.arange(1, 4000)
    falling = np.exp(-2.0 * (n * sigma) ** 2)
    even = -2.0 / np.pi * (-1.0) ** n / (4.0 * n**2 - 1.0) * falling
    blurred: FloatArray = 1.0 / np.pi + np.cos(2.0 * theta[:, None] * n) @ even
    return blurred + 0.5 * np.cos(theta) * np.exp(-0.5 * sigma**2)


@pytest.mark.parametrize("sigma", [0.0101, 0.07, 0.5, 1.3, 3.9])
def test_the_table_is_within_its_stated_error(sigma: float) -> None:
    theta = np.linspace(0.0, np.pi, 721)
    found = numpy_shading.bent(np.cos(theta), np.full(721, sigma), gaussian_table())
    assert np.abs(found - series(theta, sigma)).max() < 1e-5


def test_the_width_is_that_of_the_profile_in_radians() -> None:
    table = bake("skin1")
    light = [DirectionalLight((0.8, 0.0, 0.6))]
    k = np.array([0.1, 0.1, 0.1])
    shaded = shade(*bent(k, k), "skin1", light, "kubo2010")[0]
    for channel in range(3):
        sigma = 0.1 * table.mean_free_path[channel] * np.sqrt(0.5 * table.mean_square[channel])
        truth = series(np.array([np.arccos(0.6)]), sigma)[0]
        scale = table.total[channel] * mean_transmittance(1.3)
        assert shaded[channel] == pytest.approx(scale * truth, abs=1e-5)
