import json
from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from app import portable as places
from app.backend import Backend
from app.picture import render
from app.pipeline import Pipeline
from app.portable import portable
from app.provenance import KEYWORD, PictureError, read_pixels, read_record, write_picture
from app.record import elsewhere, pixels_digest, record_of
from app.session import Method, Session

SESSION = Session(mesh="sample:torus", estimator=Method("rusinkiewicz2004"), size=(120, 90))


@pytest.fixture(scope="module")
def drawn():
    pipeline = Pipeline()
    made = render(SESSION, pipeline)
    return made, record_of(SESSION, pipeline, made)


@pytest.fixture
def picture(drawn, tmp_path):
    made, record = drawn
    write_picture(tmp_path / "p.png", made.image, record)
    return tmp_path / "p.png"


def rewritten(picture, change):
    """Write the picture again with its text changed."""
    image = Image.open(picture)
    info = PngInfo()
    info.add_itxt(KEYWORD, change(image.text[KEYWORD]))
    other = picture.with_name("other.png")
    image.save(other, pnginfo=info)
    return other


def test_what_is_written_is_read(drawn, picture):
    made, record = drawn
    stored = read_record(picture)
    assert not stored.edited
    assert stored.record == record
    np.testing.assert_array_equal(read_pixels(picture), made.image)
    assert record.pixels == pixels_digest(made.image)
    assert record.resolved.camera == made.camera
    assert record.resolved.exposure == made.exposure
    assert record.backend.renderer
    assert {"curvelight", "numpy", "vtk", "numba", "Python"} <= set(record.versions)


def test_the_same_picture_is_the_same_file(drawn, picture, tmp_path):
    made, record = drawn
    write_picture(tmp_path / "again.png", made.image, record)
    assert (tmp_path / "again.png").read_bytes() == picture.read_bytes()


def test_a_mesh_is_found_from_the_pictures_folder(drawn, tmp_path, monkeypatch):
    made, record = drawn
    (tmp_path / "scans").mkdir()
    (tmp_path / "pictures").mkdir()
    mesh = tmp_path / "scans" / "m.ply"
    path = tmp_path / "pictures" / "p.png"
    for named in (str(mesh), "scans/m.ply"):
        monkeypatch.chdir(tmp_path)
        session = replace(record.session, mesh=named)
        write_picture(path, made.image, replace(record, session=session))
        told = json.loads(Image.open(path).text[KEYWORD])["session"]["mesh"]
        assert told == "../scans/m.ply"
        assert Path(read_record(path).record.session.mesh).resolve() == mesh.resolve()


def test_a_path_through_a_home_folder_tells_no_users_name(tmp_path, monkeypatch):
    (tmp_path / "home" / "anna").mkdir(parents=True)
    monkeypatch.setattr(places.Path, "home", lambda: tmp_path / "home" / "anna")
    mesh = str(tmp_path / "home" / "anna" / "scans" / "m.ply")
    assert portable(mesh, tmp_path / "shared") == "m.ply"
    assert portable(mesh, tmp_path / "home" / "bert") == "m.ply"
    assert portable(mesh, tmp_path / "home" / "anna" / "out") == "../scans/m.ply"
    assert portable(str(tmp_path / "m.ply"), tmp_path / "shared") == "../m.ply"
    assert portable("sample:torus", tmp_path) == "sample:torus"


def test_a_file_name_that_is_no_text_can_be_written(drawn, tmp_path):
    made, record = drawn
    session = replace(record.session, mesh=str(tmp_path / "caf\udce9.ply"))
    write_picture(tmp_path / "p.png", made.image, replace(record, session=session))
    assert not read_record(tmp_path / "p.png").edited


def test_the_record_tells_no_user_and_no_host(drawn, tmp_path, monkeypatch):
    made, _ = drawn
    for name in ("USER", "LOGNAME", "HOSTNAME", "COMPUTERNAME"):
        monkeypatch.setenv(name, "zaphod")
    monkeypatch.setattr("platform.node", lambda: "zaphod")
    monkeypatch.setattr("socket.gethostname", lambda: "zaphod")
    write_picture(tmp_path / "p.png", made.image, record_of(SESSION, Pipeline(), made))
    info = Image.open(tmp_path / "p.png").info
    assert set(info) == {KEYWORD}  # no time either
    assert "zaphod" not in info[KEYWORD]


@pytest.mark.parametrize(
    ("change", "edited"),
    [
        (lambda text: text, False),
        (lambda text: json.dumps(json.loads(text), indent=3), False),
        (lambda text: text.replace('"skin1"', '"marble"'), True),
        (lambda text: text.replace('"exposure":null', '"exposure":2.5', 1), True),
        (lambda text: text.replace('"numpy":"', '"numpy":"9.'), True),
    ],
)
def test_what_was_edited_is_told_from_what_was_only_packed_otherwise(picture, change, edited):
    assert read_record(rewritten(picture, change)).edited is edited


def test_a_newer_format_names_the_version_to_install(drawn, tmp_path):
    made, record = drawn
    newer = replace(record, format=2, versions={"curvelight": "9.9"})
    write_picture(tmp_path / "p.png", made.image, newer)
    with pytest.raises(PictureError, match=r"made by Curvelight 9\.9, .* install that one"):
        read_record(tmp_path / "p.png")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda text: text[: len(text) // 2], "metadata is damaged"),
        (lambda text: "[]", "metadata is damaged"),
        (lambda text: "{}", "metadata is damaged"),
        (lambda text: text.replace('"view":"shade"', '"view":"paint"'), "edited and makes no"),
        (lambda text: "", "does not say how it was made"),
    ],
)
def test_a_broken_record_is_refused_in_words(picture, change, words):
    with pytest.raises(PictureError, match=words):
        read_record(rewritten(picture, change))


def test_a_file_that_is_no_whole_png_is_refused_in_words(picture, tmp_path):
    whole = picture.read_bytes()
    cases = {
        "cut.png": (whole[: len(whole) // 2], "damaged"),
        "text.png": (b"Dear all", "no PNG"),
        "empty.png": (b"", "no PNG"),
    }
    for name, (content, words) in cases.items():
        (tmp_path / name).write_bytes(content)
        with pytest.raises(PictureError, match=f"{name}: .*{words}"):
            read_record(tmp_path / name)
    with pytest.raises(PictureError, match="no such file"):
        read_pixels(tmp_path / "none.png")
    with pytest.raises(PictureError, match="a folder"):
        read_pixels(tmp_path)


def test_a_broken_picture_never_ends_in_another_error(picture, tmp_path):
    whole = bytearray(picture.read_bytes())
    random = np.random.default_rng(5)
    refused = 0
    for _ in range(60):
        broken = whole.copy()
        # Most of the record lies in the first bytes.
        for place in random.integers(0, 3000, 3):
            broken[place] = random.integers(256)
        path = tmp_path / "b.png"
        path.write_bytes(broken)
        try:
            read_record(path)
            read_pixels(path)
        except PictureError:
            refused += 1
    # Chunks have checksums: nearly every change is found.
    assert refused > 50


def test_only_driver_vtk_and_processor_excuse_other_bits(drawn):
    _, record = drawn
    assert elsewhere(record, replace(record, versions=record.versions | {"numpy": "9"})) == ""
    other = replace(record, backend=Backend("V", "Fast GPU", "4.6"))
    assert "Fast GPU" in elsewhere(other, record)
    assert "VTK 8" in elsewhere(replace(record, versions=record.versions | {"vtk": "8"}), record)
    assert "arm64" in elsewhere(replace(record, machine="Darwin arm64 apple-m1"), record)
