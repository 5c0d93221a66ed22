"""Pre-integrated skin shading, against quadrature of the ring."""

import numpy as np
import pytest

from lutcore.baking import bake, glowing
from lutcore.diffusion import DiffusionProfile, Optics, diffusion_profile, optics
from lutcore.exitance import shade
from lutcore.fresnel import mean_transmittance
from lutcore.lights import DirectionalLight
from lutcore.materials import material
from plugins.shading.penner2011 import ring_table
from tests import numpy_shading
from tests.surfaces import bent, sphere

FloatArray = numpy_shading.FloatArray
ABOVE = [DirectionalLight((0.0, 0.0, 1.0))]


def ring(a: FloatArray, s: float, profile: DiffusionProfile, constants: Optics) -> FloatArray:
    """Return D(theta, r) by the trapezoidal rule in v, x = s sinh(v); s = l_u/r."""
    v = np.linspace(0.0, np.arcsinh(np.pi / s), 20_001)
    x, weight = s * np.sinh(v), np.cosh(v)
    weight[[0, -1]] *= 0.5
    weight *= profile.radial(np.hypot(2.0 / s * np.sin(0.5 * x), 0.01), constants)
    theta = np.arccos(a)[:, None]
    lit = np.maximum(np.cos(theta + x), 0.0) + np.maximum(np.cos(theta - x), 0.0)
    blurred: FloatArray = 0.5 * (lit @ weight) / weight.sum()
    return blurred


@pytest.mark.parametrize(("profile", "bound"), [("jensen2001", 1e-5), ("burley2015", 6e-5)])
@pytest.mark.parametrize("name", ["skin1", "ketchup", "spectralon"])
def test_the_table_is_within_its_stated_error(profile: str, name: str, bound: float) -> None:
    a = np.concatenate((-np.geomspace(1.0, 1e-4, 12), [0.0], np.geomspace(1e-4, 1.0, 12)))
    chosen = diffusion_profile(profile)
    for constants in map(glowing, optics(material(name))):
        table = ring_table(constants, chosen)
        for s in (3e-5, 7e-4, 0.011, 0.13, 1.7, 17.0):
            found = numpy_shading.bent(a, np.full(25, s), table)
            assert np.abs(found - ring(a, s, chosen, constants)).max() < bound


def test_shading_reads_the_ring_of_the_mean_convex_curvature() -> None:
    k1, k2 = np.array([0.2, 0.3, 0.4, -0.5]), np.array([0.2, 0.1, -1.0, -0.5])
    mean = np.array([0.2, 0.2, 0.2, 0.0])
    light = [DirectionalLight((0.3, 0.4, 0.1))]
    shaded = shade(*bent(k1, k2), "skin1", light, "penner2011")
    np.testing.assert_allclose(shaded[:3], np.tile(shaded[0], (3, 1)), rtol=1e-12)
    cosine = np.array([0.1 / np.sqrt(0.26)])
    for channel, constants in enumerate(optics(material("skin1"))):
        s = mean[0] * constants.mean_free_path
        total = bake("skin1").total[channel] * mean_transmittance(1.3)
        truth = total * ring(cosine, s, diffusion_profile("jensen2001"), constants)[0]
        assert shaded[0, channel] == pytest.approx(truth, abs=1e-5)
        assert shaded[3, channel] == pytest.approx(total * cosine[0], rel=1e-12)


def test_a_tiny_ball_is_evenly_lit_and_its_colour_ends_at_the_limit() -> None:
    cosines = np.linspace(-1.0, 1.0, 21)
    length = material("skin1").mean_free_path[0]
    total = bake("skin1").total[0] * mean_transmittance(1.3)
    at, beyond = (
        shade(*sphere(cosines, length / s), "skin1", ABOVE, "penner2011")[:, 0] for s in (20.0, 1e6)
    )
    np.testing.assert_allclose(at, beyond, rtol=1e-12)
    # The mean of max(cos, 0) around a ring; within .1 l_u the profile falls by 2 %.
    np.testing.assert_allclose(at, total / np.pi, rtol=0.02)
