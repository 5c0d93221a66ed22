"""Error bars of k1 and of k2 apart: bias changes the larger curvature more."""

import numpy as np
import pytest

from lutcore.analytic import ellipsoid, torus
from lutcore.estimation import principal_curvatures
from lutcore.mesh import TriangleMesh


@pytest.fixture(scope="module")
def flat():
    """A flat ellipsoid, whose k1 changes fastest where it is largest, with a little noise."""
    exact = ellipsoid(20_000, True, axes=(1.0, 0.9, 0.35), seed=5)
    return exact.truth, principal_curvatures(exact.noisy(0.02), "auto")


def test_together_they_are_the_error_of_both(flat) -> None:
    _, found = flat
    np.testing.assert_allclose(0.5 * (found.error1**2 + found.error2**2), found.error**2)
    assert np.abs(found.lean).max() < 1.0


def test_each_holds_its_own_share_better_than_one_bar_for_both(flat) -> None:
    truth, found = flat
    off = np.abs([found.k1 - truth.k1, found.k2 - truth.k2])
    apart = [np.mean(off[0] <= found.error1), np.mean(off[1] <= found.error2)]
    both = np.mean(off <= found.error, axis=1)
    normal = 0.683  # of a normal distribution within one sigma
    assert np.abs(np.subtract(apart, normal)).max() < np.abs(both - normal).max() - 0.05


def test_inside_out_the_bars_change_places() -> None:
    exact = torus(5_000)
    mesh = exact.noisy(0.05)
    found = principal_curvatures(mesh, "auto")
    turned = principal_curvatures(TriangleMesh(mesh.vertices, mesh.faces[:, ::-1]), "auto")
    # Sums in another order: single precision, and a scale that is as good may be preferred.
    close = np.isclose(turned.error1, found.error2, rtol=0.01)
    assert close.mean() > 0.99


def test_methods_that_do_not_know_say_the_same_of_both() -> None:
    exact = torus(2_000)
    found = principal_curvatures(exact.mesh, "rusinkiewicz2004")
    np.testing.assert_array_equal(found.error1, found.error)
    np.testing.assert_array_equal(found.error2, found.error)
