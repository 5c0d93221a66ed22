import numpy as np
import pytest
from msgspec.structs import replace

from app.contestants import alone
from app.lighting import world_lights
from app.pipeline import Pipeline
from app.session import CHOSEN, Directional, Method, Session
from lutcore.shading import AUTO

AXES = np.eye(3)
LOCAL, REFERENCE = Method("lambert"), Method("jensen2002")
# Under a low light the ring shadows its far inner side.
TORUS = Session(mesh="sample:torus", lights=(Directional((0.3, 0.9, 0.2)), Directional((1, 0, 0))))
SPHERE = replace(TORUS, mesh="sample:sphere")


@pytest.fixture(scope="module")
def pipeline():
    return Pipeline()


@pytest.mark.parametrize("model", [LOCAL, REFERENCE])
def test_shadows_darken_and_are_off_unless_asked_for(pipeline, model):
    assert Session().casts == "off"
    without = pipeline.exitance(TORUS, model, AXES)
    cast = pipeline.exitance(replace(TORUS, shadows="on"), model, AXES)
    assert cast.mean() < 0.99 * without.mean()
    # What gathers is off by half a percent; what is local is multiplied by shares.
    assert (cast <= without + 0.005 * without.max()).all()
    np.testing.assert_array_equal(
        pipeline.exitance(replace(TORUS, shadows="auto"), model, AXES), cast
    )


@pytest.mark.parametrize("model", [LOCAL, REFERENCE])
def test_a_convex_body_needs_none(pipeline, model):
    without = pipeline.exitance(SPHERE, model, AXES)
    chosen = pipeline.exitance(replace(SPHERE, shadows="auto"), model, AXES)
    np.testing.assert_array_equal(chosen, without)


def test_they_are_left_to_the_scene_where_the_model_is():
    auto = Method("auto")
    assert replace(TORUS, model=auto).casts == "auto"
    for said in ("off", "on", "auto"):
        assert replace(TORUS, model=auto, shadows=said).casts == said
        assert replace(TORUS, model=LOCAL, shadows=said).casts == said
    # All that is compared is lit by the same, and so is each of it alone.
    models = replace(TORUS, view="compare", compared=(LOCAL, auto))
    assert models.casts == "auto"
    assert {one.casts for one in alone(models)} == {"auto"}
    assert replace(models, compared=(LOCAL, REFERENCE)).casts == "off"
    # An estimator of that name is no model, nor is a model that is not shown.
    estimators = replace(models, compared=(auto, Method("ball-jet")), compared_by="estimator")
    assert estimators.casts == "off"
    assert replace(models, compared=(LOCAL, REFERENCE), model=auto).casts == "off"


def test_the_name_is_that_of_the_model():
    assert CHOSEN == AUTO


def test_what_shadows_change_is_looked_for_once_in_a_scene(monkeypatch):
    from lutcore import visibility

    asked = []
    real = visibility.forecast
    monkeypatch.setattr(visibility, "forecast", lambda *given: asked.append(given) or real(*given))
    pipeline, session = Pipeline(), replace(TORUS, shadows="auto")
    for model in (LOCAL, Method("wrap")):
        pipeline.exitance(session, model, AXES)
    lights = world_lights(session, AXES)
    assert pipeline.casting(session, lights) and len(asked) == 1
    # It depends on the lights, and on what the normals do.
    assert pipeline.casting(session, lights[:1])
    pipeline.casting(replace(session, mm_per_unit=2.0), lights)
    assert len(asked) == 3
