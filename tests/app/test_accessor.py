import numpy as np
import pytest
import pyvista

from app.pipeline import Pipeline
from app.session import Directional, Method, Session
from lutcore.errors import MeshError, ParameterError
from lutcore.lights import DirectionalLight


def test_the_accessor_is_found_without_importing_us():
    ball = pyvista.Sphere(radius=2.0, theta_resolution=60, phi_resolution=60)
    curved = ball.curvelight.curvature(method="rusinkiewicz2004")
    assert curved is not ball
    assert "k1" not in ball.point_data
    assert np.median(curved["mean_curvature"]) == pytest.approx(0.5, rel=0.01)
    assert curved["d1"].shape == (ball.n_points, 3)


def test_polygons_are_triangulated_for_computing_and_kept_in_the_result():
    plane = pyvista.Plane(i_resolution=8, j_resolution=8)
    curved = plane.curvelight.curvature(method="rusinkiewicz2004")
    assert curved.n_cells == plane.n_cells
    np.testing.assert_allclose(curved["k1"], 0.0, atol=1e-12)


def test_shading_gives_linear_light_and_display_bytes():
    ball = pyvista.Sphere(radius=10.0)
    light = DirectionalLight((0.0, 0.0, 1.0))
    shaded = ball.curvelight.shade("marble", [light], method="rusinkiewicz2004", exposure=1.0)
    assert shaded["shading"].dtype == np.float32
    assert shaded["shading_srgb"].dtype == np.uint8
    top, bottom = np.argmax(ball.points[:, 2]), np.argmin(ball.points[:, 2])
    assert shaded["shading"][top].min() > 0.5 > shaded["shading"][bottom].max()


def test_the_default_lights_are_figure_1s():
    shaded = pyvista.Sphere(radius=10.0).curvelight.shade(method="rusinkiewicz2004")
    points = shaded.points
    assert (
        shaded["shading"][np.argmax(points[:, 0]), 0]
        > shaded["shading"][np.argmin(points[:, 0]), 0]
    )


@pytest.mark.parametrize("model", ["lambert", "jensen2002"])
def test_shadows_are_those_of_a_session(model):
    lights = (Directional((0.3, 0.9, 0.2)), Directional((1.0, 0.0, 0.0)))
    session = Session(mesh="sample:torus", lights=lights, shadows="on", model=Method(model))
    pipeline = Pipeline()
    mesh, size = pipeline.subject(session).mesh, pipeline.mm_per_unit(session)
    surface = pyvista.PolyData.from_regular_faces(mesh.vertices, mesh.faces)
    given = [DirectionalLight(light.direction) for light in lights]

    def shaded(shadows):
        return surface.curvelight.shade("skin1", given, model, size, shadows=shadows, exposure=1.0)[
            "shading"
        ]

    truth = pipeline.exitance(session, session.model, np.eye(3)).astype(np.float32)
    np.testing.assert_array_equal(shaded("on"), truth)
    np.testing.assert_array_equal(shaded("auto"), truth)
    assert shaded("off").mean() > 1.01 * truth.mean()


def test_what_is_wrong_is_said():
    with pytest.raises(ParameterError, match="shadows 'soft'"):
        pyvista.Sphere().curvelight.shade(shadows="soft")
    with pytest.raises(MeshError, match="no faces"):
        pyvista.PolyData(np.zeros((3, 3))).curvelight.curvature()
    with pytest.raises(ParameterError, match="shading model"):
        pyvista.Sphere().curvelight.shade(model="phong", method="rusinkiewicz2004")
