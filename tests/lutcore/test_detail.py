from dataclasses import replace

import numpy as np
import pytest

from lutcore import analytic
from lutcore.baking import bake
from lutcore.cosmoothing import surface
from lutcore.detail import detail_seen
from lutcore.errors import CancelledError, ParameterError
from lutcore.estimation import principal_curvatures
from lutcore.exitance import exitance, shade
from lutcore.gather.exitance import exact
from lutcore.geometry import typical_spacing
from lutcore.lights import DirectionalLight
from lutcore.lowpass import series_of
from lutcore.materials import Material
from lutcore.mesh import TriangleMesh
from lutcore.scale import shading_scale
from lutcore.shading import shading_inputs
from plugins.shading.lambert import Lambert
from tests.bumps import bare, bumpy

LIGHT = DirectionalLight((0.9, 0.3, 0.3))
# l_u = .5 mm and beta = 1, 1.22 and 1.39: light that ends within a few millimetres.
GRAY = Material("gray", (1.33, 1.0, 0.7), (0.67, 1.0, 1.3), 1.3)


def wave(q: float, height: float) -> TriangleMesh:
    """Return z = height cos(q x) over whole wavelengths of 16 vertices, 8 mm or more."""
    length = 2.0 * np.pi / q
    side = length * np.ceil(8.0 / length)
    cells = round(16.0 * side / length)
    line = np.linspace(-0.5 * side, 0.5 * side, cells + 1)
    x, y = (grid.ravel() for grid in np.meshgrid(line, line))
    here = np.arange((cells + 1) ** 2).reshape(cells + 1, cells + 1)
    a, b, c, d = (h.ravel() for h in (here[:-1, :-1], here[:-1, 1:], here[1:, 1:], here[1:, :-1]))
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return TriangleMesh(np.stack([x, y, height * np.cos(q * x)], axis=1), faces)


@pytest.mark.parametrize("q", [1.0, 2.0, 4.0])
def test_waves_fade_as_in_the_gathered_light(q):
    mesh = wave(q, 0.02 / q)
    inputs = shading_inputs(
        mesh, bare(mesh), GRAY, [DirectionalLight((1.0, 0.0, 1.0))], detail=detail_seen(mesh, GRAY)
    )
    x, y = np.abs(mesh.vertices[:, 0]), mesh.vertices[:, 1]
    middle = np.flatnonzero((x <= np.pi / q * 1.01) & (np.abs(y) < 1e-9))
    across = np.sin(q * mesh.vertices[middle, 0])

    def swing(light):
        return across @ light / light.mean(axis=0) / (across @ across)

    truth = swing(exact(replace(inputs, normals=inputs.detail.bare), mesh.vertices[middle]))
    model = Lambert(fresnel="directional")
    found = swing(exitance(model, inputs)[middle])
    bumps = swing(exitance(model, replace(inputs, detail=None))[middle])
    # With 16 vertices a wave the Laplacian gives q^2 less by (2 pi/16)^2/12 = 1.3 %, and light that
    # is linear over facets has waves smaller by as much; the filter is off by 3e-3.
    np.testing.assert_allclose(found, truth, rtol=0.03)
    assert (np.abs(bumps) > 1.08 * np.abs(truth)).all()


def test_on_a_bumpy_body_the_error_falls_by_more_than_a_third():
    mesh = bumpy(6_000)
    truth = shade(mesh, bare(mesh), "skin1", [LIGHT], "jensen2002")
    one = principal_curvatures(mesh, scale=shading_scale(mesh, bake("skin1").glow))

    def error(**seen):
        off = shade(mesh, one, "skin1", [LIGHT], **seen) - truth
        return np.linalg.norm(off, axis=0) / np.linalg.norm(truth, axis=0)

    assert (error(detail=detail_seen(mesh, "skin1")) < 0.65 * error()).all()


@pytest.mark.parametrize("name", ["skin1", "cream"])
def test_a_sphere_is_seen_as_it_is(name):
    ball = analytic.sphere(3_000, radius=20.0)
    seen = detail_seen(ball.mesh, name, 0.5)
    across = np.eye(3) - ball.truth.normals[:, :, None] * ball.truth.normals[:, None, :]
    expected = across[:, [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]] / 10.0  # 1/mm
    for normals, shape in zip(seen.normals, seen.shape, strict=True):
        # Stars that are not symmetric tilt by the square of an edge over the radius, .005.
        np.testing.assert_allclose(normals, ball.truth.normals, atol=6e-3)
        np.testing.assert_allclose(shape, expected, atol=0.02 / 10.0)
    # Within <r^2> = 2 widths^2 the normals turn by r/R, less where light goes round the ball.
    within = 2.0 * np.square(seen.widths / 20.0)
    ratio = np.median(seen.variance, axis=1) / within
    assert np.all((ratio > 0.45) & (ratio < 1.0))
    assert ratio[2] > 0.8


def test_only_the_size_in_light_counts():
    mesh = bumpy(2_000)
    large = TriangleMesh(1000.0 * mesh.vertices + 5.0, mesh.faces)
    one, other = detail_seen(mesh, "skin1", 2.0), detail_seen(large, "skin1", 2e-3)
    np.testing.assert_allclose(one.normals, other.normals, atol=1e-4)
    np.testing.assert_allclose(one.shape, other.shape, atol=1e-4 * np.abs(one.shape).max())
    np.testing.assert_allclose(1000.0 * one.widths, other.widths)


def test_each_channel_sees_what_its_light_does_not_blur():
    mesh = bumpy(4_000)
    seen = detail_seen(mesh, "skin1", 0.5)
    assert seen.widths[0] > seen.widths[1] > seen.widths[2] > typical_spacing(mesh)
    rough = [np.square(normals - seen.bare).sum() for normals in seen.normals]
    assert rough[0] > 1.3 * rough[1] > 1.3**2 * rough[2] > 0.0
    np.testing.assert_allclose(np.linalg.norm(seen.normals, axis=2), 1.0, atol=1e-6)
    clear = detail_seen(mesh, "skin1", 1e4)
    # The filter's own tolerance, on normals that differ by some tenths.
    np.testing.assert_allclose(clear.normals[0], clear.bare, atol=5e-3)


def test_light_that_spreads_over_the_whole_body_is_held_at_a_tenth_of_it():
    mesh = bumpy(1_000)
    np.testing.assert_allclose(detail_seen(mesh, "marble", 1e-3).widths, 0.1 * mesh.diagonal)


def test_concave_curvature_is_left_out_and_convex_kept():
    ring = analytic.torus(4_000, major=20.0, minor=8.0)
    seen = detail_seen(ring.mesh, "skin1", 20.0)
    trace = seen.shape[2, :, :3].sum(axis=1)
    convex = np.maximum(ring.truth.k1, 0.0) + np.maximum(ring.truth.k2, 0.0)
    np.testing.assert_allclose(trace, convex / 20.0, atol=0.02 / 8.0 / 20.0 * 2.0)


def test_rims_specks_and_loose_vertices_are_shaded_too():
    sheet = analytic.saddle(900)
    points = [*sheet.mesh.vertices, [9.0, 9.0, 9.0], [3, 3, 0], [3.01, 3, 0], [3, 3.01, 0]]
    count = len(sheet.mesh.vertices)
    faces = [*sheet.mesh.faces, [count + 1, count + 2, count + 3]]
    seen = detail_seen(TriangleMesh(points, faces), "skin1", 20.0)
    assert np.isfinite(seen.shape).all()
    assert not seen.normals[:, count].any()
    assert not seen.bare[count].any()
    np.testing.assert_allclose(seen.normals[:, -1], [[0.0, 0.0, 1.0]] * 3, atol=1e-6)
    # A rim takes over what the inside knows: k1 = 1 along the whole of it.
    rim = surface(sheet.mesh).operator.rim
    trace = 20.0 * seen.shape[2, :count, :3].sum(axis=1)
    assert np.abs(trace[rim] - np.maximum(sheet.truth.k1, 0.0)[rim]).max() < 0.35
    nothing = detail_seen(TriangleMesh(np.zeros((3, 3)), [[0, 1, 2]]), "skin1")
    assert not nothing.normals.any()
    assert not nothing.smooth.any()
    assert not nothing.shape.any()
    assert nothing.variance.shape == (3, 3)


@pytest.mark.parametrize("order", ["regular", "random"])
def test_what_has_no_channels_gets_the_normals_of_the_curvature_at_one_scale(order):
    mesh = bumpy(20_000)
    if order == "random":  # detail and curvature then arrange the vertices first
        number = np.random.default_rng(3).permutation(len(mesh.vertices))
        place = np.argsort(number)
        mesh = TriangleMesh(mesh.vertices[number], place[mesh.faces])
    seen = detail_seen(mesh, "skin1", 0.5)
    # Summed in another order where vertices are arranged.
    expected = shading_scale(mesh, bake("skin1").glow / 0.5)
    assert seen.scale == pytest.approx(expected, rel=1e-14)
    found = principal_curvatures(mesh, scale=seen.scale)
    np.testing.assert_array_equal(seen.smooth, found.normals)


def test_local_models_need_no_curvature_where_there_is_detail():
    mesh = bumpy(1_000)
    seen = detail_seen(mesh, "skin1")
    with_curvature = principal_curvatures(mesh, scale=seen.scale)
    bent, unbent = (
        shading_inputs(mesh, found, "skin1", [LIGHT], detail=seen)
        for found in (with_curvature, None)
    )
    np.testing.assert_array_equal(exitance(Lambert(), unbent), exitance(Lambert(), bent))
    assert np.isnan(unbent.shape).all()
    with pytest.raises(ParameterError, match="neither"):
        shading_inputs(mesh, None, "skin1", [LIGHT])


def test_without_differences_between_channels_nothing_changes():
    mesh = bumpy(1_000)
    curvatures = principal_curvatures(mesh, scale=2.0)
    inputs = shading_inputs(mesh, curvatures, "skin1", [LIGHT, LIGHT])
    same = replace(
        detail_seen(mesh, "skin1"),
        normals=np.array([inputs.normals] * 3),
        shape=np.array([inputs.shape] * 3),
    )
    for shares in (None, np.linspace(0.0, 1.0, 2 * len(inputs.points)).reshape(2, -1)):
        given = replace(inputs, visibility=shares)
        np.testing.assert_array_equal(
            exitance(Lambert(), given), exitance(Lambert(), replace(given, detail=same))
        )


def test_models_that_blur_detail_themselves_get_all_of_it():
    mesh = bumpy(1_000)
    smooth = principal_curvatures(mesh, scale=4.0)
    seen = detail_seen(mesh, "skin1")
    gathered = shade(mesh, smooth, "skin1", [LIGHT], "jensen2002", detail=seen)
    np.testing.assert_array_equal(
        gathered, shade(mesh, smooth, "skin1", [LIGHT], "jensen2002", normals=seen.bare)
    )
    assert np.abs(gathered - shade(mesh, smooth, "skin1", [LIGHT], "jensen2002")).max() > 0.01


def test_what_cannot_be_is_refused_and_work_can_be_stopped():
    mesh = bumpy(500)
    with pytest.raises(ParameterError, match="above 0"):
        detail_seen(mesh, "skin1", 0.0)
    with pytest.raises(ParameterError, match="vertices"):
        other = bumpy(400)
        shade(mesh, bare(mesh), "skin1", [LIGHT], detail=detail_seen(other, "skin1"))
    shares = []
    detail_seen(mesh, "skin1", progress=lambda share, _: shares.append(share) is None)
    assert shares == sorted(shares)
    assert len(shares) > 5
    for stop in range(1, len(shares)):
        left = iter(range(stop))
        with pytest.raises(CancelledError):
            detail_seen(mesh, "skin1", progress=lambda *_, left=left: next(left, None) is not None)


@pytest.mark.parametrize("length", [0.01, 1.0, 30.0])
def test_a_polynomial_follows_the_response_and_keeps_constants(length):
    def passing(square):
        return np.exp(-length * np.sqrt(square + 0.1)) / np.exp(-length * np.sqrt(0.1))

    series = series_of(passing, 8.0, 1e-3)
    y = np.linspace(0.0, 1.0, 2001)
    found = 1.0 + y * np.polynomial.chebyshev.chebval(2.0 * y - 1.0, series)
    # Twice: making it 1 at 0 multiplies it by up to 1 + 1e-3.
    np.testing.assert_allclose(found, passing(8.0 * y), atol=2.1e-3)
    assert found[0] == 1.0
