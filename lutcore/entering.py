"""Where the light that leaves a place of a curved body has entered it.

Oblique light scatters first at a distance from where it enters, away from the light: s sin(t),
t being the angle of refraction and s an exponential path of mean l_u, from whose end a part
exp(-beta s cos(t)) comes back. On average over that part it is g |w_t|, g = l_u/(eta (1 + beta m)),
m = cos(t), since |w_t| = eta sin(t). From there diffusion spreads it evenly. To first order in
curvature, what leaves a place has therefore entered where the normal is N + g S w_t.
"""

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled


@compiled()
def bulging(shape: FloatArray, vertex: int, x: float, y: float, z: float) -> float:
    """Return w_t.S+ w_t, the normal curvature along the light times |w_t|^2.

    Parameters
    ----------
    shape : ndarray, shape=(n, 6)
        `lutcore.shading.ShadingInputs.shape`.
    vertex : int
        Which vertex.
    x, y, z : float
        Unit vector w to the light. S+ is tangent, so w itself stands for its tangent part w_t.

    Returns
    -------
    float
        1/mm, 0 or more.
    """
    straight = shape[vertex, 0] * x * x + shape[vertex, 1] * y * y + shape[vertex, 2] * z * z
    mixed = shape[vertex, 3] * x * y + shape[vertex, 4] * y * z + shape[vertex, 5] * x * z
    bulge: float = straight + 2.0 * mixed
    return bulge


@compiled()
def _lit(cosine: float) -> float:
    return min(max(cosine, 0.0), 1.0)


@compiled()
def _inner(lit: float, eta: float) -> float:
    inner: float = np.sqrt(1.0 - (1.0 - lit * lit) / (eta * eta))
    return inner


@compiled()
def _displacement(inner: float, beta: float, eta: float, length: float, squares: float) -> float:
    # g in mm, kept below the least radius of curvature: no light enters beyond the body.
    g = length / (eta * (1.0 + beta * inner))
    bounded: float = g / np.sqrt(1.0 + g * g * squares)
    return bounded


@compiled()
def entry_cosines(
    cosine: FloatArray,
    kappa: FloatArray,
    bulge: FloatArray,
    squares: FloatArray,
    beta: float,
    eta: float,
    length: float,
) -> FloatArray:
    """Return the cosine of light where it has entered.

    Parameters
    ----------
    cosine : ndarray, shape=(m,)
        N.w where it leaves.
    kappa, bulge : ndarray, shape=(m,)
        |S+ w_t| and w_t.S+ w_t, 1/mm.
    squares : ndarray, shape=(m,)
        Sum of the squares of the convex curvatures, 1/mm^2.
    beta : float
        l_u/l_d.
    eta : float
        Refractive index relative to the outside.
    length : float
        l_u, mm.

    Returns
    -------
    ndarray, shape=(m,)
        Of N + g S+ w_t, made a unit vector.
    """
    entry = np.empty(len(cosine))
    for k in range(len(cosine)):
        g = _displacement(_inner(_lit(cosine[k]), eta), beta, eta, length, squares[k])
        entry[k] = (cosine[k] + g * bulge[k]) / np.sqrt(1.0 + (g * kappa[k]) ** 2)
    return entry


@compiled()
def entry_factors(
    entry: FloatArray,
    bulge: FloatArray,
    trace: FloatArray,
    squares: FloatArray,
    lost: FloatArray,
    beta: float,
    eta: float,
    length: float,
) -> FloatArray:
    """Return what the light that enters there is multiplied by, D rho/J.

    Parameters
    ----------
    entry : ndarray, shape=(m,)
        What `entry_cosines` returned.
    bulge : ndarray, shape=(m,)
        w_t.S+ w_t, 1/mm.
    trace, squares : ndarray, shape=(m,)
        Sums of the convex curvatures, 1/mm, and of their squares, 1/mm^2.
    lost : ndarray, shape=(3, m)
        1/rho, the inverse of the share that leaves, as a polynomial in the inner cosine.
    beta : float
        l_u/l_d.
    eta : float
        Refractive index relative to the outside.
    length : float
        l_u, mm.

    Returns
    -------
    ndarray, shape=(m,)
        D = 1 + beta g^2 w_t.S+ w_t, for under a convex surface a path meets less depth, times
        rho, over J = (1 + g c k1)(1 + g c k2), by which the displacement widens the surface.
    """
    factors = np.empty(len(entry))
    for k in range(len(entry)):
        lit = _lit(entry[k])
        inner = _inner(lit, eta)
        g = _displacement(inner, beta, eta, length, squares[k])
        product = 0.5 * (trace[k] ** 2 - squares[k])  # k1 k2
        wider = 1.0 + g * lit * (trace[k] + g * lit * product)
        depth = 1.0 + beta * g * g * bulge[k] / length
        inverse_rho = lost[0, k] + inner * (lost[1, k] + inner * lost[2, k])
        factors[k] = depth / (wider * inverse_rho)
    return factors
