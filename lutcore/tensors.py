"""Symmetric 2 x 2 tensors in tangent planes, for compiled loops: solve, rotate, decompose."""

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled

Vector = tuple[float, float, float]

# det C over its square trace: below, the pairs lie on a line to rounding.
_SINGULAR = 1e-28


@compiled()
def tangent_frame(x: float, y: float, z: float) -> tuple[Vector, Vector]:
    """Return two unit vectors at right angles to a unit vector, right-handed with it.

    Parameters
    ----------
    x, y, z : float
        The unit vector n.

    Returns
    -------
    tuple of tuple of float
        Vectors u and v with u x v = n.

    References
    ----------
    T. Duff et al., Building an orthonormal basis, revisited, JCGT 6 (1), 2017.
    """
    sign = 1.0 if z >= 0.0 else -1.0
    a = -1.0 / (sign + z)
    b = x * y * a
    return (1.0 + sign * x * x * a, sign * b, -sign * x), (b, sign + y * y * a, -y)


@compiled()
def symmetric_fit(
    cxx: float, cxy: float, cyy: float, bxx: float, bxy: float, byy: float
) -> tuple[float, float, float]:
    """Return the symmetric S that minimises sum |dn - S dx|^2 over pairs (dx, dn).

    Parameters
    ----------
    cxx, cxy, cyy : float
        C = sum dx dx^T, positive definite.
    bxx, bxy, byy : float
        Symmetric part of B = sum dn dx^T.

    Returns
    -------
    tuple of float
        Entries xx, xy, yy of S; zero where all dx are parallel, which determines no S.

    Notes
    -----
    The normal equations are S C + C S = B + B^T. In the plane their solution is
    S = (Q + adj(C) Q adj(C) / det C) / tr C with Q = (B + B^T)/2: no pivoting, and exact to
    rounding times the condition of C.
    """
    det = cxx * cyy - cxy * cxy
    trace = cxx + cyy
    if det <= _SINGULAR * trace * trace:
        return 0.0, 0.0, 0.0
    # adj(C) Q adj(C), with adj(C) = [[cyy, -cxy], [-cxy, cxx]]
    pxx = cyy * bxx - cxy * bxy
    pxy = cyy * bxy - cxy * byy
    qyx = -cxy * bxx + cxx * bxy
    qyy = -cxy * bxy + cxx * byy
    rxx = pxx * cyy - pxy * cxy
    rxy = -pxx * cxy + pxy * cxx
    ryy = -qyx * cxy + qyy * cxx
    return (bxx + rxx / det) / trace, (bxy + rxy / det) / trace, (byy + ryy / det) / trace


@compiled()
def principal(sxx: float, sxy: float, syy: float) -> tuple[float, float, float, float]:
    """Return the eigenvalues of a symmetric tensor and the direction of the larger.

    Parameters
    ----------
    sxx, sxy, syy : float
        Its entries.

    Returns
    -------
    tuple of float
        k1 >= k2, and the unit vector (c, s) that belongs to k1; (1, 0) where they are equal.
    """
    half = 0.5 * (sxx - syy)
    radius = np.hypot(half, sxy)
    middle = 0.5 * (sxx + syy)
    if radius < 1e-150:  # its square underflows: as good as equal
        return middle, middle, 1.0, 0.0
    # Half of the angle of (half, sxy), by the half-angle formula that does not cancel.
    if half >= 0.0:
        c, s = radius + half, sxy
    else:
        c, s = abs(sxy), (radius - half) * (1.0 if sxy >= 0.0 else -1.0)
    length = np.hypot(c, s)
    return middle + radius, middle - radius, c / length, s / length


@compiled()
def write_principal(
    at: int,
    normal: Vector,
    tensor: tuple[float, float, float],
    k: FloatArray,
    directions: FloatArray,
) -> None:
    """Store what follows from a tensor given in the `tangent_frame` of a normal.

    Parameters
    ----------
    at : int
        Vertex to write.
    normal : tuple of float
        Unit normal.
    tensor : tuple of float
        Entries xx, xy, yy.
    k : ndarray, shape=(2, n)
        Receives k1 and k2.
    directions : ndarray, shape=(2, n, 3)
        Receives d1 and d2, with d1 x d2 = normal.
    """
    u, v = tangent_frame(normal[0], normal[1], normal[2])
    k1, k2, c, s = principal(tensor[0], tensor[1], tensor[2])
    k[0, at] = k1
    k[1, at] = k2
    for axis in range(3):
        directions[0, at, axis] = c * u[axis] + s * v[axis]
        directions[1, at, axis] = c * v[axis] - s * u[axis]


@compiled()
def in_space(
    normal: FloatArray | Vector, tensor: FloatArray | Vector
) -> tuple[float, float, float, float, float, float]:
    """Return a tangent tensor as one of space, which can be added to those of other planes.

    Parameters
    ----------
    normal : ndarray, shape=(3,), or tuple of 3 floats
        Unit normal.
    tensor : ndarray, shape=(3,), or tuple of 3 floats
        Entries xx, xy, yy in its `tangent_frame`.

    Returns
    -------
    tuple of float
        Entries xx, xy, xz, yy, yz, zz.
    """
    u, v = tangent_frame(normal[0], normal[1], normal[2])
    return (
        _entry(tensor, u, v, 0, 0),
        _entry(tensor, u, v, 0, 1),
        _entry(tensor, u, v, 0, 2),
        _entry(tensor, u, v, 1, 1),
        _entry(tensor, u, v, 1, 2),
        _entry(tensor, u, v, 2, 2),
    )


@compiled()
def _entry(tensor: FloatArray | Vector, u: Vector, v: Vector, a: int, b: int) -> float:
    return (
        tensor[0] * u[a] * u[b] + tensor[1] * (u[a] * v[b] + v[a] * u[b]) + tensor[2] * v[a] * v[b]
    )


@compiled()
def in_tangent_plane(
    normal: FloatArray, t: FloatArray | tuple[float, ...]
) -> tuple[float, float, float]:
    """Return the tangent part of a tensor of space.

    Parameters
    ----------
    normal : ndarray, shape=(3,)
        Unit normal.
    t : ndarray, shape=(6,), or tuple of 6 floats
        Entries xx, xy, xz, yy, yz, zz.

    Returns
    -------
    tuple of float
        Entries xx, xy, yy in the normal's `tangent_frame`.
    """
    u, v = tangent_frame(normal[0], normal[1], normal[2])
    return between(t, u, u), between(t, u, v), between(t, v, v)


@compiled()
def between(t: FloatArray | tuple[float, ...], p: Vector, q: Vector) -> float:
    """Return p.T q.

    Parameters
    ----------
    t : ndarray, shape=(6,), or tuple of 6 floats
        Entries xx, xy, xz, yy, yz, zz of a symmetric T.
    p, q : tuple of float
        Vectors.

    Returns
    -------
    float
        The product.
    """
    return (
        t[0] * p[0] * q[0]
        + t[1] * (p[0] * q[1] + p[1] * q[0])
        + t[2] * (p[0] * q[2] + p[2] * q[0])
        + t[3] * p[1] * q[1]
        + t[4] * (p[1] * q[2] + p[2] * q[1])
        + t[5] * p[2] * q[2]
    )
