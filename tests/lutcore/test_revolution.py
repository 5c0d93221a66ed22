"""Spheres and paraboloids, against quadratures that share nothing with them."""

import numpy as np
import pytest

from lutcore.diffusion import diffusion_profile, diffusion_profiles, optics
from lutcore.fresnel import transmittance
from lutcore.materials import material
from lutcore.revolution import on_paraboloid, on_sphere
from tests.quadrature import dipole, sphere_exitance

DIPOLE = diffusion_profile("jensen2001")
COSINES = np.array([-1.0, -0.6, -0.1, -0.003, 0.0, 0.003, 0.1, 0.6, 1.0])


@pytest.mark.parametrize(("name", "channel"), [("skin1", 0), ("ketchup", 2), ("cream", 0)])
@pytest.mark.parametrize("s", [1e-4, 0.01, 0.3, 5.0])
def test_a_sphere_is_what_its_own_quadrature_gives(name: str, channel: int, s: float) -> None:
    constants = optics(material(name))[channel]
    truth = sphere_exitance(COSINES, 1.0 / s, constants, 40) / DIPOLE.total(constants)
    np.testing.assert_allclose(on_sphere(COSINES, s, DIPOLE, constants), truth, rtol=0.0, atol=1e-8)


@pytest.mark.parametrize("profile", diffusion_profiles())
def test_a_large_sphere_and_a_flat_paraboloid_are_lambert(profile: str) -> None:
    constants, chosen = optics(material("skin1"))[0], diffusion_profile(profile)
    lit = np.maximum(COSINES, 0.0)
    flat = lit * transmittance(lit, constants.eta)
    for exitance in (on_sphere, on_paraboloid):
        # c F_t(c) starts with its square: even at the terminator the difference is of second order.
        value = exitance(COSINES, 1e-5, chosen, constants)
        np.testing.assert_allclose(value, flat, rtol=0.0, atol=2e-8)


@pytest.mark.parametrize("profile", diffusion_profiles())
@pytest.mark.parametrize("s", [0.03, 0.5, 10.0])
def test_a_sphere_gives_out_less_than_it_takes_in(profile: str, s: float) -> None:
    constants, chosen = optics(material("marble"))[0], diffusion_profile(profile)
    x, weights = np.polynomial.legendre.leggauss(60)
    cosines = np.sort(np.concatenate((0.5 * (x - 1.0), 0.5 * (x + 1.0))))
    shares = 0.5 * np.concatenate((weights, weights))
    lit = np.maximum(cosines, 0.0)
    entering = shares @ (lit * transmittance(lit, constants.eta))
    leaving = shares @ on_sphere(cosines, s, chosen, constants)
    # What is missing is the profile beyond the diameter.
    r = np.exp(np.arange(-20.0, np.log(2.0 / s) + 1e-3, 1e-3))
    inside = 2.0 * np.pi * np.sum(r * r * chosen.radial(r, constants)) * 1e-3
    inside -= 0.5e-3 * 2.0 * np.pi * r[-1] ** 2 * chosen.radial(r[-1:], constants)[0]
    kept = inside / chosen.total(constants)
    # Steps of .001 in log r end within one step of the diameter.
    assert leaving / entering == pytest.approx(kept, abs=2e-3)
    assert leaving <= entering * (1.0 + 1e-6)


@pytest.mark.parametrize("cosine", [-0.2, 0.05, 0.9])
def test_a_paraboloid_is_the_integral_over_the_plane_below_it(cosine: float) -> None:
    from scipy.integrate import dblquad

    constants, s = optics(material("skin1"))[0], 0.2
    sine = np.sqrt(1.0 - cosine**2)

    def integrand(phi, r):
        slope = cosine + s * sine * r * np.cos(phi)  # c dA/(r dr dphi)
        if slope <= 0.0:
            return 0.0
        c = slope / np.sqrt(1.0 + (s * r) ** 2)
        distance = np.hypot(r, 0.5 * s * r * r)
        radial = dipole(np.array([distance]), constants)[0]
        return 2.0 * radial * slope * transmittance(c, constants.eta) * r

    truth = dblquad(integrand, 0.0, 40.0, 0.0, np.pi, epsabs=1e-8, epsrel=1e-7)[0]
    value = on_paraboloid(np.array([cosine]), s, DIPOLE, constants)[0]
    assert value == pytest.approx(truth / DIPOLE.total(constants), abs=1e-6)
