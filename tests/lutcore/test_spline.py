"""Splines on even knots."""

import numpy as np
import pytest

from lutcore.spline import spline_at, spline_coefficients, spline_weights


def test_a_bicubic_polynomial_is_read_back_exactly() -> None:
    def polynomial(x, y):
        return 1.0 + x - 2.0 * x * y**2 + 0.3 * x**3 - 0.1 * x**2 * y**3

    grid = np.meshgrid(np.arange(6.0), np.arange(8.0), indexing="ij")
    coefficients = spline_coefficients(spline_coefficients(polynomial(*grid), 0), 1)
    assert coefficients.shape == (8, 10)
    for x, y in np.random.default_rng(0).uniform((0.0, 0.0), (5.0, 7.0), (50, 2)):
        # Values up to 1e3, solved for along two axes.
        assert spline_at(coefficients, x, y) == pytest.approx(polynomial(x, y), abs=1e-10)


def test_it_goes_through_its_knots_and_converges_with_the_fourth_power() -> None:
    errors = []
    for count in (21, 41, 81):
        knots = np.linspace(0.0, 3.0, count)
        coefficients = spline_coefficients(np.tile(np.exp(knots), (5, 1)), 1)
        coefficients = spline_coefficients(coefficients, 0)
        at = [spline_at(coefficients, 2.0, float(k)) for k in range(count)]
        np.testing.assert_allclose(at, np.exp(knots), rtol=1e-13)
        x = np.linspace(0.0, 3.0, 333)
        read = [spline_at(coefficients, 1.7, v / 3.0 * (count - 1)) for v in x]
        errors.append(np.abs(read - np.exp(x)).max())
    assert errors[0] / errors[1] > 13.0
    assert errors[1] / errors[2] > 13.0


@pytest.mark.parametrize(("position", "same"), [(-3.0, 0.0), (9.5, 7.0), (np.nan, 0.0)])
def test_outside_it_is_held(position: float, same: float) -> None:
    held, there = spline_weights(position, 7), spline_weights(same, 7)
    assert held == there
    assert sum(held[1:]) == pytest.approx(1.0, abs=1e-15)


def test_too_few_knots_are_refused() -> None:
    with pytest.raises(ValueError, match="4 knots"):
        spline_coefficients(np.zeros(4), 0)
