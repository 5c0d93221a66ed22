"""The better dipole."""

import numpy as np
import pytest

from lutcore.diffusion import Optics, diffusion_profile, optics
from lutcore.fresnel import internal_moments, internal_reflectance, transmittance
from lutcore.halfspace import flat_albedo
from lutcore.materials import material

PROFILE = diffusion_profile("deon2012")


def reflected(mu: float, eta: float) -> float:
    """Fresnel's reflectance of light that meets the surface from inside."""
    square = 1.0 - eta**2 * (1.0 - mu * mu)
    return 1.0 if square <= 0.0 else 1.0 - float(transmittance(np.sqrt(square), eta))


@pytest.mark.parametrize("eta", [1.0, 1.05, 1.3, 1.5, 2.5])
def test_the_moments_are_those_of_fresnels_reflectance(eta: float) -> None:
    from scipy.integrate import quad

    critical = np.sqrt(1.0 - 1.0 / eta**2)
    for power, found in enumerate(internal_moments(eta), start=1):
        truth = critical ** (power + 1) / (power + 1)
        truth += quad(
            lambda mu, power=power: reflected(mu, eta) * mu**power, critical, 1.0, epsabs=1e-12
        )[0]
        # Near index one R bends sharply within the reach of quad's last interval.
        assert found == pytest.approx(truth, abs=1e-9)


@pytest.mark.parametrize("eta", [1.2, 1.3, 1.4, 1.5])
def test_the_first_moment_is_near_the_printed_fits(eta: float) -> None:
    first = 2.0 * internal_moments(eta)[0]
    # Jensen et al. 2001 print a rational fit of it, good to about half a per cent of the light.
    assert first == pytest.approx(internal_reflectance(eta), abs=6e-3)


def test_exitance_is_that_of_the_fluence_and_of_its_gradient() -> None:
    # phi of two sources in space, its gradient by differences; M = C_phi phi + C_E D dphi/dz.
    eta = 1.3
    C1, C2 = internal_moments(eta)
    for channel in optics(material("skin1")):
        D = (2.0 * (1.0 - channel.albedo) + channel.albedo) / 3.0
        mu = np.sqrt((1.0 - channel.albedo) / D)
        z_b = 2.0 * D * (1.0 + 3.0 * C2) / (1.0 - 2.0 * C1)

        def fluence(r: float, z: float, D: float = D, mu: float = mu, z_b: float = z_b) -> float:
            near, far = np.hypot(r, z - 1.0), np.hypot(r, z + 1.0 + 2.0 * z_b)
            return float((np.exp(-mu * near) / near - np.exp(-mu * far) / far) / (4.0 * np.pi * D))

        for r in (0.1, 1.0, 6.0):
            h = 1e-4
            slope = (fluence(r, h) - fluence(r, -h)) / (2.0 * h)
            truth = 0.25 * (1.0 - 2.0 * C1) * fluence(r, 0.0) + 0.5 * (1.0 - 3.0 * C2) * D * slope
            found = PROFILE.radial(np.array([r]), channel)[0]
            # Central differences: h^2/6 of the third derivative, here of order one.
            assert found == pytest.approx(channel.albedo**2 * truth, rel=1e-7)


def test_the_fluence_vanishes_on_the_extrapolated_boundary() -> None:
    channel = Optics(0.8, 1.3)
    C1, C2 = internal_moments(1.3)
    z_b = 2.0 * (2.0 - 0.8) / 3.0 * (1.0 + 3.0 * C2) / (1.0 - 2.0 * C1)
    # B = 1 + 2 z_b mirrors depth 1 at the height z_b: without Fresnel's part, R_d shows it.
    mu = np.sqrt(0.2 / 0.4)
    q = np.exp(-2.0 * z_b * mu)
    phi = 0.25 * (1.0 - 2.0 * C1) / (0.4 * mu) * (1.0 - q)
    expected = 0.5 * 0.8**2 * np.exp(-mu) * (phi + 0.5 * (1.0 - 3.0 * C2) * (1.0 + q))
    assert PROFILE.total(channel) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize("eta", [1.0, 1.3, 1.5, 2.0])
def test_without_absorption_all_light_leaves(eta: float) -> None:
    assert PROFILE.total(Optics(1.0, eta)) == pytest.approx(1.0, rel=1e-12)
    assert PROFILE.total(Optics(1.0 - 1e-15, eta)) == pytest.approx(1.0, abs=1e-6)


def test_for_pale_materials_it_is_nearer_to_the_exact_albedo_than_the_classical_dipole() -> None:
    c = 0.5 * (np.polynomial.legendre.leggauss(32)[0] + 1.0)
    entering = np.polynomial.legendre.leggauss(32)[1] * c
    classical = diffusion_profile("jensen2001")
    for channel in optics(material("marble")):
        weights = entering * transmittance(c, channel.eta)
        exact = np.sum(weights * flat_albedo(c, channel)) / np.sum(weights)
        better = abs(PROFILE.total(channel) - exact)
        assert better < 0.02
        assert better < abs(classical.total(channel) - exact)
