"""Lambert's cosine blurred along a circle: what pre-integrated models tabulate."""

from collections.abc import Callable

import numpy as np

from lutcore.arrays import FloatArray

_NODES = 12
# Panels between these and the terminator's own knots.
_GRADED, _FINEST = 32, 0.003


def blurred(
    cosines: FloatArray, s: float, kernel: Callable[[FloatArray], FloatArray]
) -> FloatArray:
    """Return int K(x) max(cos(theta + x), 0) dx / int K dx over the whole circle.

    With a = cos theta >= 0, A = pi/2 + theta and B = pi/2 - theta, the lit arc is -A < x < B, and

        int = a [C(A) + C(B)] + sqrt(1 - a^2) [S(A) - S(B)],

    C and S being the integrals of K cos and K sin from 0. For a < 0 the even kernel gives
    D(a) = D(-a) + a <cos>, <cos> = 2 C(pi)/int K.

    Parameters
    ----------
    cosines : ndarray, shape=(n,)
        a from -1 to 1, ascending and symmetric about a middle 0.
    s : float
        Angle on whose scale the kernel varies, with detail down to a hundredth of it at 0.
    kernel : callable
        K(x) for angles 0 < x < pi; it is even and periodic, and need not be normalised.

    Returns
    -------
    ndarray, shape=(n,)
        1 at most.
    """
    half = cosines[len(cosines) // 2 :]
    before, behind = np.arcsin(half), np.pi - np.arcsin(half)  # B and A
    graded = np.geomspace(min(_FINEST * s, 1.0), np.pi, _GRADED)
    edges, where = np.unique(
        np.concatenate((before, behind, graded, [0.0, np.pi])), return_inverse=True
    )
    node, weight = np.polynomial.legendre.leggauss(_NODES)
    width = 0.5 * np.diff(edges)[:, None]
    x = 0.5 * (edges[1:] + edges[:-1])[:, None] + width * node
    weighted = width * weight * kernel(x)
    even, odd = ((weighted * turn).sum(axis=1) for turn in (np.cos(x), np.sin(x)))
    C, S = (np.concatenate(([0.0], np.cumsum(part))) for part in (even, odd))
    whole = 2.0 * weighted.sum()
    B, A = where[: len(half)], where[len(half) : 2 * len(half)]
    sine = np.sqrt(1.0 - half * half)
    bright = (half * (C[A] + C[B]) + sine * (S[A] - S[B])) / whole
    dark = bright[:0:-1] - half[:0:-1] * 2.0 * C[-1] / whole
    return np.concatenate((dark, bright))
