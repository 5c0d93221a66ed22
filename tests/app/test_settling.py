import json

import numpy as np
import pytest

from app import costs as kept
from app.cli.main import main
from app.pipeline import Pipeline
from app.session import Method, Session
from app.settling import settled
from lutcore.blend import Blend
from lutcore.costs import PREDICTION, Cost, candidates, forget, remember
from lutcore.errors import ParameterError
from lutcore.shading import model_registry

AXES = np.eye(3)


@pytest.fixture(autouse=True)
def costs(tmp_path, monkeypatch):
    """Let no test measure: costs in the order of the models' names."""
    monkeypatch.setattr(kept, "place", lambda: tmp_path / "costs.json")
    forget()
    remember({PREDICTION: Cost(5.0, "n")})
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
    assert json.loads(capsys.readouterr().out)["settled"]["model"] == "lambert"
