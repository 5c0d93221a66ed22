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
from app.shader.look import HALF, MOST_LIGHTS, look_of, unsupported
from lutcore.baking import bake

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
        light = PixelLight(self.look, [(self.actor, None)], self.origin)
        light.move(self.session, self.made.camera, self.made.exposure)
        return light


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


def test_the_colours_of_a_file_are_in_it(torus, pipeline) -> None:
    session = _session(torus[1], scale=0.3)
    with offscreen_window(session.size, 0) as window:
        drawn = Drawn(window, session, pipeline)
        vertex = drawn.pixels()
        drawn.shaded()
        inside = _inside(vertex)
        assert "albedo" in drawn.look.attributes
        assert np.abs(vertex - drawn.pixels())[:120][inside].max() <= BYTES


def test_a_movement_sends_uniforms_only_and_shows_what_would_be_computed(torus, pipeline) -> None:
    session = _session(torus[0], scale=0.3, exposure=2.0)
    moved = replace(session, lights=LIGHTS, camera=PARALLEL)
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


@pytest.mark.parametrize("profile", ["jensen2001", "burley2015", "deon2012"])
@pytest.mark.parametrize("material", ["skin1", "marble", "skimmilk"])
def test_lines_between_the_samples_are_psi(pipeline, material, profile) -> None:
    session = Session(mesh="sample:sphere", material=material, profile=Method(profile), scale=0.3)
    made = look_of(session, pipeline, np.eye(3))
    x = np.random.default_rng(0).uniform(1e-3, 1.0, 20_000)
    knots = np.linspace(0.0, 1.0, made.table.shape[1])
    table = bake(material, profile=profile)
    for channel in range(3):
        b = x / HALF
        # Below the horizon there is b psi(|a|/b) alone.
        shone = table.evaluate(x - 1.0, b / table.mean_free_path[channel])[:, channel]
        psi = shone / table.total[channel] / b
        # A twentieth of a byte where sRGB is steepest: 12.92 x 255 x 1e-5 is 0.03.
        np.testing.assert_allclose(np.interp(x, knots, made.table[channel]), psi, atol=1e-5)


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
