import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import ParameterError
from lutcore.estimation import principal_curvatures
from lutcore.mesh import TriangleMesh
from lutcore.tensors import principal, symmetric_fit, tangent_frame

number = st.floats(-10.0, 10.0)


def result(k1, k2):
    k1, k2 = np.atleast_1d(np.asarray(k1, float)), np.atleast_1d(np.asarray(k2, float))
    axes = np.tile(np.eye(3)[:, None], (1, len(k1), 1))
    return PrincipalCurvatures(k1, k2, axes[0], axes[1], axes[2], np.zeros(len(k1)), 0.0)


@pytest.mark.parametrize(
    ("k1", "k2", "index"),
    [(1, 1, 1.0), (1, 0, 0.5), (1, -1, 0.0), (0, -1, -0.5), (-2, -2, -1.0), (0, 0, 0.0)],
)
def test_shape_index_of_the_named_shapes(k1, k2, index):
    assert result(k1, k2).shape_index[0] == pytest.approx(index)


def test_mean_gauss_and_curvedness():
    found = result([3.0], [-4.0])
    assert found.mean[0] == -0.5
    assert found.gauss[0] == -12.0
    assert found.curvedness[0] == pytest.approx(np.sqrt(12.5))


def test_an_unknown_method_names_the_nearest():
    mesh = TriangleMesh(np.eye(3), [[0, 1, 2]])
    with pytest.raises(ParameterError, match="did you mean 'co-smoothing'"):
        principal_curvatures(mesh, "cosmoothing")


@given(number, number, number)
def test_principal_values_rebuild_the_tensor(a, b, d):
    k1, k2, c, s = principal(a, b, d)
    assert k1 >= k2
    assert np.hypot(c, s) == pytest.approx(1.0)
    turn = np.array([[c, -s], [s, c]])
    rebuilt = turn @ np.diag([k1, k2]) @ turn.T
    assert np.allclose(rebuilt, [[a, b], [b, d]], atol=1e-12)


@given(st.lists(st.tuples(number, number), min_size=3, max_size=8), number, number, number)
def test_the_fit_returns_the_tensor_that_made_the_pairs(pairs, a, b, d):
    x = np.array(pairs)
    spread = x.T @ x
    if np.linalg.eigvalsh(spread)[0] < 1e-3 * np.trace(spread) or np.trace(spread) < 1e-6:
        return
    tensor = np.array([[a, b], [b, d]])
    moved = (x @ tensor).T @ x
    both = 0.5 * (moved + moved.T)
    found = symmetric_fit(
        spread[0, 0], spread[0, 1], spread[1, 1], both[0, 0], both[0, 1], both[1, 1]
    )
    # Rounding times the condition, at most 1e3, squared by adj(C) Q adj(C).
    assert np.allclose(found, [a, b, d], atol=1e-8)


@given(number, number, number)
def test_tangent_frames_are_right_handed(x, y, z):
    length = np.sqrt(x * x + y * y + z * z)
    if length < 1e-3:
        return
    n = np.array([x, y, z]) / length
    u, v = tangent_frame(*n)
    assert np.allclose(np.cross(u, v), n)
    assert np.linalg.norm(u) == pytest.approx(1.0)
