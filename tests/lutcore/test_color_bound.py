"""The bound on how different an error of light may look."""

import numpy as np
import pytest

from lutcore.arrays import FloatArray
from lutcore.color import auto_exposure, srgb_decode
from lutcore.color_bound import color_bound
from lutcore.tolerance import color_differences

ONE = np.ones(3)


def colors(generator: np.random.Generator, count: int) -> FloatArray:
    """Return encoded colours, half of them near the greys, where CIEDE2000 bends most."""
    every = generator.random((count, 3))
    grey = generator.random((count // 2, 1)) + 0.08 * generator.standard_normal((count // 2, 3))
    every[: count // 2] = np.clip(grey, 0.0, 1.0)
    return every


def drawn(seed: int, count: int) -> tuple[FloatArray, FloatArray, float]:
    """Return light, errors of it and its exposure."""
    generator = np.random.default_rng(seed)
    light = srgb_decode(colors(generator, count))
    size = np.exp(generator.uniform(np.log(1e-4), np.log(0.1), (count, 1)))
    errors = size * np.exp(generator.normal(0.0, 0.7, (count, 3)))
    return light, errors, auto_exposure(light)


def test_it_bounds_what_errors_do_to_colours() -> None:
    light, errors, exposure = drawn(0, 40_000)
    true = color_differences(light, errors)
    bound = color_bound(light, errors, ONE, exposure)
    for low, high, least in ((0.05, 1.0, 0.99), (1.0, 2.0, 0.98), (2.0, 4.0, 0.96)):
        here = (true > low) & (true <= high)
        assert np.mean(bound[here] >= true[here]) > least
        assert np.median(bound[here] / true[here]) < 1.35
    # All that is much beyond a tolerance of 2 is found to be beyond it.
    assert np.mean(bound[true > 4.0] > 2.0) > 0.999


def test_it_follows_colour_and_error_without_a_step() -> None:
    # Along a straight way through the cube, over faces of its cells, past grey and beyond white.
    t = np.linspace(0.0, 1.0, 20_001)[:, None]
    for seed in range(5):
        generator = np.random.default_rng(seed)
        start, end = generator.random((2, 3))
        light = start + t * (1.5 * end - start)
        errors = 0.01 + 0.02 * t * generator.random(3)
        steps = np.abs(np.diff(color_bound(light, errors, ONE, 1.0)))
        assert steps.max() < 0.02


def test_units_and_exposure_are_factors() -> None:
    light, errors, exposure = drawn(1, 500)
    total = np.array([0.8, 0.5, 0.3])
    given = color_bound(light, errors / total, total, exposure)
    np.testing.assert_allclose(given, color_bound(exposure * light, exposure * errors, ONE, 1.0))


@pytest.mark.parametrize("value", [0.0, 4.0])
def test_the_ends_of_the_scale(value: float) -> None:
    light, errors = np.full((1, 3), value), np.full((1, 3), 1e-3)
    bound = color_bound(light, errors, ONE, 1.0)
    if value > 1.0:
        assert bound == 0.0  # white, whatever it is
    else:
        assert bound >= color_differences(light, errors)
    assert color_bound(light, 0.0 * errors, ONE, 1.0) == 0.0
    assert color_bound(light[:0], errors[:0], ONE, 1.0).shape == (0,)
