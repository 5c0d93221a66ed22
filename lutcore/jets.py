"""Height functions fitted by least squares: jets, and the shape operators that they mean."""

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled
from lutcore.tensors import Vector, tangent_frame

# Smallest pivot of the normal equations, as a share of the diagonal, that is more than rounding.
_SINGULAR = 1e-9
TERMS = (0, 4, 6, 10)
"""Unknowns by degree.

Degree 1 stands for the sphere-like 1, x, y, x^2 + y^2, which the five or six vertices of a speck
still determine.
"""


@compiled()
def fit_jet(local: FloatArray, degree: int) -> tuple[bool, FloatArray, float]:
    """Fit a polynomial height function by least squares.

    Parameters
    ----------
    local : ndarray, shape=(m, 3)
        Points x, y and heights, of about unit size.
    degree : int
        0 to 3; 1 stands for 1, x, y, x^2 + y^2.

    Returns
    -------
    solved : bool
        Whether the points determine it.
    jet : ndarray, shape=(5,)
        fx, fy, fxx, fxy, fyy at the origin.
    noise : float
        Standard deviation of the principal curvatures by the residuals.
    """
    terms = TERMS[degree]
    jet = np.zeros(5)
    if degree == 0:  # flat, as far as its size can tell
        return True, jet, 1.0
    if len(local) < terms:
        return False, jet, 0.0
    normal = np.zeros((terms, terms))
    right = np.zeros(terms)
    row = np.empty(10)
    for at in range(len(local)):
        _monomials(local[at, 0], local[at, 1], degree, row)
        for a in range(terms):
            right[a] += row[a] * local[at, 2]
            for b in range(a + 1):
                normal[a, b] += row[a] * row[b]
    if not _factor(normal):
        return False, jet, 0.0
    found = right.copy()
    _substitute(normal, found)
    jet[0], jet[1] = found[1], found[2]
    if degree == 1:
        jet[2] = jet[4] = 2.0 * found[3]
    else:
        jet[2], jet[3], jet[4] = 2.0 * found[3], found[4], 2.0 * found[5]
    square = 0.0
    for at in range(len(local)):
        _monomials(local[at, 0], local[at, 1], degree, row)
        off = local[at, 2]
        for a in range(terms):
            off -= row[a] * found[a]
        square += off * off
    spare = len(local) - terms
    if spare == 0:  # no residual to judge by: no better than the value itself
        return True, jet, np.sqrt(0.5 * (jet[2] ** 2 + jet[4] ** 2) + jet[3] ** 2)
    # Half the squared norm of the tensor's noise, as for every error bar; f_xx = 2 c_xx.
    total = 0.0
    for term, weight in ((3, 2.0 if degree > 1 else 4.0), (4, 1.0), (5, 2.0)):
        if term >= terms:
            break
        unit = np.zeros(terms)
        unit[term] = 1.0
        _substitute(normal, unit)
        total += weight * unit[term]
    return True, jet, np.sqrt(total * square / spare)


@compiled()
def _monomials(x: float, y: float, degree: int, row: FloatArray) -> None:
    row[0], row[1], row[2] = 1.0, x, y
    row[3], row[4], row[5] = x * x, x * y, y * y
    if degree == 1:
        row[3] += row[5]
    row[6], row[7], row[8], row[9] = x * x * x, x * x * y, x * y * y, y * y * y


@compiled()
def _factor(matrix: FloatArray) -> bool:
    """Replace the lower half of a matrix by its Cholesky factor; False if it is singular."""
    for a in range(len(matrix)):
        least = _SINGULAR * matrix[a, a]
        for b in range(a + 1):
            value = matrix[a, b]
            for c in range(b):
                value -= matrix[a, c] * matrix[b, c]
            if a == b:
                if value <= least:
                    return False
                matrix[a, a] = np.sqrt(value)
            else:
                matrix[a, b] = value / matrix[b, b]
    return True


@compiled()
def _substitute(factor: FloatArray, right: FloatArray) -> None:
    """Replace a right-hand side by the solution, forwards and backwards."""
    size = len(factor)
    for a in range(size):
        for b in range(a):
            right[a] -= factor[a, b] * right[b]
        right[a] /= factor[a, a]
    for a in range(size - 1, -1, -1):
        for b in range(a + 1, size):
            right[a] -= factor[b, a] * right[b]
        right[a] /= factor[a, a]


@compiled()
def operator_of(
    jet: FloatArray, n: Vector, u: Vector, v: Vector, size: float
) -> tuple[Vector, tuple[float, float, float]]:
    """Return the normal of a jet at the origin, and the shape operator there.

    Parameters
    ----------
    jet : ndarray, shape=(5,)
        From `fit_jet`.
    n, u, v : tuple of float
        The frame that its heights, x and y are along.
    size : float
        Length of its unit.

    Returns
    -------
    normal : tuple of float
        Unit normal.
    tensor : tuple of float
        Entries xx, xy, yy in the normal's `tangent_frame`: the second fundamental form in an
        orthonormal basis of the first (Cazals and Pouget 2005, section 2).
    """
    steepness = np.sqrt(1.0 + jet[0] ** 2 + jet[1] ** 2)
    m = (
        (n[0] - jet[0] * u[0] - jet[1] * v[0]) / steepness,
        (n[1] - jet[0] * u[1] - jet[1] * v[1]) / steepness,
        (n[2] - jet[0] * u[2] - jet[1] * v[2]) / steepness,
    )
    p, q = tangent_frame(m[0], m[1], m[2])
    # A tangent vector is a (1, 0, fx) + b (0, 1, fy): a and b are its parts along u and v.
    pa = p[0] * u[0] + p[1] * u[1] + p[2] * u[2]
    pb = p[0] * v[0] + p[1] * v[1] + p[2] * v[2]
    qa = q[0] * u[0] + q[1] * u[1] + q[2] * u[2]
    qb = q[0] * v[0] + q[1] * v[1] + q[2] * v[2]
    factor = -1.0 / (steepness * size)  # heights fall where the surface is convex
    return m, (
        factor * (jet[2] * pa * pa + 2.0 * jet[3] * pa * pb + jet[4] * pb * pb),
        factor * (jet[2] * pa * qa + jet[3] * (pa * qb + pb * qa) + jet[4] * pb * qb),
        factor * (jet[2] * qa * qa + 2.0 * jet[3] * qa * qb + jet[4] * qb * qb),
    )
