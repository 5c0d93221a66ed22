"""The flat body: Chandrasekhar's H, the index-matched limit, and the random walk's flat albedo."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from lutcore.diffusion import Optics
from lutcore.errors import ParameterError
from lutcore.halfspace import flat_albedo, h_function
from tests.walk_truth import stored_flat

FloatArray = NDArray[np.float64]
COSINES = np.linspace(0.0, 1.0, 21)


def iterated(mu: FloatArray, albedo: float) -> FloatArray:
    """Solve 1/H(mu) = sqrt(1 - albedo) + albedo/2 int_0^1 t H(t)/(mu + t) dt by iteration."""
    x, weights = np.polynomial.legendre.leggauss(200)
    t, weights = 0.5 * (x + 1.0), 0.5 * weights
    H = np.ones_like(t)

    def right(at: FloatArray) -> FloatArray:
        integral = np.sum(weights * t * H / (at[:, None] + t), axis=1)
        return np.asarray(1.0 / (np.sqrt(1.0 - albedo) + 0.5 * albedo * integral))

    for _ in range(300):
        H = 0.5 * (H + right(t))
    return right(mu)


@pytest.mark.parametrize("albedo", [0.3, 0.9, 0.99])
def test_h_solves_chandrasekhars_integral_equation(albedo: float) -> None:
    mu = np.linspace(0.02, 1.0, 15)
    # What is left of the iteration, and the 200 nodes at mu = .02, are below 1e-7.
    np.testing.assert_allclose(h_function(mu, albedo), iterated(mu, albedo), rtol=1e-6)


def test_h_without_absorption_is_the_tabulated_one() -> None:
    # Chandrasekhar 1950, table XI, albedo 1, printed to four decimals.
    found = h_function([0.0, 0.1, 0.5, 1.0], 1.0)
    np.testing.assert_allclose(found, [1.0, 1.2474, 2.0128, 2.9078], atol=5e-5)


@pytest.mark.parametrize("albedo", [0.1, 0.9, 0.999])
def test_index_matched_it_is_chandrasekhars_plane_albedo(albedo: float) -> None:
    # Inside and outside cosines are the same; f = 1 - H(mu) sqrt(1 - albedo). The kernel's corner
    # at mu = 0, where the nodes are fewest, is worth 1e-5.
    expected = 1.0 - h_function(COSINES, albedo) * np.sqrt(1.0 - albedo)
    np.testing.assert_allclose(flat_albedo(COSINES, Optics(albedo, 1.0)), expected, atol=1e-4)
    inside = COSINES >= 0.05
    found = flat_albedo(COSINES[inside], Optics(albedo, 1.0))
    np.testing.assert_allclose(found, expected[inside], atol=1e-7)


@pytest.mark.parametrize("eta", [1.0, 1.3, 1.5, 3.0])
def test_without_absorption_all_comes_back(eta: float) -> None:
    cosines = COSINES[1:]  # index-matched grazing light needs more nodes
    np.testing.assert_allclose(flat_albedo(cosines, Optics(1.0, eta)), 1.0, atol=1e-7)


def test_the_random_walk_finds_the_same() -> None:
    rows = stored_flat()
    assert len(rows) == 48
    for albedo, eta, cosine, found, error in rows:
        # 4 sigma: one of 48 right rows would fail in one of 300 seeds.
        difference = float(flat_albedo(cosine, Optics(albedo, eta))) - found
        assert abs(difference) < 4.0 * error, (albedo, eta, cosine)
        assert error < 0.0007


@given(albedo=st.floats(0.001, 1.0), more=st.floats(0.0, 0.2), eta=st.floats(1.0, 3.0))
def test_it_is_a_share_and_grows_with_the_albedo(albedo: float, more: float, eta: float) -> None:
    low = flat_albedo(COSINES, Optics(albedo, eta))
    high = flat_albedo(COSINES, Optics(min(albedo + more, 1.0), eta))
    # Near index one the kernel's corner costs 1e-4 at grazing incidence.
    assert (low >= 0.0).all()
    assert (high <= 1.0 + 1e-4).all()
    assert (high >= low - 1e-4).all()


@pytest.mark.parametrize("cosine", [-0.1, 1.1, np.nan])
def test_a_cosine_out_of_range_is_refused(cosine: float) -> None:
    with pytest.raises(ParameterError, match="cosine"):
        flat_albedo([0.5, cosine], Optics(0.9, 1.3))
