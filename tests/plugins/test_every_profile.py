"""What every diffusion profile must do; a new one is tested by being registered."""

from itertools import pairwise

import numpy as np
import pytest

from app.cli.main import main
from lutcore.baking import BETA_FLOOR, bake
from lutcore.diffusion import (
    DiffusionProfile,
    Optics,
    diffusion_profile,
    diffusion_profiles,
    optics,
)
from lutcore.exitance import shade
from lutcore.fresnel import mean_transmittance
from lutcore.lights import DirectionalLight, PointLight
from lutcore.lut import even_form
from lutcore.materials import material, materials
from lutcore.shading import model_registry, shading_models
from tests.surfaces import sphere, torus

PROFILES = diffusion_profiles()
LOCAL = [name for name in shading_models() if model_registry.get(name).local]
MATERIALS = ["skin1", "marble", "ketchup"]
# quad is asked for 1e-11; sums of its pieces keep a digit less.
QUADRATURE = 1e-10


def channels(*names: str) -> list[Optics]:
    return [channel for name in names for channel in optics(material(name))]


def integral(profile: DiffusionProfile, channel: Optics, weight: object, low: float) -> float:
    """Integrate R(r) weight(r) dr from `low` to where R ends, adaptively in log r."""
    from scipy.integrate import quad

    def integrand(v: float) -> float:
        r = np.exp(v)
        return float(profile.radial(np.array([r]), channel)[0] * weight(r) * r)  # type: ignore[operator]

    ends = np.unique(np.append(np.arange(np.log(max(low, 1e-13)), np.log(2e4), 2.0), np.log(2e4)))
    pieces = [quad(integrand, a, b, epsabs=1e-16, epsrel=1e-11)[0] for a, b in pairwise(ends)]
    return float(sum(pieces))


@pytest.mark.parametrize("name", PROFILES)
def test_the_radial_profile_is_positive_and_falls(name: str) -> None:
    profile = diffusion_profile(name)
    for channel in channels(*materials()):
        r = np.geomspace(1e-3, 30.0, 200)
        R = profile.radial(r, channel)
        assert (R > 0.0).all()
        assert (np.diff(R) <= 1e-15 * R[0]).all()


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize("x", [0.02, 0.7, 5.0])
def test_the_line_spread_is_the_radial_profile_seen_edge_on(name: str, x: float) -> None:
    profile = diffusion_profile(name)
    for channel in channels(*MATERIALS):
        # dy = r dr/y, and y = sqrt(r^2 - x^2) makes the end at r = x smooth.
        from scipy.integrate import quad

        def across(v: float, channel: Optics = channel) -> float:
            y = np.exp(v)
            return float(2.0 * profile.radial(np.array([np.hypot(x, y)]), channel)[0] * y)

        truth = sum(
            quad(across, a, a + 2.0, epsabs=1e-16, epsrel=1e-11)[0] for a in np.arange(-26, 10, 2)
        )
        found = profile.line_spread(np.array([x]), channel)[0]
        assert found == pytest.approx(truth, rel=QUADRATURE)


@pytest.mark.parametrize("name", PROFILES)
def test_reflectance_and_second_moment_are_those_of_the_radial_profile(name: str) -> None:
    profile = diffusion_profile(name)
    for channel in channels(*MATERIALS):
        total = integral(profile, channel, lambda r: 2.0 * np.pi * r, 0.0)
        square = integral(profile, channel, lambda r: 2.0 * np.pi * r**3, 0.0)
        assert profile.total(channel) == pytest.approx(total, rel=QUADRATURE)
        assert profile.mean_square(channel) == pytest.approx(square / total, rel=QUADRATURE)


@pytest.mark.parametrize("name", PROFILES)
def test_psi_is_the_double_integral_over_the_dark_side(name: str) -> None:
    # R_d psi(u) = int (x - u) R dA over x > u; the angle done by hand, with x = r cos(angle) > u.
    profile = diffusion_profile(name)
    for substance in MATERIALS:
        table = bake(substance, profile=profile)
        for index, channel in enumerate(optics(material(substance))):
            for u in (0.0, 0.03, 0.5, 4.0):

                def beyond(r: float, u: float = u) -> float:
                    angle = np.arccos(min(u / r, 1.0))
                    return float(2.0 * r * (r * np.sin(angle) - u * angle))

                truth = integral(profile, channel, beyond, u) / profile.total(channel)
                found = even_form(-u, 1.0, table.rows, table.inverse_step, index)
                assert found == pytest.approx(truth, abs=1e-6), (substance, index, u)


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize("substance", materials())
def test_psi_is_positive_and_falls_to_nothing(name: str, substance: str) -> None:
    table = bake(substance, profile=name)
    assert (table.psi >= 0.0).all()
    assert (np.diff(table.psi, axis=1) < 0.0).all()
    np.testing.assert_array_equal(table.psi[:, -1], 0.0)
    # psi'(0) = -L0(0)/R_d: half of the light lands on each side.
    np.testing.assert_allclose(table.slope[:, 0], -0.5, rtol=1e-8)


@pytest.mark.parametrize("name", PROFILES)
def test_reflectance_grows_with_the_albedo_and_never_exceeds_one(name: str) -> None:
    profile = diffusion_profile(name)
    for eta in (1.0, 1.3, 1.5, 2.0):
        albedos = [1e-6, 1e-3, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0 - 1e-9, 1.0]
        totals = np.array([profile.total(Optics(albedo, eta)) for albedo in albedos])
        assert (totals > 0.0).all()
        assert (np.diff(totals) > 0.0).all()
        # The exact albedo of a half-space is solved to 1e-10.
        assert totals[-1] <= 1.0 + 1e-9
        # Nearly no scattering, nearly no light: at most as much as is scattered once.
        assert totals[0] < 1e-6


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize("albedo", [1e-6, 0.5, 1.0 - BETA_FLOOR**2 / 3.0])
def test_the_extremes_of_albedo_have_a_glow(name: str, albedo: float) -> None:
    profile, channel = diffusion_profile(name), Optics(albedo, 1.3)
    reach = profile.reach(channel)
    L0, L1 = profile.tails(np.sinh(np.linspace(0.0, np.arcsinh(reach), 64)), channel)
    assert np.isfinite(reach)
    assert L0[0] == pytest.approx(0.5 * profile.total(channel), rel=1e-7)
    assert 0.0 < L1[0] < profile.total(channel) * np.sqrt(profile.mean_square(channel))


@pytest.mark.parametrize("name", PROFILES)
def test_without_absorption_the_table_is_finite(name: str) -> None:
    table = bake("spectralon", profile=name)
    assert table.floored.all()
    assert (table.total > 0.9).all()
    assert np.isfinite(table.psi).all()


@pytest.mark.parametrize("name", PROFILES)
def test_a_profile_is_the_key_of_its_table(name: str) -> None:
    assert bake("skin1", profile=name) is bake("skin1", profile=diffusion_profile(name))
    assert bake("skin1", profile=name).samples == diffusion_profile(name).knots


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize("model", LOCAL)
def test_every_local_model_works_with_it(name: str, model: str) -> None:
    lights = [DirectionalLight((1.0, 0.3, 0.5)), PointLight((-60.0, 20.0, 40.0), 3000.0)]
    shaded = shade(*torus(400), "skin1", lights, model, profile=name)
    assert np.isfinite(shaded).all()
    assert (shaded >= 0.0).all()
    assert (shaded.max(axis=0) > 0.01).all()


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize("model", ["kolchin2007", "kolchin2007-simplified", "lambert"])
def test_a_flat_surface_reflects_what_the_profile_says(name: str, model: str) -> None:
    cosines = np.linspace(0.0, 1.0, 11)
    light = [DirectionalLight((0.0, 0.0, 1.0))]
    shaded = shade(*sphere(cosines, np.inf), "skin1", light, model, profile=name)
    totals = [diffusion_profile(name).total(channel) for channel in channels("skin1")]
    np.testing.assert_allclose(
        shaded, np.outer(cosines * mean_transmittance(1.3), totals), rtol=1e-12, atol=1e-15
    )


@pytest.mark.parametrize("name", PROFILES)
def test_its_parameters_are_flags_that_collide_with_no_other(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    for command in ("shade", "figure", "compare", "lut"):
        assert main([command, "--profile", name, "--help"]) == 0
        assert "--profile" in capsys.readouterr().out
