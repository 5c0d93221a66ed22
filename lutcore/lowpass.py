"""Smoothing of fields over a mesh to several scales at once, by polynomials of its Laplacian.

A scale's filter is the polynomial p(L) that, of all of its degree, passes the least noise of
curvature and leaves quadratics of the surface alone: p(0) = 1 and p'(0) = 0. Truncated Gaussians
need twice to three times the products with L for the same effect.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache

import numpy as np

from lutcore.arrays import FloatArray, SingleArray
from lutcore.laplacian import Laplacian
from lutcore.progress import Progress, silent, tell
from lutcore.recurrence import FIELDS, add_step, apply, begin, go_on, step

# Filters of lower degree cannot fulfil both conditions with something to spare.
_LEAST_DEGREE, _LARGEST_DEGREE = 3, 40_000


def low_pass(
    operator: Laplacian,
    fields: FloatArray,
    scales: Sequence[float],
    progress: Progress = silent,
) -> SingleArray:
    """Return how far smoothing moves the fields, (p_s(L) - 1) f for each scale s.

    The recurrence runs on y f, with y = L/bound, rather than on f: what it carries is as small as
    the change it computes, so single precision loses nothing, however far the mesh extends.

    Parameters
    ----------
    operator : Laplacian
        The Laplacian L.
    fields : ndarray, shape=(n, 6)
        The fields f.
    scales : sequence of float
        Standard deviations of the Gaussians that would let through as much noise of curvature,
        mesh units.
    progress : callable
        Told where the work stands.

    Returns
    -------
    ndarray of float32, shape=(S, n, 6)
        The changes, scale by scale.

    References
    ----------
    D. Hammond, P. Vandergheynst, R. Gribonval, Wavelets on graphs via spectral graph theory,
    Appl. Comput. Harmon. Anal. 30, 2011 (the recurrence).
    """
    return filtered(
        operator, fields, [series_at(scale, operator.bound) for scale in scales], progress
    )


def filtered(
    operator: Laplacian,
    fields: FloatArray,
    series: Sequence[FloatArray],
    progress: Progress = silent,
) -> SingleArray:
    """Return how far any polynomials of the Laplacian move the fields, (p(L) - 1) f for each.

    Parameters
    ----------
    operator : Laplacian
        The Laplacian L.
    fields : ndarray, shape=(n, 6)
        The fields f.
    series : sequence of ndarray
        Of each polynomial, the Chebyshev coefficients of (p - 1)/y on 0 <= y <= 1, y = L/bound;
        see `series_at` and `series_of`.
    progress : callable
        Told where the work stands.

    Returns
    -------
    ndarray of float32, shape=(S, n, 6)
        The changes, one after the other.
    """
    terms = max(len(one) for one in series)
    # An even number: terms are added to the scales in pairs, which halves the traffic to memory.
    weights = np.zeros((terms + terms % 2, len(series)), np.float32)
    for column, one in enumerate(series):
        weights[: len(one), column] = one
    links = (*operator.links, operator.rate)
    before = np.empty((len(fields), FIELDS), np.float32)
    apply(*links, fields, 0.5, before)
    change = np.empty((len(series), len(before), FIELDS), np.float32)
    now = np.zeros_like(before)
    step(*links, before, now, np.float32(0.5))
    begin(before, now, weights[0], weights[1], change)
    if len(operator.parts) > 2:
        go_on(operator.parts, *links, now, before, change, weights)
        return change
    for term in range(2, len(weights), 2):
        if term % 8 == 0:
            tell(progress, term / terms, "smoothing")
        step(*links, now, before, np.float32(1.0))
        add_step(*links, before, now, change, weights[term], weights[term + 1])
    return change


def degree(scale: float, bound: float) -> int:
    """Return how many products with the Laplacian a scale takes.

    Parameters
    ----------
    scale : float
        The scale, mesh units.
    bound : float
        The Laplacian's, 1/mesh unit squared.

    Returns
    -------
    int
        The least degree of a filter that smooths that much.
    """
    strengths = _strengths()
    return min(int(np.searchsorted(strengths, 0.5 * scale * scale * bound)), len(strengths) - 1)


@lru_cache(maxsize=1)
def _strengths() -> FloatArray:
    """Return, for each degree, t bound of the Gaussian exp(-t L) that passes as much noise.

    White noise of the vertices becomes noise of curvature through L p(L), and eigenvalues lie
    evenly below some bound, so the variance is I = int y^2 p^2 dy with y = L/bound; for the
    Gaussian it is 1/(4 (t bound)^3). The least I under p(0) = 1, p'(0) = 0 is an entry of the
    inverse of the Gram matrix of those two conditions, written in the Jacobi polynomials that
    are orthonormal under y^2.
    """
    k = np.arange(_LARGEST_DEGREE + 1.0)
    value = np.sqrt(2.0 * k + 3.0) * 0.5 * (k + 1.0) * (k + 2.0)
    slope = -value * k * (k + 3.0) / 3.0
    both, across, slopes = (np.cumsum(term) for term in (value**2, value * slope, slope**2))
    with np.errstate(divide="ignore", invalid="ignore"):  # degree 0 has no slope
        inverse = both - across**2 / slopes
    strength = np.cbrt(inverse / 4.0)
    strength[:_LEAST_DEGREE] = 0.0
    return strength


def _filter(degree_: int, y: FloatArray) -> FloatArray:
    """Return the filter of a degree at y = L/bound.

    Orthogonal under y^4 to all of degree K - 2 and less, so a J_K + (1 - a) J_(K-1) with Jacobi
    polynomials J normalised to 1 at 0; their slope there is -K (K + 5)/5.
    """
    share = -(degree_ - 1.0) * (degree_ + 4.0) / (2.0 * degree_ + 4.0)
    high, low = _jacobi(degree_, y)
    return share * high + (1.0 - share) * low


def _jacobi(degree_: int, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the Jacobi polynomials of a degree and of one less, orthogonal under y^4, 1 at 0.

    By their recurrence: SciPy has them too, and takes a fifth of a second to import.
    """
    before, now = np.ones_like(y), 1.0 - 1.2 * y
    for n in range(2, degree_ + 1):
        # DLMF 18.9.2 with alpha = 4 and beta = 0, each divided by its value at 0, binom(n + 4, n).
        after = (2 * n + 3) * (4 * (n + 1) * (n + 2) * (1.0 - 2.0 * y) + 16.0) * now
        after -= 4 * (n - 1) ** 2 * (n + 2) * before
        after /= 4 * (n + 1) * (n + 4) ** 2
        before, now = now, after
    return now, before


@lru_cache(maxsize=64)
def series_at(scale: float, bound: float) -> FloatArray:
    """Return the polynomial of a scale, for `filtered`.

    Parameters
    ----------
    scale : float
        As for `low_pass`, mesh units.
    bound : float
        The Laplacian's, 1/mesh unit squared.

    Returns
    -------
    ndarray
        Chebyshev coefficients of (p - 1)/y on 0 <= y <= 1, y = L/bound; kept, not to be written.
    """
    strength = 0.5 * scale * scale * bound
    k = max(degree(scale, bound), _LEAST_DEGREE)
    # Degrees are whole numbers: a bound that is larger by as much makes the scale exact.
    ample = max(1.0, float(_strengths()[k]) / strength)
    y = _nodes(2 * k)
    found = _coefficients((_filter(k, y / ample) - 1.0) / y)[:k]
    found.flags.writeable = False
    return found


def series_of(
    response: Callable[[FloatArray], FloatArray], bound: float, tolerance: float
) -> FloatArray:
    """Return the least polynomial that follows a response, for `filtered`.

    Parameters
    ----------
    response : callable
        From eigenvalues of the Laplacian, 1/mesh unit squared, to what is left of them; 1 at 0.
    bound : float
        The Laplacian's.
    tolerance : float
        How far the polynomial may be off, above 0; it is 1 at 0.

    Returns
    -------
    ndarray
        Chebyshev coefficients of (p - 1)/y on 0 <= y <= 1, y = L/bound.
    """
    size = 64
    while True:
        found = _coefficients(response(bound * _nodes(size)))
        rest = np.cumsum(np.abs(found[::-1]))[::-1]
        terms = max(int(np.searchsorted(-rest, -tolerance)), 2)
        if terms <= size // 2 or size >= _LARGEST_DEGREE:
            break
        size *= 2
    kept = found[:terms]
    y = _nodes(terms)
    start = np.sum(kept[::2]) - np.sum(kept[1::2])  # T_k(-1) = (-1)^k
    values = np.polynomial.chebyshev.chebval(2.0 * y - 1.0, kept) / start
    return _coefficients((values - 1.0) / y)[:-1]


def _nodes(size: int) -> FloatArray:
    """Return the Chebyshev nodes of 0 <= y <= 1."""
    return 0.5 * (1.0 + np.cos(np.pi * (np.arange(size) + 0.5) / size))


def _coefficients(values: FloatArray) -> FloatArray:
    """Return as many Chebyshev coefficients as there are values at `_nodes`."""
    size = len(values)
    # The cosine transform, as the Fourier transform of the values and their mirror image.
    turned = np.fft.rfft(np.concatenate([values, values[::-1]]))[:size]
    coefficients: FloatArray = (turned * np.exp(-0.5j * np.pi * np.arange(size) / size)).real / size
    coefficients[0] *= 0.5
    return coefficients
