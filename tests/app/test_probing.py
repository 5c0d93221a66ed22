"""What the probe says, against the picture and against what is known of the mesh."""

import numpy as np
import pytest

from app.camera import axes
from app.picture import compose
from app.pipeline import Pipeline
from app.probing import nearest_vertex, probe, with_readings
from app.session import Directional, Method, Session
from lutcore.shading import model_registry, shading_models


@pytest.mark.parametrize(
    "session",
    [
        Session(mesh="sample:sphere", mm_per_unit=0.2),
        Session(mesh="sample:torus", model=Method("wrap", {"width": 0.3}), scale=0.7),
        # Under a low light the ring shadows its far inner side: vertex 2722.
        Session(mesh="sample:torus", lights=(Directional((0.3, 0.9, 0.2)),), shadows="on"),
    ],
)
def test_the_color_of_the_sessions_model_is_that_of_the_picture(session: Session) -> None:
    pipeline = Pipeline()
    made = compose(session, pipeline)
    shown = made.panels[0].content.rgb
    for vertex in (0, 17, 2000, 2722):
        found = probe(session, pipeline, vertex)
        found = with_readings(found, session, pipeline, made.camera, made.exposure)
        assert found.readings[0].model == session.model.label
        np.testing.assert_array_equal(found.readings[0].color, shown[vertex])


def test_there_is_a_reading_of_each_local_model_and_its_error() -> None:
    session, pipeline = Session(mesh="sample:sphere"), Pipeline()
    made = compose(session, pipeline)
    found = probe(session, pipeline, 5)
    found = with_readings(found, session, pipeline, made.camera, made.exposure)
    local = {name for name in shading_models() if model_registry.get(name).local}
    assert {one.model for one in found.readings} == local
    errors = {one.model: one.error for one in found.readings}
    assert errors["lambert"] > errors["curvature-lut"] > 0.0
    row = found.row()
    assert row["vertex"] == 5
    assert str(row["lambert color"]).startswith("#")


def test_values_are_in_millimetres() -> None:
    session, pipeline = Session(mesh="sample:sphere", mm_per_unit=2.0), Pipeline()
    found = probe(session, pipeline, 100)
    # Radius 10 units of 2 mm.
    assert found.values["k1"] == pytest.approx(0.05, abs=3.0 * found.values["k1_error"])
    both = np.hypot(found.values["k1_error"], found.values["k2_error"]) / np.sqrt(2.0)
    assert found.values["error"] == pytest.approx(both)
    assert found.values["gauss"] == pytest.approx(0.05**2, rel=0.02)
    assert np.linalg.norm(found.position) == pytest.approx(10.0, rel=1e-3)


def test_the_vertex_is_that_under_the_line_of_sight() -> None:
    session, pipeline = Session(mesh="sample:torus"), Pipeline()
    camera = compose(session, pipeline).camera
    mesh = pipeline.subject(session).mesh
    back = axes(camera)[2]
    towards = np.argmax(mesh.vertices @ back)
    start = mesh.vertices[towards] + 100.0 * back
    assert nearest_vertex(session, pipeline, start, -back) == towards
    assert nearest_vertex(session, pipeline, start, back) is None
