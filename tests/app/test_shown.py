import numpy as np
import pytest
from msgspec.structs import replace

from app.pipeline import Pipeline
from app.quantities import QUANTITIES
from app.session import Method, Session
from app.shown import names_shown, robust_range, shown, trusted
from lutcore.analytic import saddle
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import ParameterError

TORUS = Session(mesh="sample:torus", view="curvature", estimator=Method("rusinkiewicz2004"))


def curved(k1, k2, error, scale=0.0):
    zeros = np.zeros((len(k1), 3))
    return PrincipalCurvatures(k1, k2, zeros, zeros, zeros, error, scale)


def with_outliers(share):
    """The truth on a saddle, but at its border and in some of the rest values gone wild."""
    exact = saddle(4000, k=(-0.5, 0.5))
    rim = (np.abs(exact.mesh.vertices[:, :2]) > 1.0 - 1e-9).any(axis=1)
    random = np.random.default_rng(2)
    wild = rim | (random.random(len(rim)) < share)
    k1, k2 = exact.truth.k1.copy(), exact.truth.k2.copy()
    k1[wild] += 500.0 * random.random(wild.sum())
    return exact.truth, curved(k1, k2, np.where(wild, 300.0, 0.01)), wild


def test_outliers_with_wide_error_bars_do_not_widen_the_range():
    truth, estimate, wild = with_outliers(0.3)
    assert wild.mean() > 0.3
    plain = robust_range(estimate.k1)
    low, high = robust_range(estimate.k1[trusted(estimate)])
    exact = robust_range(truth.k1[~wild])
    assert plain[1] > 100.0
    assert (low, high) == exact
    # Of a border alone too, which 5 % at each end would not hold.
    truth, estimate, wild = with_outliers(0.0)
    assert 0.05 < wild.mean() < 0.1
    assert robust_range(estimate.k1)[1] > 10.0 * exact[1]
    assert robust_range(estimate.k1[trusted(estimate)])[1] <= exact[1] * 1.01


def test_trust_is_the_same_for_a_mesh_in_metres():
    _, estimate, _ = with_outliers(0.2)
    metres = curved(1e3 * estimate.k1, 1e3 * estimate.k2, 1e3 * estimate.error)
    np.testing.assert_array_equal(trusted(metres), trusted(estimate))


def test_where_the_error_bars_trust_hardly_anything_all_estimates_count():
    k = np.linspace(0.0, 1.0, 100)
    error = np.full(100, 50.0)
    error[-1] = np.inf
    np.testing.assert_array_equal(trusted(curved(k, k, error)), np.isfinite(error))
    assert not trusted(curved(k, k, np.full(100, np.inf))).any()


def test_the_robust_range_ignores_outliers_and_infinities_and_never_collapses():
    values = np.concatenate([np.linspace(0.0, 1.0, 1000), [1e9, np.inf]])
    low, high = robust_range(values)
    assert 0.0 < low < 0.1 < 0.9 < high < 1.0
    low, high = robust_range(np.full(10, 3.0))
    assert low == 3.0 < high
    low, high = robust_range(np.full(10, -3.0))
    assert low == -3.0 < high < 0.0
    assert robust_range(np.array([np.inf])) == (0.0, 1.0)
    assert robust_range(np.zeros(5)) == (0.0, 1.0)


def test_rounding_errors_do_not_fill_the_colour_map():
    values = 0.1 + 1e-9 * np.random.default_rng(0).standard_normal(100)
    low, high = robust_range(values)
    assert high - low == pytest.approx(1e-3)


def test_the_range_of_the_error_itself_is_not_cut_where_errors_are_wide():
    pipeline = Pipeline()
    found = shown(replace(TORUS, quantity="error"), pipeline, "error")
    low, high = np.percentile(found.values, (5.0, 95.0))
    assert (found.low, found.high) == (pytest.approx(low), pytest.approx(high))


def test_all_shows_each_quantity_and_the_disagreement_where_there_are_peers():
    every = replace(TORUS, quantity="all")
    assert set(names_shown(every)) == set(QUANTITIES) - {"disagreement"}
    asked = replace(every, peers=(Method("vtk"), Method("ball-jet"), Method("rusinkiewicz2004")))
    assert set(names_shown(asked)) == set(QUANTITIES)
    assert names_shown(replace(asked, quantity="k2")) == ("k2",)


def test_symmetric_means_quantities_that_can_be_negative_unless_one_is_asked_for():
    pipeline = Pipeline()
    every = replace(TORUS, quantity="all", symmetric=True)
    mean = shown(every, pipeline, "mean")
    assert mean.low == -mean.high
    assert shown(every, pipeline, "curvedness").low > 0.0
    alone = shown(replace(every, quantity="curvedness"), pipeline, "curvedness")
    assert alone.low == -alone.high


def test_the_scale_is_a_length_in_mm_at_every_vertex():
    session = replace(TORUS, estimator=Method("corrected-curvature"), scale=1.5, mm_per_unit=10.0)
    found = shown(session, Pipeline(), "scale")
    np.testing.assert_allclose(found.values, 15.0)
    assert found.quantity.unit == "mm"
    apart = curved(np.ones(2), np.ones(2), np.ones(2), scale=np.array([1.0, 2.0]))
    np.testing.assert_array_equal(QUANTITIES["scale"].values(apart, 10.0), [10.0, 20.0])


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"quantity": "disagreement"}, "--disagree"),
        ({"quantity": "all", "range": (0.0, 1.0)}, "--range"),
    ],
)
def test_what_cannot_be_shown_is_refused_with_the_flag_to_change(changes, said):
    session = replace(TORUS, **changes)
    with pytest.raises(ParameterError, match=said):
        shown(session, Pipeline(), names_shown(session)[0])
