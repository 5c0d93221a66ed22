import numpy as np
import pytest

from lutcore import analytic
from lutcore.estimation import principal_curvatures
from lutcore.mesh import TriangleMesh


def error(count, irregular=False):
    exact = analytic.torus(count, irregular)
    found = principal_curvatures(exact.mesh, "rusinkiewicz2004")
    return np.sqrt(
        np.mean((found.k1 - exact.truth.k1) ** 2 + (found.k2 - exact.truth.k2) ** 2)
        / np.mean(exact.truth.k1**2 + exact.truth.k2**2)
    )


def test_second_order_on_a_regular_mesh():
    # Half the spacing, a quarter of the error.
    assert error(4_000) / error(16_000) == pytest.approx(4.0, rel=0.2)


@pytest.mark.parametrize("irregular", [False, True])
def test_exact_on_a_sphere(irregular):
    # Every face's corners have N = X/R exactly, so every tensor is I/R.
    found = principal_curvatures(
        analytic.sphere(1_000, irregular, radius=2.0).mesh, "rusinkiewicz2004"
    )
    assert np.allclose(found.k1, 0.5, atol=1e-7)
    assert np.allclose(found.k2, 0.5, atol=1e-7)


def test_slivers_do_not_break_the_solver():
    # One row of a cylinder squeezed to a ten-thousandth: its triangles are 1e4 times longer
    # than wide, their normal equations conditioned 1e8.
    angle = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    heights = np.array([0.0, 0.1, 0.2, 0.20001, 0.3, 0.4])
    ring, level = np.meshgrid(angle, heights)
    points = np.stack([np.cos(ring), np.sin(ring), level], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(5), np.arange(60), indexing="ij")
    a, b = (60 * i + j).ravel(), (60 * i + (j + 1) % 60).ravel()
    faces = np.vstack([np.stack([a, b, b + 60], axis=1), np.stack([a, b + 60, a + 60], axis=1)])
    found = principal_curvatures(TriangleMesh(points, faces), "rusinkiewicz2004")
    # Chords of 6 degrees: (.105)^2/24 = .05 %, and rounding 1e-16 x 1e8.
    assert np.allclose(found.k1, 1.0, atol=1e-3)
    assert np.allclose(found.k2, 0.0, atol=1e-3)


def test_one_ring_values_are_drowned_by_noise_and_say_so():
    exact = analytic.torus(4_000)
    found = principal_curvatures(exact.noisy(0.1), "rusinkiewicz2004")
    off = np.abs(found.k1 - exact.truth.k1)
    assert np.median(off) > 0.2
    assert np.median(found.error) > np.median(off)
