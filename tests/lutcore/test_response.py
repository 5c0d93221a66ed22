from dataclasses import dataclass

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import dawsn

from lutcore.baking import glowing
from lutcore.diffusion import DiffusionProfile, diffusion_profile, optics
from lutcore.materials import material
from lutcore.response import response

DIPOLE = diffusion_profile("jensen2001")
CHANNELS = [
    pytest.param(glowing(optics(material(name))[channel]), id=f"{name} {channel}")
    for name, channel in (("skin1", 0), ("skin1", 2), ("marble", 0), ("cream", 0))
]


@dataclass(frozen=True)
class Gauss(DiffusionProfile):
    def radial(self, r, optics):
        return np.exp(-0.5 * r * r)


def test_both_filters_of_a_gaussian_are_known():
    found = response(Gauss(), optics(material("skin1"))[0])
    q = found.wavenumber[1:]
    # What the trapezoidal rule leaves where J0 and H0 turn faster than its nodes.
    np.testing.assert_allclose(found.normals[1:], np.exp(-0.5 * q * q), atol=1e-3)
    # int_0^inf exp(-x^2/2) sin(q x) dx = sqrt(2) D(q/sqrt(2))
    expected = np.sqrt(2.0) * dawsn(q / np.sqrt(2.0)) / q
    np.testing.assert_allclose(found.curvature[1:], expected, atol=1e-4)
    assert (found.wavenumber[0], found.normals[0], found.curvature[0]) == (0.0, 1.0, 1.0)


@pytest.mark.parametrize("channel", CHANNELS)
def test_normals_are_filtered_by_the_dipoles_own_transform(channel):
    found = response(DIPOLE, channel)
    d = np.hypot(channel.beta, found.wavenumber)
    expected = np.exp(-d) + np.exp(-channel.depth * d)
    np.testing.assert_allclose(found.normals, expected / expected[0], atol=1e-3)


@pytest.mark.parametrize("channel", CHANNELS)
def test_curvature_is_filtered_by_the_lit_half_plane(channel):
    found = response(DIPOLE, channel)

    def spread(x):
        return float(DIPOLE.line_spread(np.array([x]), channel)[0])

    end = 20.0 / channel.beta
    straight = quad(lambda x: x * spread(x), 0.0, end, limit=500)[0]
    for q in (0.1, 1.0, 10.0):
        at = np.argmin(np.abs(found.wavenumber - q))
        wave = found.wavenumber[at]
        sine = quad(spread, 0.0, end, weight="sin", wvar=wave, limit=2000)[0] / wave
        assert found.curvature[at] == pytest.approx(sine / straight, abs=1e-4)
