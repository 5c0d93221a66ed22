import numpy as np
import pytest
from msgspec.structs import replace

from app.pipeline import Pipeline
from app.session import Directional, Method, Session

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
    assert Session().shadows == "off"
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
