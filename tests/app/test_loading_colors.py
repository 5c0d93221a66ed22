import numpy as np
import pytest

from app.loading.colors import normalized
from lutcore.color import srgb_decode, srgb_encode


@pytest.mark.parametrize(
    ("stored", "expected"),
    [
        (np.array([[0, 51, 255]], "u1"), [0, 0.2, 1]),
        (np.array([[0, 13107, 65535]], "<u2"), [0, 0.2, 1]),
        (np.array([[0, 13107, 65535]], ">u2"), [0, 0.2, 1]),
        (np.array([[0, 51, 255]], ">i4"), [0, 0.2, 1]),
        (np.array([[0, 1, 1]], "i4"), [0, 1 / 255, 1 / 255]),
        (np.array([[0.0, 0.2, 1.0]]), [0, 0.2, 1]),
        (np.array([[0.0, 51.0, 255.0, 77.0]]), [0, 0.2, 1]),
    ],
)
def test_colours_of_any_type_become_shares(stored, expected):
    warnings = []
    # One rounding of a division in float64.
    np.testing.assert_allclose(normalized(stored, warnings)[0], expected, rtol=2**-52)
    assert warnings == []


@pytest.mark.parametrize("bad", [np.nan, np.inf, -0.1, 256.0])
def test_numbers_that_are_no_colours_are_dropped_aloud(bad):
    warnings = []
    assert normalized(np.array([[0.0, 0.5, bad]]), warnings) is None
    assert "not used" in warnings[0]


@pytest.mark.parametrize("above", [1.00001, 1.5, 2.0])
def test_shares_a_little_above_one_are_clipped_aloud_and_not_taken_for_bytes(above):
    warnings = []
    colors = normalized(np.array([[0.0, 0.5, above], [0.25, 1.0, 0.0]]), warnings)
    assert colors.tolist() == [[0.0, 0.5, 1.0], [0.25, 1.0, 0.0]]
    assert warnings == ["some vertex colours are not between 0 and 1: clipped"]


@pytest.mark.parametrize(("beyond", "clipped"), [(40.0, 1.0), (300.0, 1.0), (-0.25, 0.0)])
def test_shares_by_definition_are_clipped_however_large(beyond, clipped):
    warnings = []
    colors = normalized(np.array([[0.0, 0.5, beyond]]), warnings, floats_are_shares=True)
    assert colors.tolist() == [[0.0, 0.5, clipped]]
    assert "clipped" in warnings[0]


def test_whole_numbers_are_scaled_by_their_type_even_where_floats_are_shares():
    colors = normalized(np.array([[0, 51, 255]], "u1"), [], floats_are_shares=True)
    assert colors.tolist() == [[0.0, 51 / 255, 1.0]]


def test_encoding_is_undone_by_decoding():
    linear = np.linspace(0.0, 1.0, 1001)
    # The standard's constants are rounded to five digits where its two branches meet.
    np.testing.assert_allclose(srgb_decode(srgb_encode(linear)), linear, atol=1e-7)
