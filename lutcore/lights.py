"""Directional, point and cone lights, and what each brings to a point."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lutcore.arrays import FloatArray, finite, unit_vector
from lutcore.compiled import compiled
from lutcore.errors import ParameterError

LIGHT_FIELDS = 11
_DIRECTIONAL, _POINT_OR_CONE = 0.0, 1.0


def _rgb(name: str, value: ArrayLike) -> FloatArray:
    rgb = np.broadcast_to(finite(name, value, (), (3,)), (3,)).copy()
    if (rgb < 0.0).any():
        raise ParameterError(f"{name} = {value!r} is negative")
    return rgb


@dataclass(frozen=True, eq=False)
class DirectionalLight:
    """A light so far away that its direction and strength are the same everywhere.

    Parameters
    ----------
    direction : array_like, shape=(3,)
        Points TO the light; any length.
    irradiance : array_like, shape=() or (3,)
        Linear RGB irradiance of a surface that faces it.

    Raises
    ------
    ParameterError
        If the direction is zero or not finite, or the irradiance negative.
    """

    direction: ArrayLike
    irradiance: ArrayLike = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "direction", unit_vector("direction", self.direction))
        object.__setattr__(self, "irradiance", _rgb("irradiance", self.irradiance))

    def packed(self) -> FloatArray:
        """Return the row that compiled code reads.

        Returns
        -------
        ndarray, shape=(LIGHT_FIELDS,)
            Kind, vector to the light, unused axis, unused cosine, RGB.
        """
        return np.concatenate(
            ([_DIRECTIONAL], self.direction, (0.0, 0.0, 0.0), [-2.0], self.irradiance)
        )


@dataclass(frozen=True, eq=False)
class PointLight:
    """A light that shines equally in all directions and falls off as 1/distance^2.

    Parameters
    ----------
    position : array_like, shape=(3,)
        Mesh units.
    intensity : array_like, shape=() or (3,)
        Linear RGB; the irradiance of a surface that faces it is intensity/distance^2, the
        distance in mesh units.

    Raises
    ------
    ParameterError
        If the position is not finite, or the intensity negative.
    """

    position: ArrayLike
    intensity: ArrayLike = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "position", finite("position", self.position, (3,)))
        object.__setattr__(self, "intensity", _rgb("intensity", self.intensity))

    def packed(self) -> FloatArray:
        """Return the row that compiled code reads.

        Returns
        -------
        ndarray, shape=(LIGHT_FIELDS,)
            Kind, position, unused axis, a cosine that lets all through, RGB.
        """
        return np.concatenate(
            ([_POINT_OR_CONE], self.position, (0.0, 0.0, 0.0), [-2.0], self.intensity)
        )


@dataclass(frozen=True, eq=False)
class ConeLight:
    """A point light that shines only inside a cone.

    Parameters
    ----------
    position : array_like, shape=(3,)
        Apex, mesh units.
    direction : array_like, shape=(3,)
        Axis of the cone, FROM the light into the scene; any length.
    intensity : array_like, shape=() or (3,)
        Linear RGB inside the cone, as for a point light; zero outside.
    angle : float
        Between the axis and the edge, degrees, above 0 to 180.

    Raises
    ------
    ParameterError
        If the direction is zero, a value is not finite, the intensity negative, or the angle
        out of range.
    """

    position: ArrayLike
    direction: ArrayLike
    intensity: ArrayLike = 1.0
    angle: float = 30.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "position", finite("position", self.position, (3,)))
        object.__setattr__(self, "direction", unit_vector("direction", self.direction))
        object.__setattr__(self, "intensity", _rgb("intensity", self.intensity))
        object.__setattr__(self, "angle", float(finite("angle", self.angle, ())))
        if not 0.0 < self.angle <= 180.0:
            raise ParameterError.out_of_range("angle", self.angle, 0.0, 180.0, "degrees")

    def packed(self) -> FloatArray:
        """Return the row that compiled code reads.

        Returns
        -------
        ndarray, shape=(LIGHT_FIELDS,)
            Kind, position, axis, cosine of the angle, RGB.
        """
        cosine = float(np.cos(np.radians(self.angle))) if self.angle < 180.0 else -2.0
        return np.concatenate(
            ([_POINT_OR_CONE], self.position, self.direction, [cosine], self.intensity)
        )


Light = DirectionalLight | PointLight | ConeLight


def pack(lights: Sequence[Light]) -> FloatArray:
    """Return the lights as the array that compiled code reads.

    Parameters
    ----------
    lights : sequence of DirectionalLight, PointLight or ConeLight
        Any number, also none.

    Returns
    -------
    ndarray, shape=(len(lights), LIGHT_FIELDS)
        One row for each light.

    Raises
    ------
    ParameterError
        If it is not a sequence, or one of them is not a light.
    """
    if isinstance(lights, Light):
        raise ParameterError("lights must be a sequence of lights, not a single one")
    for light in lights:
        if not isinstance(light, Light):
            raise ParameterError(f"{light!r} is not a directional, point or cone light")
    rows = np.empty((len(lights), LIGHT_FIELDS))
    for row, light in zip(rows, lights, strict=True):
        row[:] = light.packed()
    return rows


@compiled()
def is_directional(lights: FloatArray, index: int) -> bool:
    """Tell whether a light looks the same from everywhere, for compiled loops.

    Parameters
    ----------
    lights : ndarray, shape=(l, LIGHT_FIELDS)
        What `pack` returned.
    index : int
        Which light.

    Returns
    -------
    bool
        True for a directional light.
    """
    return bool(lights[index, 0] == _DIRECTIONAL)


@compiled()
def light_at(
    lights: FloatArray, index: int, x: float, y: float, z: float
) -> tuple[float, float, float, float]:
    """Return where a light is seen from a point and how strong it is there.

    Parameters
    ----------
    lights : ndarray, shape=(l, LIGHT_FIELDS)
        What `pack` returned.
    index : int
        Which light.
    x, y, z : float
        The point, mesh units.

    Returns
    -------
    tuple of float
        Unit vector to the light, and the factor on its RGB: 1 for a directional light,
        1/distance^2 for the others, 0 outside a cone or at the light itself.
    """
    if lights[index, 0] == _DIRECTIONAL:
        return lights[index, 1], lights[index, 2], lights[index, 3], 1.0
    dx, dy, dz = lights[index, 1] - x, lights[index, 2] - y, lights[index, 3] - z
    square = dx * dx + dy * dy + dz * dz
    if square == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    inverse = 1.0 / np.sqrt(square)
    wx, wy, wz = dx * inverse, dy * inverse, dz * inverse
    along_axis = -(wx * lights[index, 4] + wy * lights[index, 5] + wz * lights[index, 6])
    if along_axis < lights[index, 7]:
        return 0.0, 0.0, 0.0, 0.0
    return wx, wy, wz, 1.0 / square
