import numpy as np
import pytest

from lutcore import analytic
from lutcore.errors import CancelledError
from lutcore.lights import ConeLight, DirectionalLight, PointLight, pack
from lutcore.mesh import TriangleMesh
from lutcore.visibility import ShadowForecast, forecast, softened, visibility

LIGHTS = pack(
    [
        DirectionalLight((1.0, 0.3, 0.5)),
        PointLight((-4.0, 2.0, 3.0)),
        ConeLight((0.0, 0.0, 5.0), (0.0, 0.0, -1.0), angle=60.0),
    ]
)


def grid(count, height, size, facing=1):
    x = np.linspace(-size, size, count)
    points = np.stack([*np.meshgrid(x, x), np.full((count, count), height)], axis=-1)
    here = np.arange(count * count).reshape(count, count)
    a, b, c, d = here[:-1, :-1], here[:-1, 1:], here[1:, 1:], here[1:, :-1]
    faces = np.stack([[a, b, c], [a, c, d]], axis=-1).reshape(3, -1).T[:, ::facing]
    return points.reshape(-1, 3), faces


@pytest.mark.parametrize("count", [12, 60, 900])
def test_no_convex_body_shadows_itself(count):
    for body in (
        analytic.sphere(count),
        analytic.sphere(count, irregular=True),
        analytic.ellipsoid(count, True, (2.0, 1.0, 0.3)),
    ):
        np.testing.assert_array_equal(visibility(body.mesh, LIGHTS), 1.0)
        assert forecast(body.mesh, body.truth.normals, LIGHTS) == ShadowForecast(0.0, 0.0)


def hidden_on_torus(points, way, major, minor):
    """Roots of the torus's quartic along the ray, those at the point itself aside."""
    hidden = np.zeros(len(points), bool)
    for i, p in enumerate(points):
        square = np.polynomial.Polynomial([p @ p + major**2 - minor**2, 2.0 * p @ way, 1.0])
        flat = np.polynomial.Polynomial(
            [p[0] ** 2 + p[1] ** 2, 2.0 * (p[:2] @ way[:2]), way[:2] @ way[:2]]
        )
        roots = (square * square - 4.0 * major**2 * flat).roots()
        real = roots.real[np.abs(roots.imag) < 1e-7]
        hidden[i] = (real > 0.01).any()
    return hidden


def test_a_torus_is_shadowed_where_its_quartic_says():
    body = analytic.torus(6_000)
    way = np.array([0.9, 0.2, 0.35]) / np.linalg.norm([0.9, 0.2, 0.35])
    seen = visibility(body.mesh, pack([DirectionalLight(way)]))[0]
    facing = np.flatnonzero(body.truth.normals @ way > 0.0)
    truth = hidden_on_torus(body.mesh.vertices[facing], way, 1.0, 0.35)
    # The mesh lies up to spacing^2/8 inside the torus: the shadow's edge is off by less than one
    # vertex, and its length is some 2 % of the vertices.
    assert 0.05 < truth.mean() < 0.5
    assert np.mean((seen[facing] == 0.0) != truth) < 0.02


def test_the_neighbourhood_of_the_terminator_is_not_its_own_shadow():
    # Outside the hole nothing hides the light, up to the terminator.
    body = analytic.torus(600)
    way = np.array([0.0, 0.0, 1.0])
    seen = visibility(body.mesh, pack([DirectionalLight(way)]))[0]
    assert (seen[body.truth.normals @ way > 0.0] == 1.0).all()


@pytest.mark.parametrize("facing", [1, -1])
def test_a_sheet_shadows_a_floor_whichever_way_it_faces(facing):
    floor, floor_faces = grid(21, 0.0, 2.0)
    roof, roof_faces = grid(9, 1.0, 0.5, facing)
    mesh = TriangleMesh(
        np.concatenate([floor, roof]), np.concatenate([floor_faces, roof_faces + len(floor)])
    )
    above = DirectionalLight((0.0, 0.0, 1.0))
    between = PointLight((0.0, 0.0, 0.5))
    seen = visibility(mesh, pack([above, between]))
    under = np.abs(floor[:, :2]).max(axis=1) < 0.45
    beside = np.abs(floor[:, :2]).max(axis=1) > 0.55
    np.testing.assert_array_equal(seen[0, : len(floor)][under], 0.0)
    np.testing.assert_array_equal(seen[0, : len(floor)][beside], 1.0)
    np.testing.assert_array_equal(seen[1, : len(floor)], 1.0)  # the sheet is beyond the light


def test_nothing_is_hidden_outside_a_cone():
    points, faces = grid(9, 0.0, 1.0)
    roof, roof_faces = grid(3, 1.0, 0.9)
    mesh = TriangleMesh(np.concatenate([points, roof]), np.concatenate([faces, roof_faces + 81]))
    cone = ConeLight((0.0, 0.0, 2.0), (0.0, 0.0, -1.0), angle=5.0)
    seen = visibility(mesh, pack([cone]))[0, :81]
    assert seen[40] == 0.0
    np.testing.assert_array_equal(np.delete(seen, 40), 1.0)


def test_softened_shadows_are_wider_where_light_goes_farther():
    points, faces = grid(61, 0.0, 3.0)
    mesh = TriangleMesh(points, faces)
    seen = np.stack([(points[:, 0] > 0.0).astype(float), np.ones(len(points))])
    glow = np.array([0.4, 0.2, 0.1])
    soft = softened(seen, mesh, glow)
    assert soft.shape == (2, len(points), 3)
    assert soft.min() >= 0.0
    assert soft.max() <= 1.0
    np.testing.assert_array_equal(soft[1], 1.0)
    middle = np.flatnonzero(np.abs(points[:, 1]) < 0.01)
    widths = []
    for channel in range(3):
        across = soft[0, middle, channel]
        x = points[middle, 0]
        widths.append(np.interp([0.25, 0.75], across[np.abs(x) < 1.5], x[np.abs(x) < 1.5]))
    # Between quartiles a Gaussian edge of deviation 2 glow is 1.35 deviations wide; the filter,
    # which keeps quadratics, is steeper.
    for (low, high), length in zip(widths, 2.0 * glow, strict=True):
        assert 0.7 * length < high - low < 1.4 * length
        assert abs(0.5 * (low + high) - 0.05) < 0.02  # between the vertices at 0 and at .1


def test_a_forecast_is_that_of_all_vertices():
    body = analytic.torus(3_000)
    found = forecast(body.mesh, body.truth.normals, LIGHTS[:1])
    lit = np.maximum(body.truth.normals @ LIGHTS[0, 1:4], 0.0)
    seen = visibility(body.mesh, LIGHTS[:1])[0]
    assert found.share == pytest.approx(np.mean(seen[lit > 0.0] == 0.0))
    expected = np.sqrt(np.sum((lit * (1.0 - seen)) ** 2) / np.sum(lit**2))
    assert found.change == pytest.approx(expected)
    assert found.needed == (expected > 0.01)
    many = analytic.torus(20_000)
    sampled = forecast(many.mesh, many.truth.normals, LIGHTS[:1])
    # 4096 of 20 000 vertices: a share of .1 is off by .005, one sigma.
    assert sampled.share == pytest.approx(found.share, abs=0.02)


def test_casting_shadows_can_be_cancelled():
    body = analytic.torus(300)
    with pytest.raises(CancelledError):
        visibility(body.mesh, LIGHTS, lambda share, step: step != "casting shadows")
    with pytest.raises(CancelledError):
        softened(
            np.random.default_rng(0).integers(0, 2, (1, len(body.mesh.vertices))).astype(float),
            body.mesh,
            np.full(3, 0.1),
            lambda share, step: False,
        )
