import numpy as np
import pytest

from app.lighting import world_lights
from app.pipeline import Pipeline
from app.session import Cone, Directional, Method, Point, Session, Substance
from lutcore.errors import MeshError, ParameterError

TORUS = Session(mesh="sample:torus", estimator=Method("rusinkiewicz2004"))
AXES = np.eye(3)


def test_each_step_is_computed_once():
    steps = []
    pipeline = Pipeline(lambda share, step: steps.append(step) is None)
    first = pipeline.curvatures(TORUS)
    count = len(steps)
    assert count > 0
    assert pipeline.curvatures(TORUS) is first
    assert pipeline.exitance(TORUS, TORUS.model, AXES) is pipeline.exitance(
        TORUS, TORUS.model, AXES
    )
    assert len(steps) == count


def changed(**fields):
    from msgspec.structs import replace

    return replace(TORUS, **fields)


def test_a_picture_needs_no_curvature_at_one_scale_where_each_channel_has_its_own(monkeypatch):
    session = changed(estimator=Method("auto"))
    whole = Pipeline()
    bent = whole.inputs(session, AXES)
    expected = whole.facing(session)
    np.testing.assert_array_equal(expected, whole.curvatures(session).normals)
    pipeline = Pipeline()
    monkeypatch.setattr(pipeline, "curvatures", None)
    np.testing.assert_array_equal(pipeline.facing(session), expected)
    np.testing.assert_array_equal(pipeline.inputs(session, AXES, False).normals, bent.normals)
    light = pipeline.exitance(session, session.model, AXES)
    np.testing.assert_array_equal(light, whole.exitance(session, session.model, AXES))


def test_normals_at_a_scale_that_is_given_are_those_of_the_curvature():
    pipeline = Pipeline()
    for session in (TORUS, changed(estimator=Method("auto"), scale=1.0)):
        assert pipeline.facing(session) is pipeline.curvatures(session).normals


@pytest.mark.parametrize(
    "session",
    [
        changed(material="marble"),
        changed(mm_per_unit=3.0),
        changed(lights=(Directional((0.0, 0.0, 1.0)),)),
        changed(estimator=Method("co-smoothing"), scale=1.0),
        changed(model=Method("lambert")),
        changed(profile=Method("burley2015")),
        changed(profile=Method("donner-jensen2005", {"thickness": 3.0})),
        changed(model=Method("curvature-lut", {"hinges": 8})),
    ],
)
def test_whatever_changes_the_light_is_computed_anew(session):
    pipeline = Pipeline()
    before = pipeline.exitance(TORUS, TORUS.model, AXES)
    assert not np.array_equal(pipeline.exitance(session, session.model, AXES), before)


def test_lights_of_the_camera_are_computed_anew_for_another_view():
    pipeline = Pipeline()
    before = pipeline.exitance(TORUS, TORUS.model, AXES)
    turned = AXES[[2, 0, 1]]
    assert not np.array_equal(pipeline.exitance(TORUS, TORUS.model, turned), before)


def test_a_changed_file_is_read_anew(tmp_path):
    path = tmp_path / "m.off"
    path.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    pipeline, session = Pipeline(), changed(mesh=str(path))
    assert len(pipeline.subject(session).mesh.vertices) == 3
    path.write_text("OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2\n")
    assert len(pipeline.subject(session).mesh.vertices) == 4


def test_a_picture_sees_a_file_as_it_was_when_it_began(tmp_path):
    path = tmp_path / "m.off"
    path.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    pipeline, session = Pipeline(), Session(mesh=str(path))
    with pipeline.still():
        first = pipeline.subject(session)
        path.write_text("OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n")
        with pipeline.still():
            assert pipeline.subject(session) is first
        assert pipeline.subject(session) is first
    assert len(pipeline.subject(session).mesh.vertices) == 4


def test_automatic_scale_of_shading_is_no_finer_than_the_glow_and_the_spacing():
    pipeline = Pipeline()
    fine = changed(estimator=Method("auto"), material="marble", mm_per_unit=10.0)
    wide = changed(estimator=Method("auto"), material="marble", mm_per_unit=0.52)
    huge = changed(estimator=Method("auto"), material="marble", mm_per_unit=0.001)
    assert pipeline.glow(huge) == pytest.approx(1e4 * pipeline.glow(fine))
    assert pipeline.scale(wide) == pipeline.glow(wide)
    # No more than a twentieth of the diagonal, though light reaches farther.
    assert pipeline.scale(huge) == pytest.approx(0.05 * np.sqrt(2 * 27.0**2 + 7.0**2), rel=1e-3)
    # The torus has 4 000 vertices on 4 pi^2 10 3.5 = 1 382 mm^2.
    assert pipeline.scale(fine) == pytest.approx(3.0 * np.sqrt(1382.0 / 4000.0), rel=0.05)
    assert pipeline.scale(changed(estimator=Method("auto"), view="curvature")) is None
    assert pipeline.scale(changed(scale=2.0)) == 2.0


def test_the_glow_is_that_of_the_profile():
    pipeline = Pipeline()
    thin = changed(material="marble", profile=Method("donner-jensen2005", {"thickness": 3.0}))
    assert pipeline.glow(thin) < pipeline.glow(changed(material="marble"))
    with pytest.raises(ParameterError, match="jensen2001"):
        pipeline.glow(changed(profile=Method("jensen2002")))


def test_a_material_may_be_given_by_its_coefficients():
    wax = Substance("wax", (1.0, 1.0, 1.0), (0.01, 0.02, 0.03), 1.4)
    assert Pipeline().material(changed(material=wax)).eta == (1.4, 1.4, 1.4)
    with pytest.raises(ParameterError, match="material"):
        Pipeline().material(changed(material="granite"))


def test_the_scale_is_the_sessions_else_the_samples_else_a_millimetre(tmp_path):
    pipeline = Pipeline()
    path = tmp_path / "m.off"
    path.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    assert pipeline.mm_per_unit(changed(mesh="sample:bunny", mm_per_unit=7.0)) == 7.0
    assert pipeline.mm_per_unit(changed(mesh="sample:bunny")) == 100.0
    assert pipeline.mm_per_unit(changed(mesh=str(path))) == 1.0


def test_lights_of_the_camera_turn_with_it_and_others_do_not():
    turned = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
    lights = (
        Directional((0.0, 0.0, 1.0), frame="camera"),
        Directional((0.0, 0.0, 1.0)),
        Point((1.0, 2.0, 3.0)),
        Cone((1.0, 2.0, 3.0), (0.0, 0.0, -1.0), angle=10.0),
    )
    built = world_lights(changed(lights=lights), turned)
    np.testing.assert_allclose(built[0].direction, (1.0, 0.0, 0.0))
    np.testing.assert_allclose(built[1].direction, (0.0, 0.0, 1.0))
    np.testing.assert_allclose(built[2].position, (1.0, 2.0, 3.0))
    assert built[3].angle == 10.0


def test_a_missing_mesh_is_an_error_with_its_name(tmp_path):
    with pytest.raises(MeshError, match="gone"):
        Pipeline().subject(changed(mesh=str(tmp_path / "gone.ply")))


def test_a_scale_that_nobody_gave_is_never_refused(tmp_path):
    path = tmp_path / "square.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    session, pipeline = Session(mesh=str(path)), Pipeline()
    assert 0.0 < pipeline.scale(session) <= pipeline.subject(session).mesh.diagonal
    assert pipeline.exitance(session, session.model, AXES).shape == (4, 3)
