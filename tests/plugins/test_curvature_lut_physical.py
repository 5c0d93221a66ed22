"""The physical model against the random walk, NumPy, exact albedo and the incident light."""

import numpy as np
import pytest
from numpy.typing import NDArray

from lutcore.baking import bake
from lutcore.curvature import PrincipalCurvatures
from lutcore.diffusion import Optics, optics
from lutcore.exitance import shade
from lutcore.fresnel import hinges, transmittance
from lutcore.halfspace import flat_albedo
from lutcore.lights import DirectionalLight
from lutcore.materials import Material, material, materials
from lutcore.walk.bodies import sphere as ball
from lutcore.walk.exitance import walk
from plugins.shading.curvature_lut_physical import _curved
from tests.bench.shading_truth import DIPOLE, STRAIGHT, errors
from tests.numpy_shading import even_form
from tests.surfaces import sphere, torus
from tests.walk_truth import CASES, Case

FloatArray = NDArray[np.float64]
PHYSICAL = "curvature-lut-physical"
ABOVE = DirectionalLight((0.0, 0.0, 1.0))


def case(shape: str, name: str, channel: int, ratio: int) -> Case:
    """Return a case of the stored truth."""
    wanted = (shape, name, channel, ratio)
    return next(c for c in CASES if (c.shape, c.material, c.channel, c.ratio) == wanted)


def physical(chosen: Case, **parameters: object) -> float:
    """Return the model's error in one case, per cent."""
    return errors(chosen, {PHYSICAL: (PHYSICAL, parameters)})[PHYSICAL]


# Per cent by size in l_d; asked are 6.3 and, as an attempt, 3 at 5, 3.1 at 10, 1.5 from 20 up.
@pytest.mark.parametrize(("ratio", "most"), [(2, 7.0), (5, 0.8), (10, 0.3), (20, 0.3), (50, 0.3)])
def test_the_walk_is_met_on_spheres(ratio: int, most: float) -> None:
    assert physical(case("sphere", "skin1", 0, ratio)) < most


@pytest.mark.parametrize("profile", ["jensen2001", "deon2012"])
@pytest.mark.parametrize("shape", ["sphere", "cylinder", "oblique cylinder", "ellipsoid"])
def test_what_remains_is_of_second_order(shape: str, profile: str) -> None:
    five, ten, twenty = (
        physical(case(shape, "skin1", 0, ratio), profile=profile, hinges=8) for ratio in (5, 10, 20)
    )
    # Halved curvature quarters it, or nearly; .1 is what the stored walk resolves.
    assert ten < 0.4 * five + 0.1
    assert twenty < 0.4 * ten + 0.1


@pytest.mark.parametrize("shape", ["cylinder", "oblique cylinder"])
def test_the_walk_is_met_on_cylinders(shape: str) -> None:
    found = [physical(case(shape, "skin1", 0, ratio)) for ratio in (5, 10, 20)]
    assert (np.array(found) < [1.0, 0.3, 0.3]).all()


def test_the_walk_is_met_where_light_wanders_far_and_where_it_does_not() -> None:
    assert physical(case("sphere", "marble", 1, 5)) < 0.4
    assert physical(case("sphere", "skin1", 2, 10)) < 1.0


def test_without_absorption_the_body_ends_the_glow() -> None:
    # 30 mean free paths across, l_d being infinite: `curvature-lut` is 37 % off.
    medium = Optics(1.0, 1.3)
    run = walk(ball(30.0), (0.0, 0.0, 1.0), medium, 20_000, 20, seed=1)
    x, weights = np.polynomial.legendre.leggauss(8)
    cosines = (np.arange(20)[:, None] + 0.5 * (x + 1.0)) / 10.0 - 1.0
    white = Material("white", (1.0, 1.0, 1.0), (0.0, 0.0, 0.0), 1.3)
    shaded = shade(*sphere(cosines.ravel(), 30.0), white, [ABOVE], PHYSICAL)[:, 1]
    means = shaded.reshape(20, 8) @ (0.5 * weights)
    truth, error = run.exitance[:, 0], run.error[:, 0]
    square = np.sum((means - truth) ** 2 - error**2) / np.sum(truth**2)
    # 2.7 % by a longer walk; the scatter of this one, 4 %, is taken out but leaves 1 % or so.
    assert square < 0.05**2


# Known from an independent walk and integration, per cent at 1, 2, 5, 10, 20 and 50 l_d.
@pytest.mark.parametrize(
    ("ratio", "paper", "dipole", "straight"),
    [(2, 20.0, 28.0, 17.0), (5, 14.0, 15.0, 6.3), (10, 11.0, 10.0, 3.1), (20, 9.0, 7.0, 1.5)],
)
def test_other_errors_are_the_known_ones(
    ratio: int, paper: float, dipole: float, straight: float
) -> None:
    found = errors(case("sphere", "skin1", 0, ratio), {"paper": ("kolchin2007", {})})
    assert found["paper"] == pytest.approx(paper, rel=0.1)
    assert found[DIPOLE] == pytest.approx(dipole, rel=0.1)
    assert found[STRAIGHT] == pytest.approx(straight, rel=0.1)


def in_numpy(
    curvatures: PrincipalCurvatures, light: DirectionalLight, name: str, channel: int
) -> FloatArray:
    """Return the model's formula from principal curvatures and directions, in units of l_u."""
    table, medium = bake(name), optics(material(name))[channel]
    length = float(material(name).mean_free_path[channel])
    k1, k2 = (np.maximum(k, 0.0) * length for k in (curvatures.k1, curvatures.k2))
    w = np.asarray(light.direction)
    w1, w2 = curvatures.d1 @ w, curvatures.d2 @ w
    kappa, bulge = np.hypot(w1 * k1, w2 * k2), k1 * w1**2 + k2 * w2**2
    beta, eta = medium.beta, medium.eta

    def displacement(c: FloatArray) -> tuple[FloatArray, FloatArray]:
        lit = np.clip(c, 0.0, 1.0)
        g = 1.0 / (eta * (1.0 + beta * np.sqrt(1.0 - (1.0 - lit**2) / eta**2)))
        return lit, g / np.sqrt(1.0 + g**2 * (k1**2 + k2**2))

    cosine = curvatures.normals @ w
    g = displacement(cosine)[1]
    entry = (cosine + g * bulge) / np.sqrt(1.0 + (g * kappa) ** 2)
    lit, g = displacement(entry)
    y = 2.0 * beta / (k1 + k2)
    x = 1.0 / np.tanh(y) - 1.0 / y
    wider = y * (y / x - 2.0 - y * x)
    flat = [Optics(1.0 - (beta * one) ** 2 / 3.0, eta) for one in x]
    rho = [flat_albedo(c, one) / one.albedo for c, one in zip(lit, flat, strict=True)]
    second = table.mean_square[channel] / 16.0 * (3.0 * k1**2 + 2.0 * k1 * k2 + 3.0 * k2**2)
    spread = (1.0 + g * lit * k1) * (1.0 + g * lit * k2)
    fit = hinges(eta, 4)
    glow = sum(
        weight * even_form(entry - corner, np.sqrt(wider) * kappa, table, channel)
        for corner, weight in zip(fit.corners, fit.weights, strict=True)
    )
    depth = 1.0 + beta * g**2 * bulge
    return np.asarray(
        medium.albedo * np.array(rho) * depth * glow / (spread * (1.0 + wider * second))
    )


@pytest.mark.parametrize("name", ["skin1", "marble"])
def test_it_is_the_formula(name: str) -> None:
    surface, light = torus(400), DirectionalLight((1.0, 0.3, 0.5))
    shaded = shade(*surface, name, [light], PHYSICAL)
    for channel in range(3):
        expected = in_numpy(surface[1], light, name, channel)
        # The polynomial that stands for 1/rho is good to 5e-4.
        np.testing.assert_allclose(shaded[:, channel], expected, rtol=5e-4, atol=1e-12)


@pytest.mark.parametrize("name", materials())
def test_a_flat_surface_has_its_exact_albedo(name: str) -> None:
    cosines = np.linspace(0.01, 1.0, 100)
    shaded = shade(*sphere(cosines, np.inf), name, [ABOVE], PHYSICAL, hinges=16)
    eta = material(name).eta[0]
    flat = cosines * transmittance(cosines, eta)
    for channel, medium in enumerate(optics(material(name))):
        rho = flat_albedo(cosines, medium)
        # The error of the hinges, and of the polynomial that stands for 1/rho.
        bound = rho * (hinges(eta, 16).error + 5e-4 * flat)
        assert (np.abs(shaded[:, channel] - rho * flat) <= bound).all()


@pytest.mark.parametrize("name", ["skin1", "cream", "spectralon"])
@pytest.mark.parametrize("profile", ["jensen2001", "deon2012"])
def test_never_more_leaves_a_sphere_than_enters(name: str, profile: str) -> None:
    x, weights = np.polynomial.legendre.leggauss(64)
    cosines = np.concatenate((0.5 * (x - 1.0), 0.5 * (x + 1.0)))
    weights = np.concatenate((weights, weights))
    lit = np.maximum(cosines, 0.0)
    eta = material(name).eta[0]
    entered = weights @ (lit * transmittance(lit, eta))
    slack = hinges(eta, 4).error * float(weights[lit > 0.0].sum())  # were it all of one sign
    for radius in np.geomspace(0.01, 1e4, 19):
        shaded = shade(*sphere(cosines, radius), name, [ABOVE], PHYSICAL, profile=profile)
        assert (weights @ shaded <= entered + slack).all()


@pytest.mark.parametrize("name", ["skin1", "marble", "cream", "ketchup"])
def test_a_higher_light_never_darkens_from_two_mean_free_paths_up(name: str) -> None:
    cosines = np.linspace(-1.0, 1.0, 401)
    for radius in (2.0, 3.0, 5.0, 20.0):
        for channel, length in enumerate(material(name).mean_free_path):
            shaded = shade(*sphere(cosines, radius * length), name, [ABOVE], PHYSICAL)
            assert (np.diff(shaded[:, channel]) >= -1e-6).all()  # psi between knots: 1e-6


@pytest.mark.parametrize("y", [0.01, 20.0])
def test_curved_diffusion_has_no_seam(y: float) -> None:
    below, above = (np.array(_curved(y * (1.0 + step))) for step in (-1e-9, 1e-9))
    # Both are increasing or flat with slopes below 1; the series is good to y^4.
    np.testing.assert_allclose(below, above, rtol=1e-8)


def test_an_index_matched_medium_is_shaded_too() -> None:
    cosines = np.linspace(-1.0, 1.0, 101)
    jelly = Material("jelly", (1.0, 1.0, 1.0), (0.0, 0.01, 1.0), 1.0)
    for radius in (5.0, np.inf):
        shaded = shade(*sphere(cosines, radius), jelly, [ABOVE], PHYSICAL)
        assert np.isfinite(shaded).all()
        assert (shaded >= 0.0).all()
        lit = np.maximum(cosines, 0.0)
        if radius == np.inf:
            rho = np.stack([flat_albedo(lit, medium) for medium in optics(jelly)], axis=1)
            # c F_t = c is one hinge; the polynomial is good to 2 % at an index of one.
            np.testing.assert_allclose(shaded, rho * lit[:, None], rtol=0.03, atol=1e-6)
