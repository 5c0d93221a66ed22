"""Lights: what each brings to a point."""

import numpy as np
import pytest

from lutcore.errors import ParameterError
from lutcore.lights import ConeLight, DirectionalLight, Light, PointLight, light_at, pack


def seen(light: Light, point: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    rows = pack([light])
    x, y, z, strength = light_at(rows, 0, *map(float, point))
    return np.array([x, y, z]), strength * rows[0, 8:]


def test_a_directional_light_is_the_same_everywhere() -> None:
    light = DirectionalLight((0.0, 0.0, 5.0), (1.0, 2.0, 3.0))
    for point in [(0.0, 0.0, 0.0), (1e6, -3.0, 2.0)]:
        direction, irradiance = seen(light, point)
        np.testing.assert_array_equal(direction, [0.0, 0.0, 1.0])
        np.testing.assert_array_equal(irradiance, [1.0, 2.0, 3.0])


def test_a_point_light_falls_off_with_the_square() -> None:
    light = PointLight((0.0, 3.0, 4.0), 50.0)
    direction, irradiance = seen(light, (0.0, 0.0, 0.0))
    np.testing.assert_allclose(direction, [0.0, 0.6, 0.8])
    np.testing.assert_allclose(irradiance, 2.0)


def test_at_the_light_itself_there_is_none() -> None:
    direction, irradiance = seen(PointLight((1.0, 2.0, 3.0), 50.0), (1.0, 2.0, 3.0))
    np.testing.assert_array_equal(direction, 0.0)
    np.testing.assert_array_equal(irradiance, 0.0)


@pytest.mark.parametrize(
    ("degrees", "lit"), [(0.0, True), (29.9, True), (30.1, False), (150, False)]
)
def test_a_cone_s_angle_is_from_its_axis_to_its_edge(degrees: float, lit: bool) -> None:
    light = ConeLight((0.0, 0.0, 10.0), (0.0, 0.0, -2.0), 100.0, 30.0)
    off = np.radians(degrees)
    point = (4.0 * np.sin(off), 0.0, 10.0 - 4.0 * np.cos(off))
    _, irradiance = seen(light, point)
    np.testing.assert_allclose(irradiance, 100.0 / 16.0 if lit else 0.0)


def test_a_cone_of_180_degrees_is_a_point_light() -> None:
    cone = ConeLight((0.0, 0.0, 1.0), (0.0, 0.0, -1.0), 3.0, 180.0)
    point = PointLight((0.0, 0.0, 1.0), 3.0)
    for position in [(0.0, 0.0, 0.0), (0.0, 0.0, 7.0), (1.0, 2.0, 1.0)]:
        np.testing.assert_array_equal(seen(cone, position), seen(point, position))


def test_packing_keeps_order_and_nothing_is_allowed() -> None:
    assert pack([]).shape == (0, 11)
    rows = pack([PointLight((1.0, 2.0, 3.0), 0.5), DirectionalLight((1.0, 0.0, 0.0))])
    np.testing.assert_array_equal(rows[:, 1:4], [[1.0, 2.0, 3.0], [1.0, 0.0, 0.0]])
    np.testing.assert_array_equal(rows[:, 8:], [[0.5] * 3, [1.0] * 3])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: DirectionalLight((0.0, 0.0, 0.0)), "no direction"),
        (lambda: DirectionalLight((0.0, 0.0, np.nan)), "finite"),
        (lambda: DirectionalLight((1.0, 0.0)), "shape"),
        (lambda: DirectionalLight((1.0, 0.0, 0.0), -1.0), "negative"),
        (lambda: PointLight((1.0, 0.0, 0.0), (1.0, 2.0)), "shape"),
        (lambda: PointLight((1.0, np.inf, 0.0)), "finite"),
        (lambda: ConeLight((1.0, 0.0, 0.0), (0.0, 0.0, 0.0)), "no direction"),
        (lambda: ConeLight((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), 1.0, 0.0), "range"),
        (lambda: ConeLight((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), 1.0, 181.0), "range"),
        (lambda: pack(["sun"]), "not a directional"),  # type: ignore[list-item]
        (lambda: pack(PointLight((0.0, 0.0, 0.0))), "sequence"),  # type: ignore[arg-type]
    ],
)
def test_bad_lights_are_refused(make: object, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        make()  # type: ignore[operator]
