"""A session as a command line and as a script: both are run, and draw the same bytes."""

import runpy
import shlex
import shutil
from pathlib import Path

import pytest

from app import session as state
from app.cli.main import main
from app.command_line import command_line, command_of_file
from app.samples import sample
from app.scripting import script
from app.session import (
    Camera,
    Cone,
    Directional,
    Method,
    Point,
    Repair,
    Session,
    Substance,
    Volume,
)

SMALL = {"mesh": "sample:sphere", "size": (160, 120)}
LIGHTS = (
    Directional((-0.1, 0.2, 1.0), (1.0, 0.7, 0.1), "camera"),
    Directional((-1.0, 1e-7, 0.0)),
    Point((-30.0, 10.0, 20.0), (500.0, 400.0, 300.0)),
    Cone((0.0, 0.0, 40.0), (0.0, 0.1, -1.0), (900.0, 900.0, 900.0), 20.0),
)
CAMERA = Camera((-10.0, 1 / 3, 90.0), (0.0, 0.1, 0.0), (0.0, 1.0, 0.0), 28.5)
SAID = {
    "shade": Session(
        **SMALL,
        lights=LIGHTS,
        camera=CAMERA,
        material="marble",
        model=Method("wrap", {"width": 0.35}),
        estimator=Method("ball-jet", {"degree": 2.0}),
        scale=2.5,
        mm_per_unit=0.7,
        background="white",
        exposure=1.25,
        albedo=False,
    ),
    "curvature": Session(
        **SMALL,
        view="curvature",
        quantity="mean",
        range=(-0.2, 0.15),
        colormap="cividis",
        flip=True,
        strokes=True,
        flat=True,
        camera="oblique",
        repairs=(Repair("merge"),),
        percentiles=(1.0, 99.0),
    ),
    "figure": Session(**SMALL, view="figure", symmetric=True, fade=True, shadows="on"),
    "compare": Session(
        **SMALL,
        view="compare",
        compared=(Method("lambert"), Method("wrap")),
        difference=True,
        profile=Method("burley2015", {"source": "searchlight"}),
    ),
    "estimators": Session(
        mesh="sample:torus",
        size=(300, 120),
        view="compare",
        compared=(Method("auto"), Method("rusinkiewicz2004")),
        compared_by="estimator",
        wipe=0.25,
    ),
}
SKIN = Substance("mine", (1.0, 1.1, 1.2), (0.01, 0.02, 0.03), 1.4)
NOT_SAID = {
    "parallel": Session(**SMALL, camera=Camera((0, 0, 90), (0, 0, 0), height=40.0)),
    "substance": Session(**SMALL, material=SKIN),
    "parameters": Session(
        **SMALL,
        view="compare",
        compared=(Method("wrap", {"width": 0.4}), Method("lambert")),
    ),
    "of another view": Session(**SMALL, wipe=0.5),
    "dark": Session(**SMALL, lights=(), exposure=1.0),
}


def _run(words: str) -> bytes:
    assert main([*shlex.split(words)[1:], "--quiet"]) == 0
    return Path("picture.png").read_bytes()


def _from_file(session: Session) -> bytes:
    state.write(session, Path("it's saved.json").resolve())
    return _run(command_of_file(session, Path("it's saved.json")))


def _scripted(session: Session) -> bytes:
    Path("drawing.py").write_text(script(session))
    Path("picture.png").unlink()
    runpy.run_path("drawing.py")
    return Path("picture.png").read_bytes()


@pytest.mark.parametrize("name", SAID)
def test_flags_file_and_script_draw_the_same(name, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    session = SAID[name]
    words = command_line(session)
    assert words is not None
    assert "--session" not in words
    drawn = _run(words)
    assert drawn == _from_file(session)
    assert drawn == _scripted(session)


@pytest.mark.parametrize("name", NOT_SAID)
def test_what_flags_cannot_say_is_left_to_a_file(name, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    session = NOT_SAID[name]
    assert command_line(session) is None
    assert _from_file(session) == _scripted(session)


def test_every_field_of_a_session_is_said_or_left_to_a_file() -> None:
    for session in (*SAID.values(), Session(), Session(volume=Volume(12.5, 1.0))):
        assert command_line(session) is not None


def test_a_mesh_is_found_from_every_folder(tmp_path, monkeypatch) -> None:
    folder = tmp_path / "with space"
    folder.mkdir()
    shutil.copy(sample("sphere").path, folder / "$mesh.ply")
    monkeypatch.chdir(folder)
    session = Session(mesh="$mesh.ply", size=(160, 120))
    words, code = command_line(session), script(session)
    monkeypatch.chdir(tmp_path)
    drawn = _run(words)
    Path("picture.png").unlink()
    Path("drawing.py").write_text(code)
    runpy.run_path("drawing.py")
    assert Path("picture.png").read_bytes() == drawn
