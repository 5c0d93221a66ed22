"""Diffusion profiles: closed forms against quadrature, also from a radial profile alone."""

from dataclasses import dataclass

import numpy as np
import pytest

from lutcore.arrays import FloatArray
from lutcore.diffusion import DiffusionProfile, Optics, optics, profile_registry
from lutcore.errors import ParameterError
from lutcore.materials import material
from tests.quadrature import dipole

ABSORBING = ["skin1", "marble", "cream", "ketchup"]


@dataclass(frozen=True)
class OnlyRadial(DiffusionProfile):
    """The dipole without its closed forms."""

    def radial(self, r: FloatArray, optics: Optics) -> FloatArray:
        return profile_registry.get("jensen2001")().radial(r, optics)


def test_the_dipole_is_found_by_name() -> None:
    assert "jensen2001" in profile_registry.names()


def test_the_dipole_is_its_equation_written_down_again() -> None:
    r = np.array([0.0, 0.1, 1.0, 3.0, 40.0])
    for channel in optics(material("skin1")):
        found = profile_registry.get("jensen2001")().radial(r, channel)
        np.testing.assert_allclose(found, dipole(r, channel), rtol=1e-14)


@pytest.mark.parametrize("name", ABSORBING)
def test_quadrature_of_the_radial_profile_gives_the_closed_forms(name: str) -> None:
    closed, general = profile_registry.get("jensen2001")(), OnlyRadial()
    x = np.array([0.0, 1e-6, 1e-3, 0.1, 0.7, 5.0, 20.0])
    for channel in optics(material(name)):
        # The trapezoidal rule is exact to rounding; far out a few digits go to the exponential.
        np.testing.assert_allclose(
            general.line_spread(x, channel), closed.line_spread(x, channel), rtol=1e-12
        )
        assert general.total(channel) == pytest.approx(closed.total(channel), rel=1e-13)
        assert general.mean_square(channel) == pytest.approx(closed.mean_square(channel), rel=1e-13)


@pytest.mark.parametrize("name", ABSORBING)
def test_first_tail_is_its_closed_form(name: str) -> None:
    from scipy.special import k0

    for channel in optics(material(name)):
        profile = profile_registry.get("jensen2001")()
        u = np.sinh(np.linspace(0.0, np.arcsinh(profile.reach(channel)), 64))
        L1 = sum(
            channel.albedo / (4.0 * np.pi) * 2.0 * z * k0(channel.beta * np.hypot(z, u))
            for z in (1.0, channel.depth)
        )
        np.testing.assert_allclose(profile.tails(u, channel)[1], L1, rtol=0.0, atol=1e-9)


def test_a_profile_without_end_is_refused() -> None:
    @dataclass(frozen=True)
    class Endless(DiffusionProfile):
        def radial(self, r: FloatArray, optics: Optics) -> FloatArray:
            return 1.0 / (1.0 + r) ** 2

    with pytest.raises(ParameterError, match="no end"):
        Endless().reach(Optics(0.9, 1.3))
