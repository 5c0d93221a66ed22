"""Which model is enough where, and where vertices lie in the table."""

import numpy as np
import pytest

from app.camera import axes
from app.picture import compose
from app.pipeline import Pipeline
from app.session import Directional, Session
from app.suffices import colored, sufficient
from app.tabulated import table_arguments, within
from lutcore.choice import choose
from lutcore.costs import COLORS, PREDICTION, Candidate, Cost
from lutcore.shading import model_registry
from lutcore.tolerance import Tolerance, relative


def _ladder(names):
    models = [Candidate(name, model_registry.get(name)()) for name in names]
    costs = {one.label: Cost(10.0 * (n + 1), "n") for n, one in enumerate(models)}
    return models, costs | {PREDICTION: Cost(1e9, "n"), COLORS: Cost(1e9, "n")}


def test_each_vertex_gets_the_cheapest_model_within_the_tolerance() -> None:
    from lutcore.prediction import Scene

    session, pipeline = Session(mesh="sample:torus", mm_per_unit=1.0), Pipeline()
    frame = axes(compose(session, pipeline).camera)
    inputs = pipeline.inputs(session, frame)
    models, costs = _ladder(["lambert", "kolchin2007", "curvature-lut"])
    limit = 0.05
    choice = choose(inputs, Tolerance(limit, "relative"), costs, models)
    found = sufficient(inputs, choice.rungs, limit)
    scene = Scene.of(inputs, inputs.curvatures)
    errors = {
        one.label: relative(one.model.predicted_error(scene), scene.irradiance) for one in models
    }
    assert set(found.labels) <= set(errors)
    for index, label in enumerate(found.labels):
        here = found.which == index
        assert here.any()
        assert (errors[label][here] <= limit).all()
        for cheaper in found.labels[:index]:
            assert (errors[cheaper][here] > limit).all()
    shares = [found.share(index) for index in (*range(len(found.labels)), -1)]
    assert sum(shares) == pytest.approx(1.0)
    assert (found.rgb[found.which == 0] == found.color(0)).all()


def test_other_colors_leave_the_geometry() -> None:
    made = compose(Session(mesh="sample:sphere", view="figure"), Pipeline())
    count = len(made.panels[0].content.mesh.vertices)
    other = colored(made, np.zeros((count, 3), np.uint8))
    assert len(other.panels) == len(made.panels)
    assert other.panels[0].content.mesh is made.panels[0].content.mesh
    assert other.panels[2] is made.panels[2]


def test_the_argument_of_psi_on_a_sphere() -> None:
    # Radius 10 mm, k = 0.1/mm, light along z: |S+ w_t| = k sin, N.w = cos.
    session = Session(mesh="sample:sphere", lights=(Directional((0.0, 0.0, 1.0)),))
    pipeline = Pipeline()
    inputs = pipeline.inputs(session, np.eye(3))
    found = table_arguments(inputs, 0)
    z = pipeline.subject(session).mesh.vertices[:, 2] / 10.0
    some = np.abs(z) < 0.9
    truth = np.abs(z) / (0.1 * np.sqrt(1.0 - z**2))
    for channel, length in enumerate(inputs.table.mean_free_path):
        # The measured curvature of the sphere is off by a percent.
        np.testing.assert_allclose(found[channel][some] * length, truth[some], rtol=0.03, atol=0.02)
    assert within(found, 0, 0.0, np.inf).all()
    assert not within(found, 0, -2.0, -1.0).any()
