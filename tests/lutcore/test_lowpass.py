import numpy as np
import pytest
from numpy.polynomial import legendre
from scipy.sparse import csr_matrix

from lutcore import analytic
from lutcore.cosmoothing import surface
from lutcore.lowpass import _filter, _strengths, degree, low_pass
from lutcore.mesh import TriangleMesh
from lutcore.patches import patches


def matrix(on):
    start, neighbour, rate, bound, _, _ = on.operator
    weights = csr_matrix((0.5 * bound * rate.astype(float), neighbour, start))
    return (csr_matrix(np.diag(np.asarray(weights.sum(axis=1)).ravel())) - weights).toarray()


def best_filter(k):
    """Return the Legendre coefficients of the filter, and its noise, by constrained least squares.

    Minimise int_0^1 y^2 p(y)^2 dy under p(0) = 1 and p'(0) = 0, in another basis and without any
    of the identities that the code under test uses.
    """
    nodes, weights = legendre.leggauss(k + 4)
    rows = legendre.legvander(nodes, k) * np.sqrt(0.5 * weights)[:, None]
    rows *= 0.5 * (1.0 + nodes)[:, None]
    ends = [[(-1.0) ** j for j in range(k + 1)]]
    ends.append([-((-1.0) ** j) * j * (j + 1) / 2.0 for j in range(k + 1)])
    gram = np.linalg.inv(rows.T @ rows)
    ends = np.array(ends)
    multipliers = np.linalg.solve(ends @ gram @ ends.T, [1.0, 0.0])
    coefficients = gram @ ends.T @ multipliers
    return coefficients, float(multipliers[0])


@pytest.mark.parametrize("k", [3, 4, 7, 12])
def test_no_filter_of_its_degree_passes_less_noise(k):
    coefficients, least = best_filter(k)
    y = np.linspace(0.0, 1.0, 41)
    np.testing.assert_allclose(
        _filter(k, y), legendre.legval(2.0 * y - 1.0, coefficients), atol=1e-9
    )
    # The Gaussian exp(-t L) passes 1/(4 t^3): int_0^inf y^2 exp(-2 t y) dy.
    assert _strengths()[k] == pytest.approx(np.cbrt(1.0 / (4.0 * least)), rel=1e-9)


@pytest.mark.parametrize("k", [3, 20, 300])
def test_quadratics_pass(k):
    step = 1e-3 / k**2
    ahead = _filter(k, np.array([0.0, step, 2.0 * step]))
    assert ahead[0] == pytest.approx(1.0, abs=1e-12)
    # With no slope at 0 twice the step is four times as far down.
    assert (1.0 - ahead[2]) / (1.0 - ahead[1]) == pytest.approx(4.0, rel=1e-2)


@pytest.mark.parametrize("make", [analytic.torus, analytic.saddle])
def test_the_recurrence_gives_the_polynomial_of_the_matrix(make):
    on = surface(make(300, irregular=True).mesh)
    scales = [1.5 * on.spacing, 6.0 * on.spacing]
    change = low_pass(on.operator, on.fields, scales)
    values, left = np.linalg.eig(matrix(on))
    coefficients = np.linalg.solve(left, on.fields.astype(complex))
    for column, scale in enumerate(scales):
        k = degree(scale, on.operator.bound)
        # The bound is stretched so that the scale is met exactly.
        ample = _strengths()[k] / (0.5 * scale**2)
        assert ample >= on.operator.bound
        exact = (left @ ((_filter(k, (values / ample).real) - 1.0)[:, None] * coefficients)).real
        # Single precision over some fifty terms.
        assert np.abs(change[column] - exact).max() < 2e-5 * np.abs(exact).max()


def test_noise_of_curvature_falls_as_for_the_gaussian_of_the_scale():
    # The second derivative of white noise under a Gaussian of deviation s has the variance
    # 3/(16 pi) A/s^6: the fourth derivative at 0 of a Gaussian of variance 2 s^2.
    grid = analytic.saddle(6_400, k=(0.0, 0.0)).mesh
    on = surface(grid)
    noise = np.random.default_rng(0).standard_normal((len(grid.vertices), 6))
    side = int(np.sqrt(len(grid.vertices)))
    for spacings in (4.0, 6.0):
        scale = spacings * on.spacing
        after = (noise + low_pass(on.operator, noise, [scale])[0]).reshape(side, side, 6)
        second = (after[2:] - 2.0 * after[1:-1] + after[:-2]) / on.spacing**2
        inner = second[20:-20, 20:-20]
        expected = np.sqrt(3.0 / (16.0 * np.pi)) * on.spacing / scale**3
        # Six fields of 1,600 vertices, some 16 to 36 of which are alike: 6 % by chance; the
        # stencil blurs by (h/s)^2/4 and the grid's diagonals widen it by another per cent.
        assert inner.std() == pytest.approx(expected, rel=0.15)


def test_constants_and_flat_patches_stay():
    on = surface(analytic.saddle(900, k=(0.0, 0.0)).mesh)
    change = low_pass(on.operator, np.ones((len(on.fields), 6)), [5.0 * on.spacing])
    assert np.abs(change).max() < 1e-6


def test_a_longer_scale_takes_proportionally_more_products():
    # The Gaussian, cut off at 1e-5, takes some three times as many.
    ratio = [degree(s, 16.0) / s for s in (4.0, 8.0, 16.0, 160.0)]
    assert max(ratio) / min(ratio) < 1.1
    assert ratio[0] < 9.0


def test_parts_without_common_edges_are_smoothed_as_the_whole():
    first, second = analytic.torus(400, irregular=True).mesh, analytic.saddle(900).mesh
    count = len(first.vertices)
    both = TriangleMesh(
        np.concatenate([first.vertices, second.vertices + 9.0]),
        np.concatenate([first.faces, second.faces + count]),
    )
    on = surface(both)
    scales = [1.5 * on.spacing, 6.0 * on.spacing]
    parts = np.array([0, count, len(both.vertices)], np.int32)
    apart = low_pass(on.operator._replace(parts=parts), on.fields, scales)
    np.testing.assert_array_equal(apart, low_pass(on.operator, on.fields, scales))


def test_patches_that_meet_are_cut_apart():
    on = surface(analytic.torus(9_500).mesh)
    tried, inner = patches(on)  # three discs of 3,000 cover nearly all of it
    parts = tried.operator.parts
    assert np.diff(parts)[:2].tolist() == [3_000, 3_000]
    assert parts[-1] == len(inner) == len(tried.fields)
    owner = np.repeat(np.arange(len(inner)), np.diff(tried.operator.start))
    disc = np.searchsorted(parts, [owner, tried.operator.neighbour], side="right")
    np.testing.assert_array_equal(*disc)
    # Where they were cut is a rim.
    assert np.count_nonzero(tried.operator.rim) > 200
