"""Fresnel transmittance, its means and its hinge fit."""

import numpy as np
import pytest

from lutcore.fresnel import (
    compiled_transmittance,
    hinges,
    internal_reflectance,
    leaving_along,
    leaving_to,
    mean_transmittance,
    transmittance,
    virtual_depth,
)


@pytest.mark.parametrize("eta", [1.0, 1.3, 1.5, 3.0])
def test_ends(eta: float) -> None:
    # Normal incidence: 1 - ((eta - 1)/(eta + 1))^2; grazing: nothing enters.
    assert transmittance(1.0, eta) == pytest.approx(4.0 * eta / (eta + 1.0) ** 2)
    if eta > 1.0:
        assert transmittance(0.0, eta) == pytest.approx(0.0, abs=1e-15)


def test_brewster_angle_reflects_half_of_the_other_polarisation() -> None:
    eta = 1.5
    cosine = 1.0 / np.sqrt(1.0 + eta**2)
    assert 1.0 - transmittance(cosine, eta) == pytest.approx(
        0.5 * ((1.0 - eta**2) / (1.0 + eta**2)) ** 2
    )


def test_compiled_equals_numpy() -> None:
    cosines = np.linspace(0.0, 1.0, 101)
    each = [compiled_transmittance(float(c), 1.3) for c in cosines]
    np.testing.assert_allclose(each, transmittance(cosines, 1.3), rtol=0.0, atol=1e-15)


@pytest.mark.parametrize(("eta", "expected"), [(1.0, 1.0), (1.3, 0.9389), (1.5, 0.9082)])
def test_mean(eta: float, expected: float) -> None:
    assert mean_transmittance(eta) == pytest.approx(expected, abs=5e-5)


@pytest.mark.parametrize("eta", [1.01, 1.3, 1.5, 3.0])
def test_mean_equals_adaptive_quadrature(eta: float) -> None:
    from scipy.integrate import quad

    whole = quad(lambda mu: 2.0 * mu * float(transmittance(mu, eta)), 0.0, 1.0, epsabs=1e-12)[0]
    assert mean_transmittance(eta) == pytest.approx(whole, abs=1e-9)


@pytest.mark.parametrize("eta", [1.2, 1.3, 1.5])
def test_the_fit_of_internal_reflectance_obeys_reciprocity(eta: float) -> None:
    # Exactly, 1 - F_dr = <F_t>/eta^2; the rational fit is good to 1.5 %.
    assert internal_reflectance(eta) == pytest.approx(
        1.0 - mean_transmittance(eta) / eta**2, rel=0.015
    )


def test_virtual_depth_of_eta_1_3() -> None:
    reflected = -1.440 / 1.69 + 0.710 / 1.3 + 0.668 + 0.0636 * 1.3
    assert virtual_depth(1.3) == pytest.approx(1.0 + 4.0 / 3.0 * (1 + reflected) / (1 - reflected))


def test_four_hinges_for_eta_1_3_are_as_good_as_known() -> None:
    assert hinges(1.3, 4).error < 0.0038


@pytest.mark.parametrize("eta", [1.0, 1.3, 1.5, 2.5])
@pytest.mark.parametrize("count", [1, 2, 4, 8])
def test_hinges_have_the_error_they_state(eta: float, count: int) -> None:
    fit = hinges(eta, count)
    cosines = np.linspace(0.0, 1.0, 1501)
    ramps = np.maximum(0.0, cosines[:, None] - fit.corners)
    difference = np.abs(ramps @ fit.weights - cosines * transmittance(cosines, eta)).max()
    # The stated maximum is of a grid of 4001; between its points the difference moves < 1e-4.
    assert difference == pytest.approx(fit.error, abs=1e-4)
    assert fit.corners[0] == 0.0
    assert (np.diff(fit.corners) >= 0.0).all()
    # A light that rises must not darken: the slope, a partial sum of the weights, stays positive.
    assert (np.cumsum(fit.weights) > -1e-9).all()


@pytest.mark.parametrize("eta", [1.3, 1.5])
def test_more_hinges_fit_better(eta: float) -> None:
    one, two, four, eight = (hinges(eta, count).error for count in (1, 2, 4, 8))
    assert one > two > four > eight


def test_hinges_are_the_same_object() -> None:
    assert hinges(1.3, 4) is hinges(1.3, 4)


def test_what_leaves_for_a_place_is_the_transmittance_along_the_way() -> None:
    random = np.random.default_rng(2)
    points, normals = random.normal(size=(2, 500, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    place, eta = np.array([4.0, -1.0, 2.0]), np.array([1.3, 1.5, 1.7])
    towards = (place - points) / np.linalg.norm(place - points, axis=1, keepdims=True)
    for directions, found in (
        (towards, leaving_to(place, points, normals, eta)),
        (towards[:1], leaving_along(towards[0], normals, eta)),
    ):
        # From behind as from the front.
        cosine = np.abs((normals * directions).sum(axis=1))
        expected = np.stack([transmittance(cosine, index) for index in eta], axis=1)
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-14)
