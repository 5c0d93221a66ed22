import json

import numpy as np
import pytest
import pyvista
from msgspec.structs import replace

from app import costs as costs_file
from app.animation import stage
from app.animation_motion import Motion
from app.camera import axes, camera_of
from app.cli.main import main
from app.picture import compose
from app.pipeline import Pipeline
from app.probing import probe, with_readings
from app.session import Directional, Method, Session, Settled, from_json, read, to_json
from app.settling import model_of, recorded, settled
from lutcore.blend import Blend
from lutcore.costs import COLORS, PREDICTION, Cost, candidates, forget, remember
from lutcore.errors import ParameterError
from lutcore.lights import DirectionalLight
from lutcore.shading import model_registry

AXES = np.eye(3)


@pytest.fixture(autouse=True)
def costs(tmp_path, monkeypatch):
    """Let no test measure: costs in the order of the models' names."""
    monkeypatch.setattr(costs_file, "place", lambda: tmp_path / "costs.json")
    forget()
    remember({PREDICTION: Cost(5.0, "n"), COLORS: Cost(5.0, "n")})
    for number, one in enumerate(candidates()):
        slow = 1.0 if one.model.local else 100.0
        remember({one.label: Cost(slow * (10.0 + number), one.model.growth)})
    yield
    forget()


def model(name, **parameters):
    return model_registry.get(name)(**parameters)


def test_a_model_is_named_with_what_is_not_at_its_default():
    assert settled(model("lambert")).as_json() == {
        "model": "lambert",
        "parameters": {},
        "blended_with": None,
    }
    found = settled(model("wrap", width=0.5))
    assert found.method == Method("wrap", {"width": 0.5})
    assert found.label == "wrap (width 0.5)"


def test_a_blend_names_both():
    found = settled(Blend(model("lambert"), model("curvature-lut"), 0.02))
    assert found.label == "curvature-lut, lambert where it suffices"
    assert found.as_json()["blended_with"] == "lambert"


def test_what_is_not_registered_has_no_name():
    with pytest.raises(ParameterError, match="no shading model is registered as"):
        model_registry.name_of(Blend)


def test_what_is_named_is_made_again():
    blend = Blend(model("lambert", fresnel="directional"), model("curvature-lut", samples=16), 0.02)
    colors = Blend(model("wrap"), model("curvature-lut"), 2.5, 1.0 / 3.0)
    for one in (blend, colors, model("wrap", width=0.5)):
        assert model_of(settled(one)) == one
    with pytest.raises(ValueError, match="together"):
        Settled(Method("lambert"), Method("wrap"))
    with pytest.raises(ValueError, match="with a cheaper model"):
        Settled(Method("lambert"), exposure=1.0)


def another_machine():
    """Let costs be in the opposite order."""
    costs_file.place().unlink()
    for number, one in enumerate(reversed(candidates())):
        slow = 1.0 if one.model.local else 100.0
        remember({one.label: Cost(slow * (10.0 + number), one.model.growth)})


def test_a_session_keeps_what_auto_came_to_in_its_scene():
    session = Session(mesh="sample:torus", mm_per_unit=1000.0, model=Method("auto"))
    here = Pipeline()
    first = here.settled(session, session.model, AXES)
    kept = from_json(to_json(recorded(session, here, AXES)))
    assert [model_of(one) for one in kept.settled] == [first]
    light = here.exitance(session, session.model, AXES)
    another_machine()
    there = Pipeline()
    other = there.settled(session, session.model, AXES)
    assert other != first
    assert there.settled(kept, kept.model, AXES) == first
    # One pipeline does not mix the two up.
    assert not np.array_equal(there.exitance(session, session.model, AXES), light)
    assert np.array_equal(there.exitance(kept, kept.model, AXES), light)
    # The camera's last bits are those of a machine, too.
    assert there.settled(kept, kept.model, AXES + 1e-9) == first
    # Another scene is another choice: lights, material, size, tolerance.
    changes = [
        {"lights": (Directional((0.0, 0.0, 1.0)),)},
        {"material": "marble"},
        {"mm_per_unit": 1001.0},
        {"model": Method("auto", {"tolerance": 0.03})},
    ]
    for change in changes:
        changed = replace(kept, **change)
        assert settled(there.settled(changed, changed.model, AXES)) == settled(
            Pipeline().settled(replace(changed, settled=()), changed.model, AXES)
        )
    assert recorded(changed, there, AXES).settled[0].scene != kept.settled[0].scene
    assert recorded(replace(kept, model=Method("wrap")), there, AXES).settled == ()


@pytest.mark.parametrize(
    ("metric", "value", "mm"),
    [("relative", 0.03, 3.0), ("mean-de2000", 0.2, 10.0), ("p99-de2000", 2.0, 10.0)],
)
def test_a_blend_is_drawn_again_to_the_last_bit(metric, value, mm):
    auto = Method("auto", {"tolerance": value, "metric": metric})
    session = Session(mesh="sample:torus", mm_per_unit=mm, model=auto, shadows="off")
    for one in candidates():
        cheap = one.label == "lambert (fresnel directional)"
        dear = 1e4 if one.label == "curvature-lut" else 1e6
        remember({one.label: Cost(1.0 if cheap else dear, one.model.growth)})
    here = Pipeline()
    kept = from_json(to_json(recorded(session, here, AXES)))
    (said,) = kept.settled
    assert said.cheaper is not None
    assert (said.exposure is None) == (metric == "relative")
    light = here.exitance(session, session.model, AXES)
    another_machine()
    there = Pipeline()
    np.testing.assert_array_equal(there.exitance(kept, kept.model, AXES), light)
    # The probe shows what the picture does.
    camera = camera_of(kept.camera, there.subject(kept), 1.0)
    light = there.exitance(kept, kept.model, axes(camera))
    reading = with_readings(probe(kept, there, 5), kept, there, camera, 1.0).readings[0]
    np.testing.assert_allclose(reading.exitance, light[5], rtol=1e-12)


def test_shadows_make_another_scene():
    session = Session(mesh="sample:torus", mm_per_unit=3.0, model=Method("auto"))
    pipeline = Pipeline()
    found = {
        shadows: recorded(replace(session, shadows=shadows), pipeline, AXES).settled[0].scene
        for shadows in ("off", "on", "auto")
    }
    # A film takes auto for on, and finds what was said of it.
    assert found["off"] != found["on"] == found["auto"]


@pytest.mark.parametrize("mesh", ["torus", "sphere"])
def test_auto_casts_the_shadows_that_change_its_scene(mesh):
    # Under a low light the ring shadows its far inner side; a ball shadows nothing.
    lights = (Directional((0.3, 0.9, 0.2)), Directional((1.0, 0.0, 0.0)))
    auto = Method("auto", {"check": "none", "tolerance": 1.0})
    session = Session(mesh=f"sample:{mesh}", lights=lights, model=auto)
    pipeline = Pipeline()
    found, off, cast = (
        pipeline.exitance(replace(session, shadows=shadows), auto, AXES)
        for shadows in (None, "off", "on")
    )
    np.testing.assert_array_equal(found, cast if mesh == "torus" else off)
    assert (off.mean() > 1.01 * cast.mean()) == (mesh == "torus")
    # PyVista's accessor does the same.
    body, size = pipeline.subject(session).mesh, pipeline.mm_per_unit(session)
    surface = pyvista.PolyData.from_regular_faces(body.vertices, body.faces)
    given = [DirectionalLight(light.direction) for light in lights]
    shaded = surface.curvelight.shade("skin1", given, "auto", size, exposure=1.0, **auto.parameters)
    np.testing.assert_array_equal(shaded["shading"], found.astype(np.float32))


def test_a_film_is_shaded_with_what_its_session_says():
    auto = Method("auto", {"check": "none"})
    session = Session(
        mesh="sample:torus",
        mm_per_unit=1000.0,
        model=auto,
        lights=(Directional((0.3, 0.9, 0.2), frame="world"),),
    )
    kept = recorded(session, Pipeline(), AXES)
    another_machine()
    motion = Motion("turntable", 0.5, 4.0)
    staged = stage(kept, Pipeline(), motion).session
    assert (staged.model, staged.shadows) == (kept.settled[0].method, "on")
    assert stage(session, Pipeline(), motion).session.model != kept.settled[0].method


def test_pictures_and_session_files_carry_it_to_another_machine(tmp_path, capsys):
    picture, saved = tmp_path / "p.png", tmp_path / "s.json"
    arguments = ["shade", "sample:torus", "-o", str(picture), "--mm-per-unit", "1000"]
    arguments += ["--model", "auto", "--size", "160x120", "--save-session", str(saved)]
    assert main([*arguments, "--quiet"]) == 0
    (kept,) = read(saved).settled
    another_machine()
    assert main(["verify", str(picture), "--json"]) == 0
    assert "bit for bit" in json.loads(capsys.readouterr().out)["findings"][0]
    for source in (saved, picture):
        again = tmp_path / "again.npz"
        assert main(["shade", "--session", str(source), "-o", str(again), "--json"]) == 0
        assert json.loads(capsys.readouterr().out)["settled"] == kept.as_json()
    assert main([*arguments[:-2], "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["settled"] != kept.as_json()


def test_a_record_of_a_model_that_does_not_exist_is_told(tmp_path, capsys):
    saved, out = tmp_path / "s.json", str(tmp_path / "o.npz")
    arguments = ["shade", "sample:torus", "--mm-per-unit", "1000", "--model", "auto", "-o", out]
    assert main([*arguments, "--save-session", str(saved), "--quiet"]) == 0
    (kept,) = read(saved).settled
    saved.write_text(saved.read_text().replace(f'"name": "{kept.method.name}"', '"name": "lamb"'))
    assert main(["shade", "--session", str(saved), "-o", out, "--quiet"]) == 2
    assert "lamb" in capsys.readouterr().err


def test_auto_is_settled_by_the_scene_and_others_are_themselves():
    pipeline = Pipeline()
    session = Session(mesh="sample:torus", mm_per_unit=1000.0)
    auto = Method("auto")
    chosen = pipeline.settled(session, auto, AXES)
    # Metres of skin: light goes nowhere, and a local model is enough.
    name = settled(chosen).method.name
    assert name != "auto"
    assert chosen.local
    assert pipeline.settled(session, auto, AXES) is chosen
    exitance = pipeline.exitance(session, auto, AXES)
    if not isinstance(chosen, Blend):
        again = pipeline.exitance(session, settled(chosen).method, AXES)
        assert np.array_equal(exitance, again)
    wrap = Method("wrap", {"width": 0.5})
    assert settled(pipeline.settled(session, wrap, AXES)).method == wrap


def test_shade_says_which_model_auto_took(tmp_path, capsys):
    arguments = ["shade", "sample:torus", "-o", str(tmp_path / "o.npz"), "--mm-per-unit", "1000"]
    assert main([*arguments, "--model", "auto", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["model"] == "auto"
    name = result["settled"]["model"]
    assert name in model_registry.names()
    assert main([*arguments, "--model", "auto"]) == 0
    assert f"shaded with {name}" in capsys.readouterr().out
    assert main([*arguments, "--model", "lambert", "--json"]) == 0
    other = json.loads(capsys.readouterr().out)
    assert other["settled"]["model"] == "lambert" and not other["shadows"]


@pytest.mark.parametrize("shadows", [None, "off"])
def test_shade_says_whether_auto_cast_shadows(tmp_path, capsys, shadows):
    arguments = ["shade", "sample:torus", "-o", str(tmp_path / "o.npz"), "--model", "auto"]
    arguments += ["--light", "0.3,0.9,0.2", "--tolerance", "1", "--check", "none"]
    arguments += ["--shadows", shadows] if shadows else []
    assert main([*arguments, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["shadows"] == (shadows is None)
    assert main(arguments) == 0
    assert ("casting shadows" in capsys.readouterr().out) == (shadows is None)


def test_a_comparison_says_what_auto_came_to():
    compared = Method("lambert"), Method("auto", {"tolerance": 1.0, "check": "none"})
    session = Session(mesh="sample:sphere", view="compare", compared=compared)
    pipeline = Pipeline()
    first, second = (panel.content.caption for panel in compose(session, pipeline).panels)
    name = settled(pipeline.settled(session, compared[1], AXES)).label
    assert (first, second) == ("lambert", f"auto: {name}")
