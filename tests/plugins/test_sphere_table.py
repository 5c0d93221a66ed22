"""The exact sphere, against the dipole integrated over it."""

import numpy as np
import pytest

from lutcore.baking import glowing
from lutcore.diffusion import diffusion_profile, diffusion_profiles, optics
from lutcore.exitance import shade
from lutcore.lights import DirectionalLight
from lutcore.materials import material
from lutcore.revolution import on_sphere
from plugins.shading.sphere_table import sphere_table
from tests import numpy_shading
from tests.quadrature import sphere_exitance
from tests.surfaces import bent, sphere

ABOVE = [DirectionalLight((0.0, 0.0, 1.0))]


@pytest.mark.parametrize("name", ["skin1", "ketchup"])
@pytest.mark.parametrize("ratio", [0.3, 1.0, 2.0, 10.0, 100.0])
def test_it_is_the_dipole_on_the_sphere(name: str, ratio: float) -> None:
    cosines = np.concatenate((np.linspace(-1.0, 1.0, 21), [-0.01, 0.003]))
    for channel, constants in enumerate(optics(material(name))):
        radius = ratio / constants.beta
        truth = sphere_exitance(cosines, radius, constants)
        length = float(constants.mean_free_path)
        shaded = shade(*sphere(cosines, radius * length), name, ABOVE, "sphere-table")
        assert np.abs(shaded[:, channel] - truth).max() < 2e-6


@pytest.mark.parametrize("profile", diffusion_profiles())
def test_the_table_is_within_its_stated_error(profile: str) -> None:
    a = np.concatenate((-np.geomspace(1.0, 1e-4, 12), [0.0], np.geomspace(1e-4, 1.0, 12)))
    chosen = diffusion_profile(profile)
    for name in ("marble", "spectralon"):
        constants = glowing(optics(material(name))[0])
        table = sphere_table(constants, chosen)
        for s in (3e-5, 7e-4, 0.011, 0.13, 1.7, 17.0):
            found = numpy_shading.bent(a, np.full(25, s), table, constants.eta)
            assert np.abs(found - on_sphere(a, s, chosen, constants)).max() < 2e-6


def test_it_takes_the_mean_convex_curvature() -> None:
    k1, k2 = np.array([0.2, 0.3, 0.4]), np.array([0.2, 0.1, -1.0])
    shaded = shade(*bent(k1, k2), "skin1", [DirectionalLight((0.3, 0.4, 0.1))], "sphere-table")
    np.testing.assert_allclose(shaded, np.tile(shaded[0], (3, 1)), rtol=1e-12)
