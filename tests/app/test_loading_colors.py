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


def test_encoding_is_undone_by_decoding():
    linear = np.linspace(0.0, 1.0, 1001)
    # The standard's constants are rounded to five digits where its two branches meet.
    np.testing.assert_allclose(srgb_decode(srgb_encode(linear)), linear, atol=1e-7)
