"""The psi table and the paper's (a, b) table, against quadrature of the paper's integral."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lutcore.baking import BETA_FLOOR, bake, bake_plane
from lutcore.diffusion import optics
from lutcore.errors import ParameterError
from lutcore.lut import PsiTable, even_form, even_forms
from lutcore.materials import Material, material, materials
from lutcore.plane import PlaneTable
from tests.bench.shading_accuracy import plane_error, psi_at, psi_error
from tests.quadrature import paper_factor


@pytest.mark.parametrize("name", materials())
def test_psi_is_within_its_error_of_the_papers_double_integral(name: str) -> None:
    assert psi_error(name, 64) < 1e-6
    assert psi_error(name, 128) < 1e-7


@pytest.mark.parametrize("name", ["skin1", "marble"])
@pytest.mark.parametrize(("a", "b"), [(0.8, 0.5), (0.1, 0.3), (0.0, 0.2), (-0.2, 0.4), (-1.0, 1.0)])
def test_evaluate_is_the_papers_factor(name: str, a: float, b: float) -> None:
    table = bake(name, 128)
    for channel, constants in enumerate(optics(material(name))):
        truth = paper_factor(a, b, constants)
        value = table.evaluate(a, b / table.mean_free_path[channel])[channel]
        assert value == pytest.approx(truth, abs=2e-7)


@pytest.mark.parametrize("name", ["skin1", "wholemilk", "ketchup"])
def test_psi_of_zero_is_its_closed_form(name: str) -> None:
    from scipy.special import k0

    table = bake(name)
    for channel, constants in enumerate(optics(material(name))):
        beta, B = constants.beta, constants.depth
        closed = (k0(beta) + B * k0(B * beta)) / (np.pi * (np.exp(-beta) + np.exp(-B * beta)))
        assert table.psi[channel, 0] == pytest.approx(closed, abs=2e-9)


def test_psi_is_even_positive_and_falls() -> None:
    table = bake("skin1", 256)
    u = np.linspace(0.0, 60.0, 500)
    for channel in range(3):
        psi = psi_at(u, table, channel)
        # even_form(u, 1) - u and even_form(-u, 1): up to the rounding of u.
        lit = [even_form(x, 1.0, table.rows, table.inverse_step, channel) - x for x in u]
        np.testing.assert_allclose(lit, psi, rtol=0.0, atol=2e-14)
        assert (psi >= 0.0).all()
        # The cubics between the last knots may rise by their error.
        assert (np.diff(psi) < 1e-9).all()


@given(a=st.floats(-1.0, 1.0), b=st.floats(0.0, 10.0), factor=st.floats(0.1, 10.0))
def test_the_even_form_is_homogeneous(a: float, b: float, factor: float) -> None:
    table = bake("skin1")
    whole = even_form(factor * a, factor * b, table.rows, table.inverse_step, 0)
    part = even_form(a, b, table.rows, table.inverse_step, 0)
    assert whole == pytest.approx(factor * part, rel=1e-9, abs=1e-12)


def test_no_curvature_is_lambert_exactly() -> None:
    table = bake("skin1")
    a = np.linspace(-1.0, 1.0, 21)
    np.testing.assert_array_equal(table.evaluate(a, 0.0), np.maximum(a, 0.0)[:, None] * table.total)


@pytest.mark.parametrize("kappa", [1e-300, 1e-12, 1e12, 1e300])
def test_extreme_curvature_stays_finite(kappa: float) -> None:
    values = bake("skin1").evaluate([-1.0, -1e-12, 0.0, 1e-12, 1.0], kappa)
    assert np.isfinite(values).all()
    assert (values >= 0.0).all()


def test_nan_reads_no_memory_outside_the_table() -> None:
    table = bake("skin1")
    assert np.isnan(even_form(np.nan, 1.0, table.rows, table.inverse_step, 0))
    assert even_form(1.0, np.inf, table.rows, table.inverse_step, 0) == np.inf


def test_shapes_broadcast() -> None:
    table = bake("skin1")
    assert table.evaluate(0.5, 0.1).shape == (3,)
    assert table.evaluate(np.zeros((4, 1)), np.zeros(5)).shape == (4, 5, 3)
    assert table.evaluate([], 0.1).shape == (0, 3)


@pytest.mark.parametrize(
    ("a", "kappa", "message"),
    [
        (1.1, 0.1, "range"),
        (0.5, -0.1, "negative"),
        (np.nan, 0.1, "finite"),
        ([0.1, 0.2], [0.1, 0.2, 0.3], "broadcast"),
    ],
)
def test_bad_arguments_are_refused(a: object, kappa: object, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        bake("skin1").evaluate(a, kappa)  # type: ignore[arg-type]


def test_the_block_form_equals_the_scalar_one_to_the_last_bit() -> None:
    table = bake("skin1")
    generator = np.random.default_rng(1)
    cosine, kappa = generator.uniform(-1.0, 1.0, 1001), generator.uniform(0.0, 0.5, 1001)
    kappa[::7] = 0.0
    arguments = (table.rows, table.inverse_step, 1)
    weights, corners = np.array([0.7, 0.2]), np.array([0.0, 0.1])
    out = even_forms(weights, corners, cosine, kappa, 0.9, *arguments)
    each = [
        0.7 * even_form(a, 0.9 * k, *arguments) + 0.2 * even_form(a - 0.1, 0.9 * k, *arguments)
        for a, k in zip(cosine, kappa, strict=True)
    ]
    np.testing.assert_array_equal(out, each)


def test_tables_are_shared_and_cannot_be_written() -> None:
    assert bake("skin1") is bake(material("skin1"), 64, "jensen2001")
    assert bake("skin1") is not bake("skin1", 65)
    with pytest.raises(ValueError, match="read-only"):
        bake("skin1").psi[0, 0] = 1.0


def test_arrays_round_trip() -> None:
    table, again = bake("skin1"), PsiTable.from_arrays(bake("skin1").arrays())
    for key, array in table.arrays().items():
        np.testing.assert_array_equal(again.arrays()[key], array)
    plane, copy = bake_plane("skin1", 16), PlaneTable.from_arrays(bake_plane("skin1", 16).arrays())
    np.testing.assert_array_equal(copy.values, plane.values)


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("psi", np.zeros(5), "shape"),
        ("slope", np.zeros((3, 5)), "shape"),
        ("reach", np.zeros(3), "above 0"),
        ("total", [np.nan, 0.0, 0.0], "finite"),
    ],
)
def test_broken_arrays_are_refused(key: str, value: object, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        PsiTable.from_arrays({**bake("skin1").arrays(), key: np.asarray(value)})


def test_missing_arrays_are_named() -> None:
    with pytest.raises(ParameterError, match="slope"):
        PsiTable.from_arrays({"psi": np.zeros((3, 8))})
    with pytest.raises(ParameterError, match="limit"):
        PlaneTable.from_arrays({"values": np.zeros((8, 8, 3))})


@pytest.mark.parametrize("samples", [7, 8193, 64.0, True])
def test_bad_sample_counts_are_refused(samples: object) -> None:
    with pytest.raises(ParameterError, match="samples"):
        bake("skin1", samples)  # type: ignore[arg-type]


def test_unknown_names_are_refused() -> None:
    with pytest.raises(ParameterError, match="jensen2001"):
        bake("skin1", profile="jensen2002")
    with pytest.raises(ParameterError, match="skin1"):
        bake("skin")


def test_without_absorption_reflectance_is_exact_and_the_glow_that_of_the_floor() -> None:
    table = bake("spectralon")
    np.testing.assert_array_equal(table.total, 1.0)
    assert table.floored.all()
    like = material("spectralon")
    # beta^2 = 3 sigma_a/(sigma_s' + sigma_a).
    share = BETA_FLOOR**2 / 3.0
    absorption = tuple(s * share / (1.0 - share) for s in like.scattering)
    at_floor = Material("at the floor", like.scattering, absorption, like.eta)
    # 1 - alpha' keeps 11 of 16 digits at the floor.
    np.testing.assert_allclose(table.psi, bake(at_floor).psi, atol=1e-9)
    np.testing.assert_allclose(table.mean_square, bake(at_floor).mean_square, rtol=1e-9)


def test_the_floor_reflects_99_per_cent_and_spares_what_absorbs() -> None:
    like = material("spectralon")
    absorption = tuple(s * BETA_FLOOR**2 / 3.0 for s in like.scattering)
    at_floor = Material("at the floor", like.scattering, absorption, like.eta)
    np.testing.assert_allclose(bake(at_floor).total, 0.99, atol=5e-4)
    assert not any(bake(name).floored.any() for name in materials() if name != "spectralon")


def test_the_plane_table_is_within_a_thousandth() -> None:
    assert plane_error("skin1", 512) < 1e-3


def test_the_plane_table_s_corners() -> None:
    plane = bake_plane("skin1", 64, 0.5)
    np.testing.assert_allclose(plane.values[0, -1], bake("skin1").total)
    np.testing.assert_array_equal(plane.values[0, 0], 0.0)
    # Beyond the limit the last row stands.
    far = plane.evaluate(0.3, 100.0)
    last = plane.evaluate([0.3] * 3, 0.5 / plane.mean_free_path)
    np.testing.assert_allclose(far, np.diag(last))


@pytest.mark.parametrize("limit", [0.0, 11.0, np.nan])
def test_bad_limits_are_refused(limit: float) -> None:
    with pytest.raises(ParameterError, match="limit"):
        bake_plane("skin1", 16, limit)
