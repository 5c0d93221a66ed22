"""The normalised profile."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import k0

from lutcore.diffusion import Optics, diffusion_profile, optics
from lutcore.halfspace import h_function
from lutcore.materials import material

PROFILE = diffusion_profile("burley2015")


def scale(albedo: float) -> float:
    return 1.9 - albedo + 3.5 * (albedo - 0.8) ** 2


def test_the_share_inside_a_radius_is_equation_11() -> None:
    for channel in optics(material("skin1")):
        A = PROFILE.total(channel)
        s = scale(A)
        for radius in (0.1, 1.0, 5.0):
            inside = quad(
                lambda r, channel=channel: (
                    2.0 * np.pi * r * float(PROFILE.radial(np.array([r]), channel)[0])
                ),
                1e-14,
                radius,
                epsabs=1e-13,
            )[0]
            expected = 1.0 - 0.25 * np.exp(-s * radius) - 0.75 * np.exp(-s * radius / 3.0)
            assert inside / A == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("albedo", [0.3, 0.9, 0.999])
def test_without_a_boundary_the_albedo_is_chandrasekhars(albedo: float) -> None:
    # Radiative Transfer, chapter V: 1 - 2 sqrt(1 - albedo) int H mu dmu of diffuse light.
    first = quad(lambda mu: float(h_function(mu, albedo)) * mu, 0.0, 1.0, epsabs=1e-12)[0]
    expected = 1.0 - 2.0 * np.sqrt(1.0 - albedo) * first
    assert PROFILE.total(Optics(albedo, 1.0)) == pytest.approx(expected, abs=1e-8)


def test_the_second_moment_is_fourteen_lengths_squared() -> None:
    for channel in optics(material("marble")):
        s = scale(PROFILE.total(channel))
        assert PROFILE.mean_square(channel) == pytest.approx(14.0 / s**2, rel=1e-12)


def test_the_glow_at_the_terminator() -> None:
    for channel in optics(material("ketchup")):
        s = scale(PROFILE.total(channel))
        knots = np.sinh(np.linspace(0.0, np.arcsinh(PROFILE.reach(channel)), 64))
        L0, L1 = PROFILE.tails(knots, channel)
        # int_0^inf x (K0(s x) + K0(s x/3)) dx = 10/s^2.
        psi = L1[0] / PROFILE.total(channel)
        assert psi == pytest.approx(10.0 / (4.0 * np.pi * s), abs=1e-8)
        assert L0[0] == pytest.approx(0.5 * PROFILE.total(channel), rel=1e-8)


def test_the_tails_are_those_of_the_line_spread() -> None:
    channel = Optics(0.9, 1.3)
    A = PROFILE.total(channel)
    s = scale(A)
    end = PROFILE.reach(channel)
    knots = np.array([0.01, 0.5, 3.0, end])
    L0, L1 = PROFILE.tails(knots, channel)
    for knot, zeroth, first in zip(knots[:3], L0, L1, strict=False):
        for power, found in ((0, zeroth), (1, first)):
            truth = quad(
                lambda x, power=power: x**power * (k0(s * x) + k0(s * x / 3.0)),
                knot,
                end,
                epsabs=1e-13,
                limit=200,
            )[0]
            assert found == pytest.approx(A * s / (4.0 * np.pi) * truth, abs=1e-10)


def test_a_searchlight_spreads_less_than_light_from_all_sides() -> None:
    straight = diffusion_profile("burley2015", source="searchlight")
    for channel in optics(material("skin1")):
        A = PROFILE.total(channel)
        assert straight.total(channel) == A
        s = 1.85 - A + 7.0 * abs(A - 0.8) ** 3
        assert straight.mean_square(channel) == pytest.approx(14.0 / s**2, rel=1e-12)
