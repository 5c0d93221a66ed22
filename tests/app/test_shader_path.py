"""Shading in the fragment shader against shading at vertices, drawn off the screen."""

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.ndimage import binary_erosion

from app.camera import axes
from app.offscreen import offscreen_window
from app.picture import compose
from app.pipeline import Pipeline
from app.render import fill, grab
from app.session import Camera, Cone, Directional, Method, Point, Session, Substance
from app.shader.drawing import PixelLight
from app.shader.look import MOST_LIGHTS, look_of, unsupported
from app.shader.vertices import forms
from lutcore.baking import bake
from lutcore.color import srgb_encode
from lutcore.convexity import bending, convex_part
from lutcore.fresnel import hinges_of
from lutcore.lut import even_forms
from lutcore.materials import materials
from lutcore.response_table import BEND, COLUMNS, MOST, ROWS, halfway, response

LIGHTS = (
    Directional((0.9, 0.3, 0.3), (1.0, 0.9, 0.8), "camera"),
    Point((-4.0, 3.0, 4.0), (6.0, 6.0, 9.0)),
    Cone((4.0, -4.0, 5.0), (-0.5, 0.5, -0.6), (5.0, 9.0, 5.0), 80.0),
)
PARALLEL = Camera((1.0, -2.0, 12.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), height=9.0)
PRISM = Substance("prism", (0.74, 0.88, 1.01), (0.032, 0.17, 0.48), (1.1, 1.3, 1.7))
CASES = {
    "detail by channel": {},
    "one scale": {"scale": 0.3, "lights": LIGHTS},
    "parallel": {"scale": 0.3, "camera": PARALLEL, "lights": LIGHTS[:2]},
    "flat area": {"scale": 0.3, "model": Method("curvature-lut", {"hinges": 7.0, "area": "flat"})},
    "eight lights": {"scale": 0.3, "lights": (*LIGHTS, *LIGHTS, *LIGHTS[:2])},
    "no light": {"scale": 0.3, "lights": (), "exposure": 1.0},
    "an index for each channel": {"scale": 0.3, "material": PRISM, "lights": LIGHTS},
    "an index for each channel, lambert": {
        "model": Method("lambert", {"fresnel": "directional"}),
        "scale": 0.3,
        "material": PRISM,
        "lights": LIGHTS[:1],
    },
    "lambert": {"model": Method("lambert"), "lights": LIGHTS[:1]},
    "lambert, directional": {
        "model": Method("lambert", {"fresnel": "directional"}),
        "scale": 0.3,
        "lights": LIGHTS[:1],
    },
}
# What is drawn per vertex is off by half a byte at vertices, and so between them, and by another
# half when it is rounded in the frame buffer; the shader only by the latter. Together they stay
# below 2 with half a byte left for single precision and what bends within a triangle.
BYTES = 1


@pytest.fixture(scope="module")
def torus(tmp_path_factory):
    """A torus far from the origin, coloured; a pixel is larger than a triangle's sides."""
    import trimesh

    m, n = 400, 160
    u, v = np.meshgrid(2 * np.pi * np.arange(m) / m, 2 * np.pi * np.arange(n) / n, indexing="ij")
    ring = 3.0 + np.cos(v)
    points = np.stack([ring * np.cos(u), ring * np.sin(u), np.sin(v)], -1).reshape(-1, 3)
    a = np.arange(m)[:, None] * n + np.arange(n)
    b, c = np.roll(a, -1, 0), np.roll(a, -1, 1)
    d = np.roll(b, -1, 1)
    faces = np.concatenate(
        [np.stack([a, b, d], -1).reshape(-1, 3), np.stack([a, d, c], -1).reshape(-1, 3)]
    )
    shade = np.stack([200 + 50 * np.sin(u), 150 + 50 * np.cos(v), 180 + 0 * u], -1)
    colors = shade.reshape(-1, 3).astype(np.uint8)
    folder = tmp_path_factory.mktemp("torus")
    plain, colored = folder / "plain.ply", folder / "colored.ply"
    trimesh.Trimesh(points, faces, process=False).export(plain)
    trimesh.Trimesh(points, faces, vertex_colors=colors, process=False).export(colored)
    return str(plain), str(colored)


@pytest.fixture(scope="module")
def pipeline():
    return Pipeline()


def _session(path, **fields):
    fields = {"mesh": path, "size": (130, 130), "camera": "front", "mm_per_unit": 2.0} | fields
    return Session(**fields)


class Drawn:
    """A composition in a window off the screen, by vertex or by pixel."""

    def __init__(self, window, session, pipeline) -> None:
        self.window, self.session, self.made = window, session, compose(session, pipeline)
        self.look = look_of(session, pipeline, axes(self.made.camera))
        origin = self.made.camera.target
        (drawn, *_) = fill(window, self.made.panels, session.size, "#000", 1, origin)
        self.actor, self.origin = drawn.actor, origin

    def pixels(self):
        self.window.Render()
        return grab(self.window, self.session.size).astype(int)

    def shaded(self) -> PixelLight:
        made, actors = self.made, [(self.actor, None)]
        return PixelLight(self.look, actors, self.origin, self.session, made.camera, made.exposure)


def _inside(image):
    # At the silhouette, and where Lambert's light ends, colours bend within a triangle.
    return binary_erosion((image[:120] > 0).all(axis=2), iterations=2)


@pytest.mark.parametrize("case", CASES)
def test_pixels_are_those_of_vertices_on_a_fine_mesh(torus, pipeline, case) -> None:
    session = _session(torus[0], **CASES[case])
    assert not unsupported(session, pipeline.subject(session))
    with offscreen_window(session.size, 0) as window:
        drawn = Drawn(window, session, pipeline)
        vertex = drawn.pixels()
        drawn.shaded()
        pixel = drawn.pixels()
    if not session.lights:
        assert not pixel[:120].any() and not vertex[:120].any()
        return
    inside = _inside(vertex)
    assert inside.mean() > 0.2
    assert np.ptp(vertex[:120][inside]) > 50
    assert np.abs(vertex - pixel)[:120][inside].max() <= BYTES


@pytest.mark.parametrize("material", materials())
def test_all_materials_where_curvature_is_strong_and_lights_are_many(
    torus, pipeline, material
) -> None:
    lights = (*LIGHTS, Directional((-0.8, 0.1, -0.3), (0.5, 0.7, 0.9)), *LIGHTS[1:])
    session = _session(torus[0], material=material, scale=0.3, mm_per_unit=0.7, lights=lights)
    with offscreen_window(session.size, 0) as window:
        drawn = Drawn(window, session, pipeline)
        # The bend of the outer half is one in at least one channel of most: E2 is at its limit.
        vertex = drawn.pixels()
        drawn.shaded()
        pixel = drawn.pixels()
    inside = _inside(vertex)
    assert inside.mean() > 0.2 and np.ptp(vertex[:120][inside]) > 50
    assert np.abs(vertex - pixel)[:120][inside].max() <= BYTES


def test_the_colours_of_a_file_are_in_it(torus, pipeline) -> None:
    session = _session(torus[1], scale=0.3)
    with offscreen_window(session.size, 0) as window:
        drawn = Drawn(window, session, pipeline)
        vertex = drawn.pixels()
        drawn.shaded()
        inside = _inside(vertex)
        assert np.ptp(vertex[:120][inside].astype(float) @ (1.0, -1.0, 0.0)) > 20
        assert np.abs(vertex - drawn.pixels())[:120][inside].max() <= BYTES


def test_a_movement_sends_uniforms_only_and_shows_what_would_be_computed(torus, pipeline) -> None:
    session = _session(torus[0], scale=0.3, exposure=2.0, lights=LIGHTS)
    turned = [replace(LIGHTS[0], direction=(0.2, 0.9, 0.4)), replace(LIGHTS[1], position=(1, 2, 5))]
    moved = replace(session, lights=(*turned, LIGHTS[2]), camera=PARALLEL)
    with offscreen_window(session.size, 0) as window:
        drawn = Drawn(window, session, pipeline)
        light = drawn.shaded()
        before, data = drawn.pixels(), drawn.actor.GetMapper().GetInput()
        sent = data.GetMTime(), drawn.actor.GetShaderProperty().GetShaderMTime()
        light.move(moved, drawn.made.camera, 1.0)
        after = drawn.pixels()
        now = data.GetMTime(), drawn.actor.GetShaderProperty().GetShaderMTime()
    assert now == sent
    assert np.abs(after - before).max() > 20
    again = replace(moved, camera=drawn.made.camera, exposure=1.0)
    with offscreen_window(session.size, 0) as window:
        vertex = Drawn(window, again, pipeline).pixels()
    assert np.abs(vertex - after)[:120][_inside(vertex)].max() <= BYTES


def test_what_is_taken_off_leaves_the_colours_of_vertices(torus, pipeline) -> None:
    session = _session(torus[0], scale=0.3)
    with offscreen_window(session.size, 0) as window:
        drawn = Drawn(window, session, pipeline)
        before = drawn.pixels()
        light = drawn.shaded()
        assert (drawn.pixels() != before).any()
        light.remove()
        np.testing.assert_array_equal(drawn.pixels(), before)


def test_places_are_right_on_a_mesh_of_another_size(torus, pipeline, tmp_path) -> None:
    """VTK draws from positions in a frame of its own, which depends on their extent."""
    import trimesh

    path = str(tmp_path / "large.ply")
    mesh = trimesh.load(torus[0], process=False)
    trimesh.Trimesh(20.0 * mesh.vertices, mesh.faces, process=False).export(path)
    near = [
        replace(LIGHTS[1], position=(-80.0, 60.0, 80.0), intensity=(2e3, 2e3, 3e3)),
        replace(LIGHTS[2], position=(80.0, -80.0, 100.0), intensity=(2e3, 4e3, 2e3)),
    ]
    session = _session(path, scale=6.0, mm_per_unit=0.1, lights=near)
    with offscreen_window(session.size, 0) as window:
        drawn = Drawn(window, session, pipeline)
        vertex = drawn.pixels()
        light = drawn.shaded()
        inside = _inside(vertex)
        assert np.abs(vertex - drawn.pixels())[:120][inside].max() <= BYTES
        light.remove()
        np.testing.assert_array_equal(drawn.pixels(), vertex)


def test_lights_of_other_kinds_are_followed_too(torus, pipeline) -> None:
    session = _session(torus[0], scale=0.3, exposure=1.0, lights=LIGHTS[:1])
    for lights in (LIGHTS[1:], LIGHTS[::-1], LIGHTS[:1]):
        with offscreen_window(session.size, 0) as window:
            drawn = Drawn(window, session, pipeline)
            light = drawn.shaded()
            drawn.pixels()
            again = replace(session, lights=lights)
            light.move(again, drawn.made.camera, 1.0)
            pixel = drawn.pixels()
        with offscreen_window(session.size, 0) as window:
            vertex = Drawn(window, again, pipeline).pixels()
        assert np.abs(vertex - pixel)[:120][_inside(vertex)].max() <= BYTES


def _looked_up(cells, span, a, b, channel):
    """Do what the shader does."""
    column = COLUMNS / 2 * (1.0 + (BEND + MOST) / MOST * a / (BEND + np.abs(a)))
    row = np.minimum(ROWS * np.sqrt(b) / (span + np.sqrt(b)), ROWS - 1e-3)
    i, j = np.floor(column).astype(int), np.floor(row).astype(int)
    f, g = column - i, row - j
    k = np.moveaxis(cells[j + ROWS * channel, i].astype(float), -1, 0)
    return (1.0 + b) * (k[0] + f * k[1] + g * (k[2] + f * k[3]))


@pytest.mark.parametrize("count", [1, 3, 4, 8])
@pytest.mark.parametrize("profile", ["jensen2001", "burley2015", "deon2012"])
def test_one_look_up_is_the_response_of_every_material(profile, count) -> None:
    rng = np.random.default_rng(0)
    a = np.concatenate([rng.uniform(-1, 1, 20_000), rng.normal(0, 0.05, 20_000).clip(-1, 1)])
    b = 10.0 ** rng.uniform(-5, 1.5, len(a))
    for material in materials():
        table = bake(material, profile=profile)
        corners, weights = hinges_of(table.eta, count)
        cells, span = response(table, corners, weights), halfway(table)
        for channel in range(3):
            arguments = (table.rows, table.inverse_step, channel)
            exact = even_forms(weights[channel], corners[channel], a, b, 1.0, *arguments)
            seen = _looked_up(cells, span[channel], a, b, channel)
            # The least area that the model divides by: of a cylinder.
            area = 1.0 + 3.0 / 16.0 * table.mean_square[channel] * b * b
            # Of the half byte that BYTES leaves; the more light, the more of it is seen.
            for exposure, most in ((1.0, 0.45), (3.0, 0.7)):
                bytes_ = [255.0 * srgb_encode(exposure * one / area) for one in (exact, seen)]
                assert np.abs(np.subtract(*bytes_)).max() < most, (material, channel)


def test_two_by_two_numbers_are_the_curvature_tensor() -> None:
    rng = np.random.default_rng(0)
    n, w = rng.normal(size=(2, 1000, 3))
    n[:4] = (0, 0, 1), (0, 0, -1), (1, 0, 0), (0, 1, -1e-32)
    n, w = (one / np.linalg.norm(one, axis=1, keepdims=True) for one in (n, w))
    n = n.astype(np.float32).astype(float)
    d1 = np.cross(n, rng.normal(size=n.shape))
    d1 /= np.linalg.norm(d1, axis=1, keepdims=True)
    k1, k2 = rng.normal(1.0, 1.0, (2, len(n)))
    shape = convex_part(k1, k2, d1, np.cross(n, d1), 1.0)
    tt, uu, tu = forms(n, shape).T
    # The frame of the shader.
    sign = np.where(n[:, 2] >= -1e-30, 1.0, -1.0)
    a = -1.0 / (sign + n[:, 2])
    b = n[:, 0] * n[:, 1] * a
    t = np.stack([1 + sign * n[:, 0] ** 2 * a, sign * b, -sign * n[:, 0]], 1)
    u = np.stack([b, sign + n[:, 1] ** 2 * a, -n[:, 1]], 1)
    p, q = (t * w).sum(1), (u * w).sum(1)
    bend = np.hypot(tt * p + tu * q, tu * p + uu * q)
    exact = [bending(shape, i, *w[i]) for i in range(len(n))]
    # Normals in single precision are off the tangent plane by 6e-8.
    np.testing.assert_allclose(bend, exact, atol=1e-6)


@pytest.mark.parametrize(
    ("fields", "reason"),
    [
        ({"view": "curvature"}, "view curvature"),
        ({"model": Method("wrap")}, "model wrap"),
        ({"lights": LIGHTS * 3}, f"{MOST_LIGHTS} lights"),
        ({"shadows": "on"}, "shadows"),
    ],
)
def test_what_stays_at_vertices_has_a_reason(pipeline, fields, reason) -> None:
    session = Session(mesh="sample:sphere", **fields)
    assert reason in unsupported(session, pipeline.subject(session))
