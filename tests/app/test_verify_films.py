"""Animations that are drawn again from themselves, and those that were changed."""

import json
import shutil

import imageio.v3 as iio
import numpy as np
import pytest
from msgspec.structs import replace
from PIL import Image

from app import gif, mp4
from app.animation_files import read_film
from app.animation_motion import Motion
from app.cli.main import main
from app.loading import load_mesh
from app.provenance import said
from app.samples import sample
from sample_meshes.ply import write_ply

MOTION = Motion("turntable", 1.0, 4.0)
FLAGS = ["--method", "rusinkiewicz2004", "--size", "120x100", "--fps", "4", "--turntable", "1"]


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A mesh, and films of it."""
    folder = tmp_path_factory.mktemp("films")
    shutil.copy(sample("torus").path, folder / "m.ply")
    for name in ("a.gif", "a.mp4"):
        words = ["shade", str(folder / "m.ply"), "-o", str(folder / name), *FLAGS, "--quiet"]
        assert main(words) == 0
    return folder


@pytest.fixture
def folder(made, tmp_path):
    shutil.copytree(made, tmp_path / "own")
    return tmp_path / "own"


def answered(capsys, *arguments):
    capsys.readouterr()
    code = main(["verify", *map(str, arguments), "--json"])
    return code, json.loads(capsys.readouterr().out)


def rewritten(path, change=lambda frames: frames, text=None):
    """Write a film again, by its own means, with other frames or another comment."""
    container = mp4 if path.suffix == ".mp4" else gif
    text = container.read_comment(path) if text is None else text
    other = path.with_name(f"other{path.suffix}")
    if container is gif:
        frames = change([np.array(one) for one in gif.read(path, MOTION)])
        colors = gif.palette(frames)
        gif.write(other, gif.indexed(frames, colors), MOTION)
        gif.write_comment(other, text)
        return other
    frames = change([np.array(one) for one in mp4.read(path)])
    bare = path.with_name("bare.mp4")
    assert mp4.write(bare, frames, (120, 100), MOTION) == len(frames)
    assert mp4.write_comment(bare, other, text)
    return other


def painted(frames):
    frames[2][30:60, 30:60] = (250, 10, 10)
    return frames


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_a_film_is_drawn_again_from_itself(suffix, folder, capsys):
    code, found = answered(capsys, folder / f"a.{suffix}")
    assert code == 0 and found["same"] and found["drawn_again_exactly"]
    assert found["frames"] == {"written": 4, "found": 4}
    assert found["frames_differing"] == (0 if suffix == "gif" else 4)
    assert "bit for bit" in found["findings"][0]


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_its_record_says_how_it_was_made(suffix, folder):
    film = read_film(folder / f"a.{suffix}").record
    assert film.motion == MOTION
    assert film.session.size == (120, 100) and film.session.camera == "auto"
    assert film.resolved.camera.position and film.backend.label
    assert film.mesh.vertices == len(load_mesh(folder / "m.ply").mesh.vertices)
    content = (folder / f"a.{suffix}").read_bytes()
    assert str(folder).encode() not in content  # the mesh's path begins at the film
    assert b'"mesh":"m.ply"' in content.replace(b"\xff", b"") or suffix == "gif"


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_a_session_starts_from_a_film(suffix, folder, capsys):
    again = folder / f"b.{suffix}"
    words = ["draw", "--session", str(folder / f"a.{suffix}"), "-o", str(again), "--fps", "4"]
    assert main([*words, "--turntable", "1", "--quiet"]) == 0
    assert again.read_bytes() == (folder / f"a.{suffix}").read_bytes()


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_a_moved_vertex_is_told(suffix, folder, capsys):
    loaded = load_mesh(folder / "m.ply").mesh
    points = loaded.vertices.copy()
    points[np.argmax(points[:, 2])] += (0.0, 0.0, 3.0)
    write_ply(folder / "m.ply", points, loaded.faces)
    code, found = answered(capsys, folder / f"a.{suffix}")
    assert code == 6 and found["mesh_changed"] and not found["pixels_edited"]
    assert "is not the one that was drawn" in " ".join(found["findings"])


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_a_frame_that_was_painted_is_found(suffix, folder, capsys):
    code, found = answered(capsys, rewritten(folder / f"a.{suffix}", painted))
    assert code == 6 and found["pixels_edited"] and not found["metadata_edited"]
    assert found["worst_frame"] == 2 and found["drawn_again_exactly"]
    difference = folder / "d.png"
    assert main(["verify", str(folder / f"other.{suffix}"), "-o", str(difference)]) == 6
    with Image.open(difference) as sheet:
        assert sheet.width == 3 * 120


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_a_frame_that_is_missing_is_told(suffix, folder, capsys):
    code, found = answered(capsys, rewritten(folder / f"a.{suffix}", lambda frames: frames[:-1]))
    assert code == 6 and found["frames"] == {"written": 4, "found": 3}
    assert "4 frames were written, and the file has 3" in found["findings"][0]


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_edited_metadata_are_told(suffix, folder, capsys):
    path = folder / f"a.{suffix}"
    text = (mp4 if suffix == "mp4" else gif).read_comment(path)
    edited = rewritten(path, text=text.replace('"vertices":', '"vertices":1'))
    code, found = answered(capsys, edited)
    assert code == 6 and found["metadata_edited"]


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_another_version_is_told(suffix, folder, capsys):
    path = folder / f"a.{suffix}"
    record = read_film(path).record
    other = replace(record, versions=record.versions | {"curvelight": "0.0.1"})
    code, found = answered(capsys, rewritten(path, text=said(other, folder)))
    assert found["versions"]["curvelight"][0] == "0.0.1" and not found["metadata_edited"]
    # Of an MP4 that was encoded twice the frames are still near enough; a GIF's bits are others.
    assert code in (0, 6)


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_what_cannot_be_read_is_told(suffix, folder, capsys):
    path = folder / f"x.{suffix}"
    frames = np.random.default_rng(3).integers(0, 255, (3, 32, 32, 3), dtype=np.uint8)
    iio.imwrite(path, frames)
    assert main(["verify", str(path)]) == 3
    assert "does not say how it was made" in capsys.readouterr().err
    path.write_bytes((folder / f"a.{suffix}").read_bytes()[:60])
    assert main(["verify", str(path)]) == 3
    assert str(path) in capsys.readouterr().err
    path.unlink()
    assert main(["verify", str(path)]) == 3
    assert "no such file" in capsys.readouterr().err
    (folder / "m.ply").unlink()
    assert main(["verify", str(folder / f"a.{suffix}")]) == 3
    assert "--mesh FILE" in capsys.readouterr().err


def test_frames_that_stay_are_counted_as_often_as_they_last(tmp_path):
    still = [np.full((20, 30, 3), value, np.uint8) for value in (10, 10, 10, 200)]
    path = tmp_path / "still.gif"
    gif.write(path, gif.indexed(still, gif.palette(still)), MOTION)
    with Image.open(path) as picture:
        assert picture.n_frames == 2  # Pillow stores them once
    np.testing.assert_array_equal(list(gif.read(path, MOTION)), still)


@pytest.mark.parametrize("text", ["a=b;c#d\\e", 'two\nlines "quoted"', "\u03c3 \\\\", "x" * 3000])
def test_comments_come_back_as_they_were(text, folder):
    gif.write_comment(folder / "a.gif", "")
    other = rewritten(folder / "a.gif", text=text)
    assert gif.read_comment(other) == text
    assert mp4.write_comment(folder / "a.mp4", folder / "b.mp4", text)
    assert mp4.read_comment(folder / "b.mp4") == text
