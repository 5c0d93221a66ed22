"""Diffusion profiles: closed forms against quadrature, also from a line spread alone."""

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
class OnlyLineSpread(DiffusionProfile):
    """The dipole without its closed forms."""

    def line_spread(self, x: FloatArray, optics: Optics) -> FloatArray:
        return profile_registry.get("jensen2001")().line_spread(x, optics)


def test_the_dipole_is_found_by_name() -> None:
    assert "jensen2001" in profile_registry.names()


@pytest.mark.parametrize("name", ABSORBING)
@pytest.mark.parametrize("x", [0.0, 0.7, 5.0])
def test_line_spread_is_the_profile_seen_edge_on(name: str, x: float) -> None:
    from scipy.integrate import quad

    for channel in optics(material(name)):

        def across(y: float, channel: Optics = channel) -> float:
            return float(dipole(np.array([np.hypot(x, y)]), channel)[0])

        truth = 2.0 * (quad(across, 0.0, 5.0)[0] + quad(across, 5.0, np.inf)[0])
        spread = profile_registry.get("jensen2001")().line_spread(np.array([x]), channel)[0]
        # quad's own tolerance, 1.5e-8 absolute, twice.
        assert spread == pytest.approx(truth, abs=6e-8)


@pytest.mark.parametrize("name", ABSORBING)
def test_closed_forms_equal_quadrature_of_the_line_spread(name: str) -> None:
    closed, general = profile_registry.get("jensen2001")(), OnlyLineSpread()
    for channel in optics(material(name)):
        # What lies beyond the reach: 1e-9 of R_d, and 1e-9 u^2 ~ 1e-7 of <r^2>.
        assert general.total(channel) == pytest.approx(closed.total(channel), rel=1e-8)
        assert general.mean_square(channel) == pytest.approx(closed.mean_square(channel), rel=1e-6)


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
        def line_spread(self, x: FloatArray, optics: Optics) -> FloatArray:
            return 1.0 / (1.0 + x)

    with pytest.raises(ParameterError, match="no end"):
        Endless().reach(Optics(0.9, 1.3))
