import json

import imageio.v3 as iio
import imageio_ffmpeg
import numpy as np
import pytest
from msgspec.structs import replace
from PIL import Image

from app import animation, picture
from app.animation import frames, stage
from app.animation_motion import Motion
from app.cli.main import main
from app.pipeline import Pipeline
from app.session import Camera, Cone, Directional, Method, Point, Session
from lutcore.errors import ParameterError

# A scale that is given keeps the work of a frame small.
TORUS = Session(mesh="sample:torus", estimator=Method("rusinkiewicz2004"), size=(96, 80))
GROUND = np.array([0x20, 0x24, 0x2A])


@pytest.fixture(scope="module")
def pipeline():
    return Pipeline()


def seen(image):
    """Tell which pixels show the object, the caption's strip left out."""
    return (image[: int(0.95 * len(image))] != GROUND).any(axis=2)


@pytest.mark.parametrize("kind", ["turntable", "light-sweep"])
def test_a_turn_ends_where_it_began(kind, pipeline):
    scene = stage(TORUS, pipeline, Motion(kind, 1.0, 8.0))
    first, last = scene.frame(0), scene.frame(8)
    for one, other in zip(first.lights, last.lights, strict=True):
        np.testing.assert_allclose(one.direction, other.direction, atol=1e-12)
    np.testing.assert_allclose(first.camera.position, last.camera.position, atol=1e-9)
    assert len(list(frames(scene, pipeline))) == 8


def test_a_turntable_turns_the_object_under_still_lights(pipeline):
    """A quarter turn shows the side, lit as the camera's axes say."""
    lights = (
        Directional((0.2, 0.3, 1.0)),
        Point((30.0, 5.0, 40.0)),
        Cone((30.0, 5.0, 40.0), (-3.0, 0.0, -4.0)),
        Directional((1.0, 0.0, 1.0), frame="camera"),
    )
    camera = Camera((0.0, 0.0, 60.0), (0.0, 0.0, 0.0))
    session = replace(TORUS, camera=camera, lights=lights)
    quarter = stage(session, pipeline, Motion("turntable", 1.0, 4.0)).frame(1)
    # What faced the camera turns to its right, so the camera comes to see what was on its left.
    np.testing.assert_allclose(quarter.camera.position, (-60.0, 0.0, 0.0), atol=1e-12)
    directional, point, cone, fixed = quarter.lights
    np.testing.assert_allclose(directional.direction, (-1.0, 0.3, 0.2), atol=1e-12)
    np.testing.assert_allclose(point.position, (-40.0, 5.0, 30.0), atol=1e-12)
    np.testing.assert_allclose(cone.direction, (4.0, 0.0, -3.0), atol=1e-12)
    assert fixed == lights[3]


def test_a_ball_on_a_turntable_looks_the_same_from_all_sides(pipeline):
    scene = stage(replace(TORUS, mesh="sample:sphere"), pipeline, Motion("turntable", 1.0, 5.0))
    drawn = [one.image.astype(int) for one in frames(scene, pipeline)]
    for other in drawn[1:]:
        apart = np.abs(drawn[0] - other)
        # Its triangles lie otherwise in each frame, above all at its outline.
        assert apart.mean() < 0.5
        assert np.percentile(apart, 99) <= 12


def test_a_light_sweep_moves_the_lights_and_nothing_else(pipeline):
    scene = stage(TORUS, pipeline, Motion("light-sweep", 1.0, 4.0))
    drawn = [one.image for one in frames(scene, pipeline)]
    shapes = [seen(image) for image in drawn]
    for shape, image in zip(shapes[1:], drawn[1:], strict=True):
        assert (shape == shapes[0]).mean() > 0.999
        assert np.abs(np.subtract(image, drawn[0], dtype=int)).mean() > 3.0
    lit = scene.frame(1).lights[0]
    assert lit.frame == "world"


@pytest.mark.parametrize("camera", ["front", "oblique"])
def test_the_object_stays_in_the_picture_as_it_turns(camera, pipeline):
    session = replace(TORUS, mesh="sample:ellipsoid", camera=camera)
    for one in frames(stage(session, pipeline, Motion("turntable", 1.0, 6.0)), pipeline):
        shape = seen(one.image)
        border = np.concatenate([shape[0], shape[-1], shape[:, 0], shape[:, -1]])
        assert not border.any()
        assert shape.mean() > 0.1


def test_one_exposure_serves_all_frames_and_is_the_least_of_theirs(pipeline):
    motion = Motion("light-sweep", 1.0, 8.0)
    scene = stage(TORUS, pipeline, motion)
    each = [
        picture.render(replace(scene.frame(i), exposure=None), pipeline).exposure for i in range(8)
    ]
    assert max(each) > 1.1 * min(each)
    assert scene.session.exposure == min(each)
    given = stage(replace(TORUS, exposure=2.0), pipeline, motion)
    assert given.session.exposure == 2.0


def test_curvature_is_computed_once_for_all_frames(monkeypatch):
    fresh, counted = Pipeline(), []
    estimate = fresh._estimate
    monkeypatch.setattr(fresh, "_estimate", lambda *given: counted.append(1) or estimate(*given))
    scene = stage(TORUS, fresh, Motion("turntable", 1.0, 12.0))
    assert len(list(frames(scene, fresh))) == 12
    assert len(counted) == 1


def test_differences_share_one_range(pipeline):
    models = (Method("lambert"), Method("wrap"))
    session = replace(TORUS, view="compare", compared=models, difference=True, size=(400, 120))
    scene = stage(session, pipeline, Motion("light-sweep", 1.0, 4.0))
    ranges = [picture.compose(scene.frame(i), pipeline).ranges["ciede2000"] for i in range(4)]
    assert len(set(ranges)) == 1


def test_what_auto_chooses_is_chosen_once(monkeypatch):
    from plugins.shading.wrap import Wrap

    # What models cost is measured on each machine, and takes its time.
    monkeypatch.setattr(Pipeline, "settled", lambda *_: Wrap(width=0.3))
    session = replace(TORUS, model=Method("auto"), shadows="auto")
    camera = Camera((0.0, 0.0, 60.0), (0.0, 0.0, 0.0))
    decided = animation._decided(session, Pipeline(), camera)
    assert decided.model == Method("wrap", {"width": 0.3})
    assert decided.shadows == "on"
    assert animation._decided(TORUS, Pipeline(), camera) == TORUS


def test_curvature_has_no_lights_to_sweep(pipeline):
    with pytest.raises(ParameterError, match="without lights"):
        stage(replace(TORUS, view="curvature"), pipeline, Motion("light-sweep"))
    assert animation.stage(replace(TORUS, view="curvature"), pipeline, Motion())


def test_a_gif_keeps_hundredths(tmp_path):
    gif, mp4 = tmp_path / "a.gif", tmp_path / "a.mp4"
    assert Motion(fps=12.0).kept_by(gif).fps == 12.5
    assert Motion(fps=12.0).kept_by(mp4).fps == 12.0
    # Viewers slow down what is shown for less than two hundredths.
    assert Motion(fps=60.0).kept_by(gif).fps == 50.0


FLAGS = ["sample:torus", "--method", "rusinkiewicz2004", "--size", "97x80", "--fps", "5"]


def test_a_gif_has_one_palette_and_repeats(tmp_path, capsys):
    path = tmp_path / "a.gif"
    assert main(["shade", *FLAGS, "-o", str(path), "--turntable", "1", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["frames"], found["fps"], found["motion"]) == (5, 5.0, "turntable")
    with Image.open(path) as gif:
        assert (gif.n_frames, gif.info["duration"], gif.info["loop"]) == (5, 200, 0)
        assert gif.size == (97, 80)
        palettes = set()
        for index in range(gif.n_frames):
            gif.seek(index)
            assert not gif.tile or gif.dispose_extent  # every frame is there
            palettes.add(bytes(gif.global_palette.palette))
        assert len(palettes) == 1
    # No frame brings colours of its own: the bit is set in no image descriptor.
    content = path.read_bytes()
    assert not any(flags & 0x80 for flags in descriptors(content))
    again = tmp_path / "b.gif"
    assert main(["shade", *FLAGS, "-o", str(again), "--turntable", "1", "--quiet"]) == 0
    assert again.read_bytes() == content


def descriptors(content):
    """Return the flags of each image descriptor of a GIF."""
    place, found = 13 + 3 * 2 ** ((content[10] & 7) + 1), []

    def skip(place):
        while content[place]:
            place += content[place] + 1
        return place + 1

    while content[place] != 0x3B:
        if content[place] == 0x21:
            place = skip(place + 2)
        else:
            found.append(content[place + 9])
            place = skip(place + 11)
    assert found
    return found


def test_an_mp4_has_even_sizes_and_the_frames_colours(tmp_path, capsys):
    path = tmp_path / "a.mp4"
    assert main(["figure", *FLAGS, "-o", str(path), "--light-sweep", "1", "--size", "301x140"]) == 0
    assert "even sizes: 302 x 140" in capsys.readouterr().err
    film = iio.imread(path)
    assert film.shape == (5, 140, 302, 3)
    # Coded at half the resolution in colour and rounded, but the same sRGB.
    np.testing.assert_allclose(film[:, 4, 4], np.tile(GROUND, (5, 1)), atol=3)
    about = next(imageio_ffmpeg.read_frames(str(path)))
    assert about["pix_fmt"].startswith("yuv420p(tv, bt709")
    assert about["codec"] == "h264"
    assert about["fps"] == 5.0


@pytest.mark.parametrize(
    ("flags", "words"),
    [
        (["-o", "a.gif"], "needs one of --turntable and --light-sweep"),
        (["-o", "a.gif", "--turntable", "--light-sweep"], "needs one of"),
        (["-o", "a.png", "--turntable"], "write -o NAME.gif"),
        (["-o", "a.png", "--fps", "9"], "write -o NAME.gif"),
        (["-o", "a.gif", "--turntable", "0"], "seconds"),
        (["-o", "a.gif", "--turntable", "nan"], "seconds"),
        (["-o", "a.mp4", "--turntable", "--fps", "1000"], "fps"),
        (["-o", "a.gif", "--turntable", "--reference", "r.png"], "compared with a picture"),
        (["-o", "a.gif", "--turntable", "soon"], "no number of seconds"),
    ],
)
def test_flags_that_do_not_fit_exit_2_and_write_nothing(
    flags, words, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    assert main(["shade", "sample:torus", *flags]) == 2
    assert words in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_what_fails_half_way_leaves_the_old_file(suffix, tmp_path, monkeypatch):
    path = tmp_path / f"a.{suffix}"
    path.write_bytes(b"old")
    drawn = []

    def fail(session, pipeline):
        drawn.append(1)
        if len(drawn) > 12:
            raise KeyboardInterrupt
        return picture.render(session, pipeline)

    monkeypatch.setattr(animation, "render", fail)
    arguments = ["shade", *FLAGS, "-o", str(path), "--turntable", "4", "--quiet"]
    assert main(arguments) == 130
    assert path.read_bytes() == b"old"
    assert [one.name for one in tmp_path.iterdir()] == [path.name]


def test_an_encoder_that_stops_is_told(tmp_path, monkeypatch, capsys):
    path = tmp_path / "a.mp4"
    monkeypatch.setattr(imageio_ffmpeg, "count_frames_and_secs", lambda path: (3, 0.6))
    arguments = ["shade", *FLAGS, "-o", str(path), "--turntable", "1", "--quiet"]
    assert main(arguments) == 1
    assert f"{path}: the encoder wrote 3 of 5 frames" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
