"""The multipole."""

import dataclasses

import numpy as np
import pytest

from lutcore.baking import bake
from lutcore.diffusion import DiffusionProfile, Optics, diffusion_profile, optics
from lutcore.errors import ParameterError
from lutcore.materials import material

DIPOLE = diffusion_profile("jensen2001")


def slab(thickness: float) -> DiffusionProfile:
    return diffusion_profile("donner-jensen2005", thickness=thickness)


def transformed(q: float, thickness: float, channel: Optics) -> float:
    """Solve the diffusion equation of the slab for one spatial frequency q, without images.

    phi'' = kappa^2 phi but for a source at depth 1, phi = 0 at -z_b and thickness + z_b: the flux
    that leaves at 0, D phi', in the classical form of Green's function.
    """
    kappa = np.sqrt(channel.beta**2 + q * q)
    z_b = 0.5 * (channel.depth - 1.0)
    whole = thickness + 2.0 * z_b
    deep = np.sinh(kappa * (thickness + z_b - 1.0)) / np.sinh(kappa * whole)
    return float(channel.albedo * deep * np.cosh(kappa * z_b))


@pytest.mark.parametrize("thickness", [1.0, 3.0, 8.0])
@pytest.mark.parametrize("albedo", [0.7, 0.99, 0.99999])
def test_it_solves_the_diffusion_equation_of_the_slab(thickness: float, albedo: float) -> None:
    from scipy.integrate import quad
    from scipy.special import j0

    channel = Optics(albedo, 1.3)
    profile = slab(thickness)
    assert profile.total(channel) == pytest.approx(transformed(0.0, thickness, channel), rel=1e-12)
    for r in (0.3, 2.0, 7.0):
        truth = quad(
            lambda q, r=r: q * j0(q * r) * transformed(q, thickness, channel) / (2.0 * np.pi),
            0.0,
            40.0,
            epsabs=1e-13,
            limit=400,
        )[0]
        # Above q = 40 the transform is below exp(-40).
        assert profile.radial(np.array([r]), channel)[0] == pytest.approx(truth, abs=1e-11)


@pytest.mark.parametrize("name", ["skin1", "marble", "ketchup"])
def test_a_thick_slab_is_the_dipole(name: str) -> None:
    r = np.geomspace(1e-2, 30.0, 20)
    for channel in optics(material(name)):
        thick = slab(200.0 * channel.mean_free_path / channel.beta)
        np.testing.assert_allclose(thick.radial(r, channel), DIPOLE.radial(r, channel), rtol=1e-12)
        np.testing.assert_allclose(
            thick.line_spread(r, channel), DIPOLE.line_spread(r, channel), rtol=1e-12
        )
        assert thick.total(channel) == pytest.approx(DIPOLE.total(channel), rel=1e-12)


def test_a_thinner_slab_reflects_less_and_glows_less_far() -> None:
    tables = [bake("marble", profile=slab(thickness)) for thickness in (2.0, 5.0, 20.0, 200.0)]
    totals = np.array([table.total for table in tables])
    assert (np.diff(totals, axis=0) > 0.0).all()
    glow = np.array([table.psi[:, 0] for table in tables])
    assert (np.diff(glow, axis=0) > 0.0).all()


def test_without_absorption_it_lets_through_what_it_does_not_reflect() -> None:
    # The fluence falls straight from the source, 1 deep, to 0 at -z_b and at d + z_b.
    channel = Optics(1.0, 1.3)
    z_b = 0.5 * (channel.depth - 1.0)
    for thickness in (1.0, 4.0, 100.0):
        expected = 1.0 - (1.0 + z_b) / (thickness + 2.0 * z_b)
        assert slab(thickness).total(channel) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("albedo", [0.5, 0.99, 0.99999, 1.0])
def test_more_dipoles_change_nothing(albedo: float, monkeypatch: pytest.MonkeyPatch) -> None:
    channel, r = Optics(albedo, 1.3), np.geomspace(1e-2, 30.0, 20)
    profile = slab(1.0)
    before = profile.radial(r, channel)
    monkeypatch.setattr("plugins.profile.donner_jensen2005._LEFT_OUT", 1e-24)
    # Twice as many; without absorption the stated 1e-9 of R(0).
    assert np.abs(profile.radial(r, channel) - before).max() < 1e-9 * before[0]


def test_the_thickness_is_in_millimetres() -> None:
    channel = Optics(0.99, 1.3)
    half = dataclasses.replace(channel, mean_free_path=0.5)
    assert slab(2.0).total(channel) == slab(1.0).total(half)


def test_a_slab_thinner_than_the_mean_free_path_is_refused() -> None:
    with pytest.raises(ParameterError, match="mean free path"):
        bake("chicken1", profile=slab(2.0))
    with pytest.raises(ParameterError, match="thickness"):
        slab(0.0)
