"""The cosine blurred along a circle, against adaptive quadrature and known blurs."""

from itertools import pairwise

import numpy as np
import pytest

from lutcore.blur import blurred

COSINES = np.concatenate((-np.geomspace(1.0, 0.01, 6), [0.0], np.geomspace(0.01, 1.0, 6)))


@pytest.mark.parametrize("s", [1e-3, 0.1, 2.0])
def test_it_is_the_integral(s: float) -> None:
    from scipy.integrate import quad

    def kernel(x):
        return np.exp(-np.sin(0.5 * x) / s)

    def over(integrand, ends):
        # The kernel has a corner at 0, light one at each terminator.
        return sum(
            quad(integrand, low, high, epsabs=1e-13, epsrel=1e-11, limit=400)[0]
            for low, high in pairwise(ends)
        )

    whole = over(kernel, [0.0, 10.0 * s, np.pi] if s < 0.1 else [0.0, np.pi])
    for cosine, value in zip(COSINES, blurred(COSINES, s, kernel), strict=True):
        theta = np.arccos(cosine)
        bends = {0.0, np.pi, abs(0.5 * np.pi - theta), np.pi - abs(0.5 * np.pi - theta)}
        bends |= {min(10.0 * s, np.pi)}

        def both(x, theta=theta):
            lit = max(np.cos(theta + x), 0.0) + max(np.cos(theta - x), 0.0)
            return 0.5 * kernel(x) * lit

        assert value == pytest.approx(over(both, sorted(bends)) / whole, abs=1e-9)


def test_an_even_kernel_gives_the_mean_everywhere() -> None:
    np.testing.assert_allclose(blurred(COSINES, 1.0, np.ones_like), 1.0 / np.pi, atol=1e-14)


def test_a_narrow_gaussian_glows_by_its_width_at_the_terminator() -> None:
    sigma = 1e-3
    value = blurred(COSINES, sigma, lambda x: np.exp(-0.5 * (x / sigma) ** 2))
    # E max(0, sigma X) = sigma/sqrt(2 pi), to second order in sigma.
    assert value[6] == pytest.approx(sigma / np.sqrt(2.0 * np.pi), rel=1e-6)
    assert value[-1] == pytest.approx(np.exp(-0.5 * sigma**2), abs=1e-12)
    assert value[0] == pytest.approx(0.0, abs=1e-15)
