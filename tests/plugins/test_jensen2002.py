import numpy as np

from lutcore import analytic
from lutcore.exitance import shade
from lutcore.lights import DirectionalLight, PointLight
from lutcore.shading import shading_models

LIGHTS = [
    DirectionalLight((1.0, 0.3, 0.5), (1.0, 0.9, 0.8)),
    PointLight((-60.0, 20.0, 40.0), (3000.0, 2000.0, 4000.0)),
]


def relative(found, truth):
    return (np.linalg.norm(found - truth, axis=0) / np.linalg.norm(truth, axis=0)).max()


def test_both_references_are_shading_models():
    assert {"jensen2002", "gather"} <= set(shading_models())


def test_the_octree_agrees_with_every_triangle():
    body = analytic.torus(800, major=20.0, minor=8.0)
    arguments = (body.mesh, body.truth, "marble", LIGHTS)
    exact = shade(*arguments, "gather")
    for tolerance in (0.005, 0.0005):
        found = shade(*arguments, "jensen2002", tolerance=tolerance)
        assert relative(found, exact) < tolerance


def test_local_models_agree_where_the_body_is_large():
    body = analytic.sphere(3_000, radius=200.0)
    arguments = (body.mesh, body.truth, "skin1", [DirectionalLight((0.0, 0.0, 1.0))])
    # curvature-lut's own error at R = 50 l_d and more is .2 % (four hinges).
    assert relative(shade(*arguments, "curvature-lut"), shade(*arguments, "jensen2002")) < 0.006


def test_a_light_at_a_vertex_and_a_vertex_without_a_normal_do_no_harm():
    body = analytic.sphere(300, radius=10.0)
    normals = body.truth.normals.copy()
    normals[5] = 0.0
    lights = [DirectionalLight((0.0, 0.0, 1.0)), PointLight(body.mesh.vertices[7])]
    shaded = shade(body.mesh, body.truth, "skin1", lights, "jensen2002", normals=normals)
    assert np.isfinite(shaded).all()
    assert (shaded >= 0.0).all()
    np.testing.assert_array_equal(shaded[5], 0.0)
