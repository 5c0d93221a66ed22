import colour
import numpy as np
import pytest

from lutcore.color import (
    _steps,
    auto_exposure,
    product_bytes,
    product_exposure,
    srgb_bytes,
    srgb_decode,
)
from lutcore.metrics import ciede2000, ciede2000_lab


def test_encoding_is_the_standards_to_the_rounded_byte():
    linear = np.random.default_rng(1).random((5000, 3))
    peer = colour.cctf_encoding(linear, function="sRGB")
    np.testing.assert_array_equal(srgb_bytes(linear, 1.0), np.floor(255.0 * peer + 0.5))


def test_values_beyond_the_display_are_clipped_not_wrapped():
    beyond = np.array([[-1.0, 0.0, 2.0], [1.0, 1e9, -1e9]])
    assert srgb_bytes(beyond, 1.0).tolist() == [[0, 0, 255], [255, 255, 0]]


def test_decoding_undoes_encoding_within_half_a_byte():
    bytes_ = np.arange(256)
    linear = srgb_decode(np.repeat(bytes_[:, None] / 255.0, 3, axis=1))
    np.testing.assert_array_equal(srgb_bytes(linear, 1.0), np.repeat(bytes_[:, None], 3, axis=1))


def test_exposure_scales_light_not_bytes():
    linear = np.full((1, 3), 0.2)
    np.testing.assert_array_equal(srgb_bytes(linear, 2.0), srgb_bytes(2.0 * linear, 1.0))


def test_automatic_exposure_brings_the_bright_end_to_white_and_leaves_black_alone():
    linear = np.linspace(0.0, 4.0, 1001)[:, None] * (1.0, 0.5, 0.25)
    shown = np.percentile((auto_exposure(linear) * linear).max(axis=1)[1:], 99.0)
    assert shown == np.float64(0.85) or abs(shown - 0.85) < 1e-12
    assert auto_exposure(np.zeros((4, 3))) == 1.0


# Pairs 1, 7, 17 and 25 of Sharma, Wu and Dalal 2005, table 1.
@pytest.mark.parametrize(
    ("one", "other", "apart"),
    [
        ((50.0, 2.6772, -79.7751), (50.0, 0.0, -82.7485), 2.0425),
        ((50.0, 0.0, 0.0), (50.0, -1.0, 2.0), 2.3669),
        ((50.0, 2.5, 0.0), (73.0, 25.0, -18.0), 27.1492),
        ((60.2574, -34.0099, 36.2677), (60.4626, -34.1751, 39.4387), 1.2644),
    ],
)
def test_the_difference_is_ciede2000s(one, other, apart):
    assert ciede2000_lab(np.array(one), np.array(other)) == pytest.approx(apart, abs=5e-5)


def test_the_difference_of_bytes_is_that_of_the_colours_they_show():
    black, white = np.zeros((1, 3), np.uint8), np.full((1, 3), 255, np.uint8)
    assert abs(ciede2000(black, white)[0] - 100.0) < 0.01
    assert ciede2000(white, white)[0] == 0.0


@pytest.mark.parametrize("columns", [1, 3])
def test_the_exposure_of_a_product_is_that_of_its_values(columns):
    random = np.random.default_rng(3)
    light = np.maximum(random.normal(size=(5_000, 3)), 0.0)
    factor = random.uniform(size=(5_000, columns))
    assert product_exposure(light, factor) == auto_exposure(light * factor)
    assert product_exposure(0.0 * light, factor) == 1.0


def test_bytes_of_a_product_are_those_of_its_values():
    random = np.random.default_rng(0)
    light = random.uniform(0.0, 1.2, (20_000, 3)) ** 3
    for factor in (random.uniform(size=(20_000, 1)), random.uniform(size=(20_000, 3))):
        for exposure in (1.0, 2.37):
            np.testing.assert_array_equal(
                product_bytes(light, factor, exposure), srgb_bytes(light * factor, exposure)
            )


def test_bytes_of_a_product_step_at_the_same_doubles():
    steps = _steps()[0][1:256]
    one = np.ones((85, 1))
    for values in (steps, np.nextafter(steps, 0.0), np.nextafter(steps, 2.0)):
        table = values.reshape(-1, 3)
        np.testing.assert_array_equal(product_bytes(table, one, 1.0), srgb_bytes(table, 1.0))
