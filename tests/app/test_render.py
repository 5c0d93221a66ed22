import numpy as np
import pytest

from app import gl
from app.colormaps import table
from app.render import Panel, draw
from app.scene import ColorScale, Surface, label_digits
from app.session import Camera
from lutcore.errors import ParameterError
from lutcore.mesh import TriangleMesh

SQUARE = TriangleMesh([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2], [0, 2, 3]])
CAMERA = Camera((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), height=2.5)
NORMALS = np.tile((0.0, 0.0, 1.0), (4, 1))


def square(mesh=SQUARE, color=(10, 200, 30)):
    return Surface(mesh, NORMALS, rgb=np.tile(np.uint8(color), (4, 1)))


def test_vertex_colours_reach_the_picture_unchanged_and_the_rest_is_background():
    image = draw([Panel(square(), 1.0, CAMERA)], (100, 100), "#204060").image
    assert image.shape == (100, 100, 3)
    assert image[50, 50].tolist() == [10, 200, 30]
    assert image[2, 2].tolist() == [0x20, 0x40, 0x60]


def test_the_first_row_is_the_top():
    mesh = TriangleMesh(SQUARE.vertices * (1.0, 0.5, 1.0) + (0.0, 0.5, 0.0), SQUARE.faces)
    image = draw([Panel(square(mesh), 1.0, CAMERA)], (100, 100), "black").image
    assert image[20, 50].any()
    assert not image[80, 50].any()


def test_a_picture_is_the_same_bit_for_bit_every_time():
    panels = [Panel(square(), 0.5, CAMERA), Panel(scale(), 0.5)]
    one, other = (draw(panels, (200, 150), "white").image for _ in range(2))
    np.testing.assert_array_equal(one, other)


def test_a_mesh_a_million_units_away_gives_the_same_picture():
    far = TriangleMesh(SQUARE.vertices + 1e6, SQUARE.faces)
    camera = Camera((1e6, 1e6, 1e6 + 5.0), (1e6, 1e6, 1e6), height=2.5)
    np.testing.assert_array_equal(
        draw([Panel(square(far), 1.0, camera)], (64, 64), "black").image,
        draw([Panel(square(), 1.0, CAMERA)], (64, 64), "black").image,
    )


def scale():
    return ColorScale(table("green-red"), 0.0, 1.0, "title")


def test_scalars_between_vertices_take_the_maps_colours_not_mixtures_of_the_ends():
    values = np.array([0.0, 1.0, 1.0, 0.0])
    surface = Surface(SQUARE, NORMALS, values=values, scale=scale())
    middle = draw([Panel(surface, 1.0, CAMERA)], (101, 101), "black").image[50, 50]
    # The map is yellow half way: a mixture of its green and red ends would have no such green.
    np.testing.assert_allclose(middle, 255.0 * table("green-red")[128], atol=4)


def test_the_colour_bar_shows_its_map_from_bottom_to_top():
    image = draw([Panel(scale(), 1.0)], (120, 400), "black").image.astype(int)
    column = image[:, 30]
    colored = column[column.max(axis=1) - column.min(axis=1) > 60]
    assert colored[0, 0] > 150 > colored[0, 1]
    assert colored[-1, 1] > colored[-1, 0]


def test_rows_are_filled_from_the_top_and_the_left():
    colors = [(200, 0, 0), (0, 200, 0), (0, 0, 200), (200, 200, 0)]
    panels = [Panel(square(color=color), 0.5, CAMERA) for color in colors]
    image = draw(panels, (200, 200), "black", rows=2).image
    seen = [image[y, x].tolist() for y in (45, 145) for x in (50, 150)]
    assert seen == [list(color) for color in colors]


def test_captions_of_one_picture_are_equally_large():
    def captioned(*captions):
        panels = [
            Panel(Surface(SQUARE, NORMALS, caption=caption), 0.5, CAMERA) for caption in captions
        ]
        return draw(panels, (600, 1000), "black").image[-45:, :300]

    short = captioned("ab", "ab")
    beside_long = captioned("ab", "a caption that needs much smaller letters than two")
    rows = [np.count_nonzero(strip.any(axis=(1, 2))) for strip in (short, beside_long)]
    assert 0 < rows[1] < rows[0]


def test_drawing_without_opengl_is_refused_in_words(monkeypatch):
    monkeypatch.setattr(gl, "_loads", lambda library: library != "libEGL.so.1")
    monkeypatch.setattr(gl.sys, "platform", "linux")
    with pytest.raises(gl.DrawingError, match="apt-get install libegl1"):
        draw([Panel(square(), 1.0, CAMERA)], (64, 64), "black")


def test_drawing_leaves_the_environment_as_it_was(monkeypatch):
    monkeypatch.delenv("VTK_DEFAULT_OPENGL_WINDOW", raising=False)
    draw([Panel(square(), 1.0, CAMERA)], (64, 64), "black")
    assert "VTK_DEFAULT_OPENGL_WINDOW" not in gl.os.environ


def test_a_background_that_is_no_colour_is_refused():
    with pytest.raises(ParameterError, match="background"):
        draw([Panel(square(), 1.0, CAMERA)], (64, 64), "greyish")


def test_a_colormap_that_does_not_exist_is_refused_with_the_nearest():
    with pytest.raises(ParameterError, match="did you mean 'viridis'"):
        table("viridi")


@pytest.mark.parametrize(
    ("low", "high", "digits"),
    [(0.0, 1.0, 3), (-0.05, 0.12, 3), (2.0, 2.02, 4), (0.285, 0.288, 4), (5.0, 5.00001, 7)],
)
def test_numbers_beside_a_colour_bar_differ(low, high, digits):
    assert label_digits(low, high) == digits
