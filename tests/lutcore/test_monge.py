"""Quadratic patches and their table."""

import numpy as np
import pytest

from lutcore.baking import glowing
from lutcore.curvature import PrincipalCurvatures
from lutcore.diffusion import diffusion_profile, diffusion_profiles, optics
from lutcore.exitance import shade
from lutcore.fresnel import transmittance
from lutcore.lights import DirectionalLight
from lutcore.materials import material
from lutcore.mesh import TriangleMesh
from lutcore.monge import LIMIT
from lutcore.quadric import Radial, on_patch
from lutcore.revolution import on_paraboloid
from tests.quadrature import FloatArray, dipole
from tests.surfaces import bent

ABOVE = DirectionalLight((0.0, 0.0, 1.0))
DIPOLE = diffusion_profile("jensen2001")


def patches(sizes: FloatArray, seed: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return k1, k2 and unit vectors to the light: cylinders, near umbilics and all between."""
    generator = np.random.default_rng(seed)
    count = len(sizes)
    shape = generator.uniform(0.0, np.pi / 4.0, count) * generator.choice([0.0, 1.0, 1.0], count)
    azimuth = generator.uniform(0.0, np.pi / 2.0, count)
    azimuth[::4] = np.pi / 2.0 - 0.1 * azimuth[::4]  # along the ridge
    a = generator.uniform(-1.0, 1.0, count) * generator.choice([1.0, 0.3, 0.03], count)
    sine = np.sqrt(1.0 - a * a)
    w = np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), a], axis=1)
    return np.sqrt(2.0) * sizes * np.cos(shape), np.sqrt(2.0) * sizes * np.sin(shape), w


def lit_from(
    k1: FloatArray, k2: FloatArray, w: FloatArray
) -> tuple[TriangleMesh, PrincipalCurvatures]:
    """Return points of these curvatures to which light from the z axis comes from w."""
    # The reflection that takes z to w: its rows have w as their z components.
    v = np.array([0.0, 0.0, 1.0]) - w
    frames = np.eye(3) - 2.0 * v[:, :, None] * v[:, None, :] / np.sum(v * v, axis=1)[:, None, None]
    d1, d2, normals = np.moveaxis(frames, 1, 0)
    mesh = TriangleMesh(normals, [[0, 1, 2]])
    return mesh, PrincipalCurvatures(k1, k2, d1, d2, normals, np.zeros(len(k1)), 0.0)


@pytest.mark.parametrize("profile", diffusion_profiles())
@pytest.mark.parametrize("s", [0.01, 0.3, 2.0])
def test_equal_curvatures_are_a_paraboloid_of_revolution(profile: str, s: float) -> None:
    constants, chosen = optics(material("marble"))[0], diffusion_profile(profile)
    a = np.array([-1.0, -0.4, -0.02, 0.0, 0.02, 0.4, 1.0])
    sine = np.sqrt(1.0 - a * a)
    radial = Radial.of(chosen, constants)
    w = np.stack([0.6 * sine, 0.8 * sine, a], axis=1)
    found = on_patch(np.full((7, 2), s), w, radial, constants.eta)
    truth = on_paraboloid(a, s, chosen, constants)
    # Its panels have six nodes and its arcs sixteen.
    np.testing.assert_allclose(found, truth, rtol=0.0, atol=2e-5)


@pytest.mark.parametrize(
    ("k1", "k2", "w"),
    [(0.3, 0.0, (0.6, 0.8, 0.0)), (0.3, 0.1, (0.2, -0.8, 0.56)), (0.2, 0.05, (0.9, 0.3, -0.3))],
)
def test_a_patch_is_the_integral_over_the_plane_below_it(k1, k2, w) -> None:
    from scipy.integrate import dblquad

    constants = optics(material("skin1"))[0]
    w1, w2, w3 = np.array(w) / np.linalg.norm(w)

    def integrand(phi, r):
        x, y = r * np.cos(phi), r * np.sin(phi)
        slope = w3 + k1 * w1 * x + k2 * w2 * y  # c dA/(dx dy)
        if slope <= 0.0:
            return 0.0
        c = min(slope / np.sqrt(1.0 + (k1 * x) ** 2 + (k2 * y) ** 2), 1.0)
        distance = np.hypot(r, 0.5 * (k1 * x * x + k2 * y * y))
        return r * dipole(np.array([distance]), constants)[0] * slope * transmittance(c, 1.3)

    bounds = (0.0, 2.0 * np.pi)
    panels = ((0.0, 3.0), (3.0, 40.0))
    truth = sum(dblquad(integrand, *r, *bounds, epsabs=1e-6, epsrel=1e-6)[0] for r in panels)
    radial = Radial.of(DIPOLE, constants)
    found = on_patch(np.array([[k1, k2]]), np.array([[w1, w2, w3]]), radial, 1.3)[0]
    assert found == pytest.approx(truth / DIPOLE.total(constants), abs=1e-5)


@pytest.mark.parametrize("name", ["skin1", "ketchup"])
@pytest.mark.parametrize(("size", "bound"), [(0.1, 1e-4), (0.5, 2e-3), (10.0, 1e-2)])
def test_the_table_is_within_its_stated_error(name: str, size: float, bound: float) -> None:
    count = 60
    for channel, exact in enumerate(optics(material(name))):
        constants = glowing(exact)
        sizes = np.full(count, min(size * constants.beta, LIMIT))
        k1, k2, w = patches(sizes, 7 + channel)
        radial = Radial.of(DIPOLE, constants)
        truth = on_patch(np.stack([k1, k2], axis=1), w, radial, constants.eta)
        per_mm = 1.0 / material(name).mean_free_path[channel]
        surface = lit_from(k1 * per_mm, k2 * per_mm, w)
        shaded = shade(*surface, name, [ABOVE], "monge-patch")[:, channel]
        found = shaded / DIPOLE.total(exact)
        assert np.abs(found - truth).max() < bound


def test_beyond_its_limit_a_patch_keeps_its_shape() -> None:
    k = LIMIT / material("skin1").mean_free_path[0] * np.array([1.0, 30.0, 1e9])
    light = [DirectionalLight((0.3, 0.5, 0.2))]
    shaded = shade(*bent(2.0 * k, k), "skin1", light, "monge-patch")[:, 0]
    np.testing.assert_allclose(shaded, shaded[0], rtol=1e-12)
