import json
import shutil

import numpy as np
import pytest
from msgspec.structs import replace
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from app.backend import Backend
from app.cli.main import main
from app.likeness import LEAST_SSIM, likeness, write_difference
from app.loading import load_mesh
from app.pipeline import Pipeline
from app.provenance import KEYWORD, read_pixels, read_record, write_picture
from app.samples import sample
from app.verifying import verify
from sample_meshes.ply import write_ply

FAST = ["--method", "rusinkiewicz2004", "--size", "160x120"]


def image(path):
    return np.asarray(Image.open(path).convert("RGB"))


@pytest.fixture
def shaded(tmp_path):
    """A mesh, and a picture of it."""
    shutil.copy(sample("torus").path, tmp_path / "m.ply")
    picture = tmp_path / "p.png"
    assert main(["shade", str(tmp_path / "m.ply"), "-o", str(picture), *FAST, "--quiet"]) == 0
    return picture


def answered(capsys, *arguments):
    capsys.readouterr()
    code = main(["verify", *map(str, arguments), "--json"])
    return code, json.loads(capsys.readouterr().out)


def remade(picture, pixels=None, text=None, **changes):
    """Write the picture again: with a true record that says otherwise, or with a false one."""
    stored = read_record(picture).record
    path = picture.with_name("other.png")
    if changes:
        write_picture(path, read_pixels(picture), replace(stored, **changes))
        return path
    whole = Image.open(picture)
    info = PngInfo()
    info.add_itxt(KEYWORD, (text or str)(whole.text[KEYWORD]))
    Image.fromarray(np.asarray(whole) if pixels is None else pixels).save(path, pnginfo=info)
    return path


PICTURES = {
    "shade": ["shade"],
    "wrap": ["shade", "--model", "wrap", "--width", "0.4", "--material", "marble"],
    "lit": ["shade", "--light", "-1,0.5,1,0.7", "--point-light", "20,20,20,900", "--shadows", "on"],
    "curvature": ["curvature", "--quantity", "k1", "--symmetric"],
    "figure": ["figure", "--camera", "oblique", "--exposure", "3"],
    "compare": ["compare", "--models", "lambert,curvature-lut", "--difference"],
}


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_is_reproduced_bit_for_bit(name, tmp_path, capsys):
    command, *flags = PICTURES[name]
    path = str(tmp_path / "p.png")
    assert main([command, "sample:torus", "-o", path, *flags, *FAST, "--quiet"]) == 0
    code, found = answered(capsys, path)
    assert code == 0
    assert found["same"]
    assert found["likeness"]["pixels"] == 0
    assert found["likeness"]["threshold"] is None
    assert found["findings"][0].startswith("reproduced bit for bit")


def test_a_moved_vertex_is_told_in_words_and_shown(shaded, capsys):
    mesh = load_mesh(shaded.with_name("m.ply")).mesh
    moved = mesh.vertices.copy()
    moved[np.argmax(moved @ (0.2, 0.6, 0.8))] *= 1.05
    write_ply(shaded.with_name("m.ply"), moved, mesh.faces)
    shown = shaded.with_name("d.png")
    code, found = answered(capsys, shaded, "-o", shown)
    assert code == 6
    assert found["mesh_changed"]
    assert not found["metadata_edited"]
    assert not found["pixels_edited"]
    assert "is not the one that was drawn" in found["findings"][1]
    parts = image(shown)[:120].reshape(120, 3, 160, 3).transpose(1, 0, 2, 3)
    np.testing.assert_array_equal(parts[0], image(shaded))
    differing = (parts[0] != parts[1]).any(axis=2)
    assert 0 < differing.sum() == found["likeness"]["pixels"] < 0.2 * differing.size
    # The map is black where nothing differs and brightest where most does.
    assert parts[2][~differing].max() <= 4
    assert parts[2][differing].max() > 150


def test_an_edited_record_is_told_in_words(shaded, capsys):
    edited = remade(shaded, text=lambda text: text.replace('"skin1"', '"marble"'))
    code, found = answered(capsys, edited)
    assert code == 6
    assert found["metadata_edited"]
    assert not found["mesh_changed"]
    assert "metadata were edited after it was written" in found["findings"][1]
    # Even where the edit does not show.
    harmless = remade(shaded, text=lambda text: text.replace('"numpy":"', '"numpy":"0.'))
    code, found = answered(capsys, harmless)
    assert (code, found["likeness"]["pixels"], found["metadata_edited"]) == (6, 0, True)


def test_an_edited_pixel_is_told_in_words(shaded, capsys):
    pixels = image(shaded).copy()
    pixels[5, 5] = 255, 0, 0
    code, found = answered(capsys, remade(shaded, pixels))
    assert code == 6
    assert found["pixels_edited"]
    assert not found["metadata_edited"]
    assert found["likeness"]["pixels"] == 1
    assert "the redrawn picture is the one that was written" in found["findings"][1]


def test_another_version_is_told_in_words(shaded, capsys):
    record = read_record(shaded).record
    versions = record.versions | {"curvelight": "0.0.7", "scipy": "1.0"}
    session = replace(record.session, material="marble")  # as if that version shaded otherwise
    code, found = answered(capsys, remade(shaded, versions=versions, session=session))
    assert code == 6
    assert set(found["versions"]) == {"curvelight", "scipy"}
    assert not found["metadata_edited"]
    (words,) = found["findings"][1:]
    assert "made by Curvelight 0.0.7, this is" in words
    assert "scipy 1.0 (here" in words
    assert "install Curvelight 0.0.7" in words
    code, found = answered(capsys, remade(shaded, versions=versions))
    assert code == 0
    assert "install" not in found["findings"][1]


def test_another_driver_is_judged_as_eyes_would(shaded, capsys):
    other = remade(shaded, backend=Backend("V", "Fast GPU", "4.6"))
    code, found = answered(capsys, other)
    assert code == 0
    assert "drawn by Fast GPU" in found["elsewhere"]
    assert found["likeness"]["threshold"] == 5.0
    # Its outlines may differ, a patch of 12 x 12 pixels that is clearly another colour may not.
    record, pixels = read_record(other).record, image(shaded).copy()
    pixels[60, ::2] = np.minimum(pixels[60, ::2], 235) + 20
    path = shaded.with_name("drawn_elsewhere.png")
    write_picture(path, pixels, replace(record, pixels=pixels_digest(pixels)))
    assert verify(path, Pipeline()).same
    pixels[60:72, 60:72] = 0, 90, 0
    write_picture(path, pixels, replace(record, pixels=pixels_digest(pixels)))
    assert not verify(path, Pipeline()).same
    assert verify(path, Pipeline(), threshold=100.0).likeness.local > 5.0


def pixels_digest(pixels):
    from app.record import pixels_digest

    return pixels_digest(pixels)


def test_a_mesh_that_moved_can_be_named(shaded, capsys):
    (shaded.parent / "sub").mkdir()
    moved = shaded.with_name("m.ply").rename(shaded.parent / "sub" / "other.ply")
    assert main(["verify", str(shaded)]) == 3
    assert "say where it is: --mesh FILE" in capsys.readouterr().err
    code, found = answered(capsys, shaded, "--mesh", moved)
    assert code == 0
    assert not found["mesh_changed"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("not JSON", "metadata is damaged"),
        ("", "does not say how it was made"),
    ],
)
def test_a_foreign_picture_exits_3(text, words, shaded, capsys):
    foreign = shaded.with_name("f.png")
    info = PngInfo()
    if text:
        info.add_itxt(KEYWORD, text)
    Image.open(shaded).save(foreign, pnginfo=info)
    assert main(["verify", str(foreign)]) == 3
    errors = capsys.readouterr().err
    assert words in errors
    assert len(errors.splitlines()) == 1


def test_a_picture_whose_plug_in_is_missing_says_what_to_install(shaded, capsys):
    record = read_record(shaded).record
    session = replace(record.session, model=replace(record.session.model, name="theirs2027"))
    assert main(["verify", str(remade(shaded, session=session))]) == 3
    errors = capsys.readouterr().err
    assert "unknown shading model 'theirs2027'" in errors
    assert "install what drew it" in errors


def test_the_difference_never_replaces_what_it_was_made_of(shaded, capsys):
    before = shaded.read_bytes()
    assert main(["verify", str(shaded), "-o", str(shaded)]) == 2
    assert main(["verify", str(shaded), "-o", str(shaded.with_suffix(".jpg"))]) == 2
    assert shaded.read_bytes() == before


def test_a_picture_is_a_session_file_too(shaded, tmp_path):
    again = tmp_path / "again.png"
    assert main(["shade", "--session", str(shaded), "-o", str(again), "--quiet"]) == 0
    assert again.read_bytes() == shaded.read_bytes()


def test_a_reference_that_is_the_same_passes(shaded, tmp_path, capsys):
    arguments = ["shade", str(tmp_path / "m.ply"), "-o", str(tmp_path / "n.png"), *FAST, "--json"]
    assert main([*arguments, "--reference", str(shaded)]) == 0
    found = json.loads(capsys.readouterr().out)["reference"]
    assert found["alike"]
    assert found["pixels"] == 0
    assert not (tmp_path / "n-difference.png").exists()


def test_a_reference_that_differs_exits_6_and_shows_where(shaded, tmp_path, capsys):
    arguments = ["shade", str(tmp_path / "m.ply"), "-o", str(tmp_path / "n.png"), *FAST]
    other = [*arguments, "--exposure", "2.9", "--reference", str(shaded)]
    assert main(other) == 6
    assert "DIFFERS from" in capsys.readouterr().out
    assert (tmp_path / "n.png").exists()
    assert image(tmp_path / "n-difference.png").shape[1] == 3 * 160
    assert main([*other, "--threshold", "5"]) == 0


def test_a_reference_of_another_size_or_program_is_compared_too(shaded, tmp_path, capsys):
    mesh, out = str(tmp_path / "m.ply"), str(tmp_path / "n.png")
    plain = tmp_path / "plain.png"
    Image.fromarray(image(shaded)).save(plain)
    arguments = ["shade", mesh, "-o", out, "--reference", str(plain), "--json"]
    assert main([*arguments, *FAST]) == 0
    # Nobody knows what drew it, so it need not be the same in every bit.
    assert json.loads(capsys.readouterr().out)["reference"]["threshold"] == 5.0
    assert main([*arguments, *FAST[:2], "--size", "100x90"]) == 6
    assert json.loads(capsys.readouterr().out)["reference"]["difference"] is None


@pytest.mark.parametrize(
    ("reference", "output", "code"),
    [("none.png", "n.png", 3), ("m.ply", "n.png", 3), ("p.png", "p.png", 2), ("p.png", "n.vtp", 2)],
)
def test_a_reference_that_cannot_be_is_refused_before_the_work(reference, output, code, shaded):
    folder = shaded.parent
    before = sorted(folder.iterdir())
    arguments = ["shade", str(folder / "m.ply"), "-o", str(folder / output), *FAST]
    assert main([*arguments, "--reference", str(folder / reference)]) == code
    assert sorted(folder.iterdir()) == before


def test_the_threshold_bounds_a_local_mean():
    one = np.full((60, 60, 3), 128, dtype=np.uint8)
    other = one.copy()
    other[20:40, 20:40] = 131
    found = likeness(one, other, None)
    assert not found.alike
    assert found.pixels == 400
    # A patch larger than the window: its mean is the patch's own difference, alike everywhere.
    assert found.local == pytest.approx(found.largest)
    assert likeness(one, other, found.local + 1e-9).alike == (found.ssim >= LEAST_SSIM)
    assert not likeness(one, other, 0.99 * found.local).alike


def test_pictures_of_different_sizes_are_never_alike(tmp_path):
    one, other = (np.zeros((side, 40, 3), dtype=np.uint8) for side in (40, 41))
    found = likeness(one, other, 100.0)
    assert not found.alike
    assert "40 x 40 pixels were expected, not 40 x 41" in found.sentence
    with pytest.raises(ValueError, match="different sizes"):
        write_difference(tmp_path / "d.png", one, other, found)
