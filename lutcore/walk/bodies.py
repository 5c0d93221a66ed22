"""Convex bodies in closed form: half-space, sphere, cylinder and ellipsoid.

One quadric stands for all: the body is where sum_i (x_i/a_i)^2 <= 1, half axes a_i may be
infinite, and where all are, it is z <= 0. In the units of its axes, s_i = x_i/a_i, an ellipsoid
is the unit sphere and a cylinder the unit circle, and light from w falls on it as light from the
pole w_i/a_i falls on those. Places are therefore counted there, as a row by the distance from that
pole and a column by the azimuth.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lutcore.arrays import FloatArray, unit_vector
from lutcore.compiled import compiled
from lutcore.errors import ParameterError

FLAT, ROUND, FULL = 0, 2, 3
"""Kinds of body, by the number of finite axes: half-space, cylinder, ellipsoid."""


@dataclass(frozen=True)
class Body:
    """A convex body full of the medium.

    Parameters
    ----------
    axes : tuple of 3 floats
        Half axes along x, y and z in l_u, above 0: all finite (an ellipsoid), one infinite (a
        cylinder) or all infinite (the half-space z <= 0).

    Raises
    ------
    ParameterError
        If they describe none of these.
    """

    axes: tuple[float, float, float]

    def __post_init__(self) -> None:
        if len(self.axes) != 3 or not all(axis > 0.0 for axis in self.axes):
            raise ParameterError(f"axes = {self.axes!r} must be three numbers above 0")
        if self.kind not in (FLAT, ROUND, FULL):
            raise ParameterError(f"axes = {self.axes!r}: two infinite axes make a slab, no body")

    @property
    def kind(self) -> int:
        """Number of finite axes: `FLAT`, `ROUND` or `FULL`."""
        return int(np.isfinite(self.axes).sum())

    @property
    def inverse(self) -> FloatArray:
        """1/a_i, 0 where infinite; shape (3,), 1/l_u."""
        return 1.0 / np.asarray(self.axes)

    def frame(self, light: ArrayLike) -> FloatArray:
        """Return pole, first and second axis of the units in which places are counted.

        Parameters
        ----------
        light : array_like, shape=(3,)
            Points TO the light; any length.

        Returns
        -------
        ndarray, shape=(3, 3)
            Orthonormal rows; of a cylinder, the last is its axis.

        Raises
        ------
        ParameterError
            If the body is not lit from there.
        """
        w = unit_vector("light", light)
        if self.kind == FLAT:
            if w[2] <= 0.0:
                raise ParameterError(f"light = {light!r} does not reach the half-space z <= 0")
            return np.eye(3)
        pole = unit_vector("light across the cylinder", self.inverse * w)
        axis = np.eye(3)[int(np.argmax(self.axes)) if self.kind == ROUND else _least(pole)]
        first = unit_vector("axis", np.cross(axis, pole))
        return np.stack([pole, first, np.cross(pole, first)])

    def shadow(self, light: ArrayLike) -> float:
        """Return the power that unit normal irradiance brings.

        Parameters
        ----------
        light : array_like, shape=(3,)
            Points TO the light; any length.

        Returns
        -------
        float
            Area of the shadow: of an ellipsoid in l_u^2, of a cylinder per length in l_u, of the
            half-space per area.
        """
        w = unit_vector("light", light)
        if self.kind == FLAT:
            return float(w[2])
        across = float(np.linalg.norm(self.inverse * w))
        return (np.pi if self.kind == FULL else 2.0) * self._stretch() * across

    def area(self, s: FloatArray) -> FloatArray:
        """Return surface per unit of the unit sphere or circle.

        Parameters
        ----------
        s : ndarray, shape=(n, 3)
            Unit vectors: places in units of the axes.

        Returns
        -------
        ndarray, shape=(n,)
            l_u^2 or, of a cylinder, l_u; 1 of the half-space.
        """
        if self.kind == FLAT:
            return np.ones(len(s))
        return self._stretch() * np.sqrt(np.square(s * self.inverse).sum(axis=1))

    def _stretch(self) -> float:
        return float(np.prod([axis for axis in self.axes if np.isfinite(axis)]))


def half_space() -> Body:
    """Return the half-space z <= 0.

    Returns
    -------
    Body
        The flat body without end.
    """
    return Body((np.inf, np.inf, np.inf))


def sphere(radius: float) -> Body:
    """Return a sphere.

    Parameters
    ----------
    radius : float
        Radius, l_u.

    Returns
    -------
    Body
        Around the origin.
    """
    return Body((radius, radius, radius))


def cylinder(radius: float) -> Body:
    """Return an endless cylinder around the z axis.

    Parameters
    ----------
    radius : float
        Radius, l_u.

    Returns
    -------
    Body
        Around the z axis.
    """
    return Body((radius, radius, np.inf))


def _least(vector: FloatArray) -> int:
    return int(np.argmin(np.abs(vector)))


@compiled()
def distance_out(
    x: float,
    y: float,
    z: float,
    dx: float,
    dy: float,
    dz: float,
    square: FloatArray,
    kind: int,
) -> float:
    """Return how far a ray that starts inside goes until it meets the surface.

    Parameters
    ----------
    x, y, z : float
        Start, inside or on the surface.
    dx, dy, dz : float
        Unit vector of travel.
    square : ndarray, shape=(3,)
        1/a_i^2.
    kind : int
        `Body.kind`.

    Returns
    -------
    float
        Distance in l_u, 0 or more, infinite if it never does.
    """
    if kind == FLAT:
        return max(-z, 0.0) / dz if dz > 0.0 else np.inf
    a = square[0] * dx * dx + square[1] * dy * dy + square[2] * dz * dz
    b = square[0] * x * dx + square[1] * y * dy + square[2] * z * dz
    # Rounding may have left the start outside by a hair.
    c = min(square[0] * x * x + square[1] * y * y + square[2] * z * z - 1.0, 0.0)
    root = np.sqrt(b * b - a * c)
    # The form that does not cancel; a is 0 only along the axis of a cylinder.
    if b > 0.0:
        return -c / (b + root)
    return (root - b) / a if a > 0.0 else np.inf


@compiled()
def normal_at(
    x: float, y: float, z: float, square: FloatArray, kind: int
) -> tuple[float, float, float]:
    """Return the outward unit normal.

    Parameters
    ----------
    x, y, z : float
        A place on the surface.
    square : ndarray, shape=(3,)
        1/a_i^2.
    kind : int
        `Body.kind`.

    Returns
    -------
    tuple of float
        Unit vector.
    """
    if kind == FLAT:
        return 0.0, 0.0, 1.0
    nx, ny, nz = square[0] * x, square[1] * y, square[2] * z
    inverse = 1.0 / np.sqrt(nx * nx + ny * ny + nz * nz)
    return nx * inverse, ny * inverse, nz * inverse
