"""The command that chooses a model, the costs it keeps, and ``--model auto``."""

import json
from pathlib import Path

import numpy as np
import pytest

from app import costs as kept
from app.choosing import needs
from app.cli import choose_said as said
from app.cli.main import main
from app.pipeline import Pipeline
from app.session import Directional, Method, Session
from lutcore import analytic
from lutcore.costs import COLORS, PREDICTION, Cost, candidates, forget, remember
from lutcore.tolerance import Tolerance
from tests.mesh_files import ply

AXES = np.eye(3)


@pytest.fixture(autouse=True)
def known(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Let no test measure: costs in the order of the models' names."""
    place = tmp_path / "costs.json"
    monkeypatch.setattr(kept, "place", lambda: place)
    forget()
    remember({PREDICTION: Cost(5.0, "n"), COLORS: Cost(5.0, "n")})
    for number, one in enumerate(candidates()):
        slow = 1.0 if one.model.local else 100.0
        remember({one.label: Cost(slow * (10.0 + number), one.model.growth)})
    return place


@pytest.fixture
def lump(tmp_path: Path) -> str:
    """A body that no sphere and no quadric comes near to."""
    path = tmp_path / "lump.ply"
    body = analytic.ellipsoid(3000, axes=(20.0, 10.0, 5.0))
    path.write_bytes(ply(body.mesh.vertices, body.mesh.faces))
    return str(path)


@pytest.fixture
def ball(tmp_path: Path) -> str:
    path = tmp_path / "ball.ply"
    body = analytic.sphere(3000, radius=10.0)
    path.write_bytes(ply(body.mesh.vertices, body.mesh.faces))
    return str(path)


def test_prints_one_object(ball: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["choose", ball, "--mm-per-unit", "100", "--light", "1,0,1", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert {rung["model"] for rung in found["ladder"]} >= {"lambert", "jensen2002", "wrap"}
    assert found["choice"]["adequate"]
    assert found["choice"]["local"]
    assert found["choice"]["reason"]
    assert found["table_samples"] in (8, 16, 32, 64, 128)
    assert not found["shadows"]["needed"]  # a ball is convex
    assert not found["check"]["shadows"]
    unknown = [rung for rung in found["ladder"] if rung["model"] == "curvature-lut-physical"]
    assert all(rung["score"] is None and not rung["adequate"] for rung in unknown)


def test_says_plainly_when_no_local_model_is_enough(
    lump: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["choose", lump, "--mm-per-unit", "0.3", "--light", "1,0,1"]) == 0
    text = capsys.readouterr().out
    assert "no local model suffices" in text
    assert "jensen2002 suffices" in text
    assert "random walk" in text
    assert "curvature-lut-physical is never chosen" in text


def test_the_check_overrules_the_prediction(ball: str, capsys: pytest.CaptureFixture[str]) -> None:
    # On a sphere the sphere's table is exact, which no prediction dares to say.
    asked = ["choose", ball, "--mm-per-unit", "0.3", "--light", "1,0,1"]
    assert main([*asked, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    choice, check = found["choice"], found["check"]
    assert choice["overruled"]
    assert choice["by_prediction"] == "jensen2002"
    assert choice["model"] == "sphere-table"
    assert "the check overruled the prediction" in choice["reason"]
    rung = next(one for one in found["ladder"] if one["model"] == choice["model"])
    assert not rung["predicted_adequate"]
    assert rung["checked"]["high"] <= found["tolerance"] < rung["score"]
    assert check["share_of_vertices"] == 1.0
    assert check["milliseconds"] > 0.0
    assert main(asked) == 0
    assert "that took" in capsys.readouterr().out
    assert main([*asked, "--predicted-only", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["choice"]["model"] == "jensen2002"
    assert not found["choice"]["overruled"]
    assert found["check"]["none_because"] == "no check was asked for"
    assert all(one["checked"] is None for one in found["ladder"])


def test_shadows_that_the_scene_casts_are_in_the_check(capsys: pytest.CaptureFixture[str]) -> None:
    asked = ["choose", "sample:torus", "--mm-per-unit", "3", "--light", "0.9,0.2,0.35"]
    loose = [*asked, "--tolerance", "0.2"]
    for shadows in ("off", "on", "auto", None):
        said = ["--shadows", shadows] if shadows else []
        assert main([*loose, *said, "--json"]) == 0
        found = json.loads(capsys.readouterr().out)
        assert found["shadows"]["needed"]
        assert found["check"]["shadows"] == (shadows != "off")
        without = found["shadows"]["without"]
        assert (without is None) == (shadows == "off")
        assert without is None or without["score"] > found["tolerance"]
    assert main([*loose, "--shadows", "on"]) == 0
    text = capsys.readouterr().out
    assert "with cast shadows on both sides" in text
    assert "without them what is chosen would be off by" in text
    assert "too much" in text
    assert main([*asked, "--shadows", "on", "--predicted-only"]) == 0
    assert "the prediction decides" in capsys.readouterr().out


def test_shadows_that_are_needed_and_left_out_are_offered(
    capsys: pytest.CaptureFixture[str],
) -> None:
    asked = ["choose", "sample:torus", "--light", "0.9,0.2,0.35", "--predicted-only"]
    for shadows in ("off", "on", None):
        said = ["--shadows", shadows] if shadows else []
        assert main([*asked, *said]) == 0
        offered = "--shadows auto makes it with them" in capsys.readouterr().out
        assert offered == (shadows == "off")


def test_warns_of_what_other_commands_warn_of(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = ["choose", "sample:sphere", "--mm-per-unit", "20", "--predicted-only"]
    assert main([*asked, "--material", "spectralon", "--light", "0,0,1"]) == 0
    printed = capsys.readouterr()
    assert "its glow has no end" in printed.err
    assert ", 1 light, " in printed.out
    path = tmp_path / "flipped.ply"
    body = analytic.sphere(500, radius=10.0)
    faces = body.mesh.faces.copy()
    faces[:20] = faces[:20, ::-1]
    path.write_bytes(ply(body.mesh.vertices, faces))
    asked = ["choose", str(path), "--predicted-only"]
    assert main(asked) == 0
    assert "--repair orient" in capsys.readouterr().err
    # And it does what it advises.
    assert main([*asked, "--repair", "orient"]) == 0
    assert "--repair orient" not in capsys.readouterr().err


@pytest.mark.parametrize(
    ("milliseconds", "text"),
    [(0.1637, "0.164 ms"), (999.9, "1 s"), (36700.0, "36.7 s"), (51585850.0, "51,586 s")],
)
def test_times_are_written_as_people_read_them(milliseconds: float, text: str) -> None:
    assert said.spent(milliseconds) == text


def test_metric_and_tolerance_are_checked(ball: str) -> None:
    assert main(["choose", ball, "--metric", "best"]) == 2
    assert main(["choose", ball, "--tolerance", "-1"]) == 2


def test_costs_are_kept_for_this_machine_only(known: Path) -> None:
    first = kept.measured()
    assert json.loads(known.read_bytes())["machine"] == kept.machine()
    content = json.loads(known.read_bytes())
    label = next(iter(content["costs"]))
    content["costs"][label][0] = 12345.0
    known.write_text(json.dumps(content))
    assert kept.measured()[label].nanoseconds == 12345.0
    # Another machine's are not taken.
    content["machine"]["processor"] = "another"
    known.write_text(json.dumps(content))
    remember(first)
    assert kept.measured()[label] == first[label]


def test_a_broken_file_is_measured_again(known: Path) -> None:
    known.write_text("{")
    assert kept.measured()
    json.loads(known.read_bytes())


def test_auto_is_the_model_that_is_chosen(ball: str, lump: str) -> None:
    session = Session(mesh=ball, mm_per_unit=100.0)
    pipeline = Pipeline()
    auto = pipeline.exitance(session, Method("auto", {"tolerance": 0.5}), AXES)
    cheapest = pipeline.exitance(session, Method(candidates()[0].name), AXES)
    np.testing.assert_array_equal(auto, cheapest)
    small = Session(mesh=lump, mm_per_unit=0.3)
    gathered = pipeline.exitance(small, Method("jensen2002"), AXES)
    np.testing.assert_array_equal(pipeline.exitance(small, Method("auto"), AXES), gathered)


def test_auto_takes_the_choice_with_its_table(ball: str) -> None:
    from app.settling import settled

    session = Session(mesh=ball, mm_per_unit=0.3)
    pipeline = Pipeline()
    chosen = pipeline.settled(session, Method("auto", {"tolerance": 0.02}), AXES)
    assert settled(chosen).method.name == "sphere-table"
    alone = pipeline.settled(session, Method("auto", {"check": "none"}), AXES)
    assert settled(alone).method.name == "jensen2002"
    coarse = Method("auto", {"tolerance": 0.05})
    large = Session(mesh=ball, mm_per_unit=3.0, lights=(Directional((1.0, 0.0, 0.3)),))
    for one in candidates():
        if one.name != "curvature-lut" and one.model.local:
            remember({one.label: Cost(1e4, "n")})
    method = settled(pipeline.settled(large, coarse, AXES)).method
    assert method.name == "curvature-lut"
    assert method.parameters["samples"] == 8.0
    found = needs(large, pipeline, AXES, Tolerance(0.05))
    assert settled(found.choice.model).method == method
