import numpy as np
import pytest
from msgspec.structs import replace

from app.picture import render
from app.pipeline import Pipeline
from app.quantities import QUANTITIES
from app.session import Camera, Directional, Method, Session
from lutcore.baking import bake
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import ParameterError
from lutcore.fresnel import mean_transmittance, transmittance
from lutcore.materials import material

TORUS = Session(mesh="sample:torus", estimator=Method("rusinkiewicz2004"), size=(160, 120))


@pytest.fixture(scope="module")
def pipeline():
    return Pipeline()


@pytest.mark.parametrize("view", ["shade", "curvature", "figure"])
def test_a_session_gives_the_same_picture_bit_for_bit(view, pipeline):
    session = replace(TORUS, view=view)
    one, other = render(session, pipeline), render(session, Pipeline())
    np.testing.assert_array_equal(one.image, other.image)
    assert one.image.shape == (120, 160, 3)
    assert one.image.std() > 5.0


@pytest.mark.parametrize("quantity", [name for name in QUANTITIES if name != "disagreement"])
def test_every_quantity_is_drawn(quantity, pipeline):
    made = render(replace(TORUS, view="curvature", quantity=quantity), pipeline)
    low, high = made.range
    assert low < high


def test_lengths_on_the_colour_bar_are_millimetres(pipeline):
    session = replace(TORUS, view="curvature")
    one = render(session, pipeline).range
    tenth = render(replace(session, mm_per_unit=10.0), pipeline).range
    np.testing.assert_allclose(np.multiply(tenth, 10.0), one, rtol=1e-9)


def test_the_map_can_be_symmetric_and_turned_round(pipeline):
    session = replace(TORUS, view="curvature", quantity="mean", flat=True)
    low, high = render(replace(session, symmetric=True), pipeline).range
    assert low == -high
    turned = render(replace(session, flip=True), pipeline).image
    straight = render(session, pipeline).image
    viridis = render(replace(session, colormap="viridis_r"), pipeline).image
    np.testing.assert_array_equal(
        render(replace(session, colormap="viridis", flip=True), pipeline).image, viridis
    )
    assert not np.array_equal(turned, straight)


def test_a_given_range_and_exposure_are_used(pipeline):
    made = render(replace(TORUS, view="figure", range=(0.0, 1.0), exposure=2.0), pipeline)
    assert made.range == (0.0, 1.0)
    assert made.exposure == 2.0


def test_a_stronger_light_needs_a_lower_exposure_and_gives_the_same_picture(pipeline):
    one = replace(TORUS, lights=(Directional((0.0, 0.0, 1.0), (1.0, 1.0, 1.0)),))
    two = replace(TORUS, lights=(Directional((0.0, 0.0, 1.0), (4.0, 4.0, 4.0)),))
    first, second = render(one, pipeline), render(two, pipeline)
    assert first.exposure == pytest.approx(4.0 * second.exposure)
    np.testing.assert_array_equal(first.image, second.image)


def test_a_comparison_has_one_exposure_and_states_the_difference(pipeline):
    pair = (Method("lambert"), Method("curvature-lut"))
    made = render(replace(TORUS, view="compare", compared=pair, difference=True), pipeline)
    assert set(made.difference["curvature-lut"]) == {"mean", "p99", "max", "vertex", "position"}
    same = render(replace(TORUS, view="compare", compared=(pair[0], pair[0])), pipeline)
    half = same.image.shape[1] // 2
    # One step in 255: the halves lie at different places, so interpolation rounds differently.
    apart = np.abs(np.subtract(same.image[:90, :half], same.image[:90, half:], dtype=int))
    assert apart.max() <= 1


def test_differences_of_several_models_lie_below_them(pipeline):
    three = (Method("lambert"), Method("lambert"), Method("curvature-lut"))
    made = render(replace(TORUS, view="compare", compared=three, difference=True), pipeline)
    assert made.difference["lambert"]["max"] == 0.0 < made.difference["curvature-lut"]["mean"]
    height, width, _ = made.image.shape
    top = made.image[: height // 2 - 20, : width // 3]
    bar = made.image[height // 2 :, : width // 3]
    assert np.abs(top.mean(axis=(0, 1)) - bar.mean(axis=(0, 1))).max() > 1.0


def test_a_comparison_of_one_is_refused(pipeline):
    with pytest.raises(ParameterError, match="two models"):
        render(replace(TORUS, view="compare", compared=(Method("lambert"),)), pipeline)


def test_a_camera_in_numbers_is_used_and_a_parallel_one_has_no_perspective(pipeline):
    camera = Camera((0.0, 60.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, -1.0), height=30.0)
    made = render(replace(TORUS, camera=camera), pipeline)
    assert made.camera == camera
    # The torus lies in the xy plane and reaches 13.5 on either side: 27/30 of the height at most.
    background = np.array([0x20, 0x24, 0x2A])
    drawn = (made.image[:110] != background).any(axis=2)
    columns = np.flatnonzero(drawn.any(axis=0))
    # 27 mm of 30 are seen over the height less the caption's strip; perspective would add 12 %.
    assert columns[-1] - columns[0] == pytest.approx(27.0 / 30.0 * 120.0 * 0.955, abs=2.0)


def test_a_pixel_is_what_the_formulas_say(tmp_path, pipeline):
    """Lambert on a grey square, seen and lit aslant: every factor by hand."""
    path = tmp_path / "g.off"
    corners = ["-9 -9 0", "9 -9 0", "9 9 0", "-9 9 0"]
    lines = [f"{corner} 128 128 128 255" for corner in corners]
    path.write_text("\n".join(["COFF", "4 2 0", *lines, "3 0 1 2", "3 0 2 3", ""]))
    session = replace(
        TORUS,
        mesh=str(path),
        model=Method("lambert"),
        lights=(Directional((0.0, 3.0, 4.0), (2.0, 2.0, 2.0)),),
        camera=Camera((0.0, -30.0, 10.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), height=4.0),
        exposure=1.0,
    )
    pixel = render(session, pipeline).image[57, 80]
    skin = material("skin1")
    reflectance = bake(skin).total
    exit_factor = transmittance(10.0 / np.sqrt(1000.0), skin.eta[0])
    albedo = ((128.0 / 255.0 + 0.055) / 1.055) ** 2.4
    light = 2.0 * 0.8 * reflectance * mean_transmittance(skin.eta[0]) * exit_factor * albedo
    expected = 255.0 * (1.055 * light ** (1.0 / 2.4) - 0.055)
    np.testing.assert_allclose(pixel, expected, atol=1.0)


@pytest.mark.parametrize(
    ("name", "value"),
    [("k1", 0.3), ("k2", -0.1), ("mean", 0.1), ("gauss", -0.03), ("curvedness", 0.05**0.5)],
)
def test_a_quantity_is_what_its_name_says_in_millimetres(name, value):
    one = np.ones(1)
    curved = PrincipalCurvatures(
        0.3 * one, -0.1 * one, *(np.zeros((1, 3)) for _ in range(3)), one, 0.0
    )
    power = 2 if name == "gauss" else 1
    assert QUANTITIES[name].values(curved, 2.0)[0] == pytest.approx(value / 2.0**power)


def test_vertex_colours_are_albedo_unless_turned_off(tmp_path, pipeline):
    path = tmp_path / "c.off"
    corners = ["0 0 0", "1 0 0", "1 1 0", "0 1 0"]
    lines = [f"{corner} 255 0 0 255" for corner in corners]
    path.write_text("\n".join(["COFF", "4 2 0", *lines, "3 0 1 2", "3 0 2 3", ""]))
    session = replace(TORUS, mesh=str(path), lights=(Directional((0.0, 0.0, 1.0)),))
    center = render(session, pipeline).image[60, 80]
    assert center[0] > 100
    assert center[1] == center[2] == 0
    assert render(replace(session, albedo=False), pipeline).image[60, 80, 1] > 100


def test_a_panel_of_all_quantities_is_the_picture_of_that_quantity(pipeline):
    session = replace(TORUS, view="curvature", quantity="all", flat=True, size=(800, 400))
    made = render(session, pipeline)
    assert made.range is None
    alone = {name: render(replace(session, quantity=name), pipeline).range for name in made.ranges}
    assert made.ranges == alone
    assert len(alone) == 8
    # The same camera: each panel hides the same pixels of the ground.
    bare = (made.image[:150] == made.image[0, 0]).all(axis=2)
    shapes = [bare[:, left : left + 120] for left in range(0, 800, 200)]
    for shape in shapes[1:]:
        assert (shape != shapes[0]).mean() < 0.01
    assert 0.1 < shapes[0].mean() < 0.9


def test_a_figure_shows_one_quantity(pipeline):
    with pytest.raises(ParameterError, match="one quantity"):
        render(replace(TORUS, view="figure", quantity="all"), pipeline)
