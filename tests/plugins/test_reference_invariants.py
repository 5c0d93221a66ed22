"""What light does, of the two models that gather it from the whole mesh."""

import numpy as np
import pytest
from numpy.typing import NDArray

from lutcore import analytic
from lutcore.exitance import shade
from lutcore.fresnel import transmittance
from lutcore.geometry import vertex_areas, vertex_corners
from lutcore.lights import DirectionalLight, Light, PointLight
from lutcore.materials import material
from lutcore.mesh import TriangleMesh
from lutcore.shading import model_registry, shading_models

FloatArray = NDArray[np.float64]
GATHERING = [name for name in shading_models() if not model_registry.get(name).local]
# What clusters may be off, relative to the mean; triangles one by one are cut by what they bound.
OFF = {"jensen2002": 0.005, "gather": 1e-5}


def relative(found: FloatArray, truth: FloatArray) -> float:
    """Return the root mean square error over the root mean square, the worst channel's."""
    error: FloatArray = np.linalg.norm(found - truth, axis=0) / np.linalg.norm(truth, axis=0)
    return float(error.max())


def at_height(degrees: float) -> Light:
    angle = np.radians(degrees)
    return DirectionalLight((np.cos(angle), 0.0, np.sin(angle)))


def test_the_bounds_are_of_all_models_that_gather() -> None:
    assert set(OFF) == set(GATHERING)


@pytest.mark.parametrize("model", GATHERING)
def test_rotating_everything_changes_nothing(model: str) -> None:
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_rotvec([0.4, -1.1, 0.7]).as_matrix()
    body = analytic.torus(300, major=5.0, minor=2.0)
    turned = TriangleMesh(body.mesh.vertices @ turn.T, body.mesh.faces)
    direction, place = np.array([1.0, 0.3, 0.5]), np.array([-15.0, 5.0, 10.0])
    still = shade(
        body.mesh,
        body.truth,
        "skin1",
        [DirectionalLight(direction), PointLight(place, 200.0)],
        model,
    )
    lights: list[Light] = [DirectionalLight(turn @ direction), PointLight(turn @ place, 200.0)]
    normals = body.truth.normals @ turn.T
    moved = shade(turned, body.truth, "skin1", lights, model, normals=normals)
    assert relative(moved, still) < 2.0 * OFF[model]


@pytest.mark.parametrize("model", GATHERING)
@pytest.mark.parametrize("radius", [1.0, 8.0])
def test_no_more_light_leaves_a_sphere_than_enters_it(model: str, radius: float) -> None:
    body = analytic.sphere(600, radius=radius)
    areas = vertex_areas(body.mesh, vertex_corners(body.mesh))
    lit = np.maximum(body.truth.normals[:, 2], 0.0)
    for name in ("skin1", "spectralon"):
        entered = areas @ (lit * transmittance(lit, material(name).eta[0]))
        left = shade(body.mesh, body.truth, name, [at_height(90.0)], model)
        assert (left >= 0.0).all()
        # Areas of vertices stand for an integral over triangles, which they are within 1 % of.
        assert (areas @ left <= 1.01 * entered).all()


@pytest.mark.parametrize("model", GATHERING)
def test_a_large_flat_body_is_lambert(model: str) -> None:
    points = [[-300.0, -300.0, 0.0], [300.0, -300.0, 0.0], [300.0, 300.0, 0.0]]
    corners = [*points, [-300.0, 300.0, 0.0], [0.0, 0.0, 0.0]]
    mesh = TriangleMesh(corners, [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    curvatures = analytic.sphere(5, radius=1.0).truth
    facing = np.tile([0.0, 0.0, 1.0], (5, 1))
    for degrees in (10.0, 50.0, 90.0):
        light = [at_height(degrees)]
        found = shade(mesh, curvatures, "skin1", light, model, normals=facing)[4]
        flat = shade(
            mesh, curvatures, "skin1", light, "lambert", normals=facing, fresnel="directional"
        )
        # What lies beyond 300 mm gives less than exp(-300/l_d) of it.
        np.testing.assert_allclose(found, flat[4], rtol=2.0 * OFF[model] + 2e-4)


@pytest.mark.parametrize("model", GATHERING)
@pytest.mark.parametrize("radius", [0.5, 5.0])
def test_a_higher_light_never_darkens_and_never_jumps(model: str, radius: float) -> None:
    body = analytic.sphere(200, radius=radius)
    top = int(body.truth.normals[:, 2].argmax())
    heights = np.linspace(-90.0, 90.0, 13)
    # Of the vertex at the top, whose normal is within some degrees of upwards.
    rising = np.array(
        [shade(body.mesh, body.truth, "skin1", [at_height(h)], model)[top] for h in heights]
    )
    brightest = rising.max(axis=0)
    # A sphere of triangles is off a sphere by its edge squared over 8, .8 % of the radius.
    assert (np.diff(rising, axis=0) >= -(OFF[model] + 0.008) * brightest).all()
    # c F_t(c) has a slope of 1.1 at most, and 15 degrees are .262.
    step = np.radians(15.0) * 1.1
    assert (np.abs(np.diff(rising, axis=0)) <= (step + 2.0 * OFF[model]) * 1.2 * brightest).all()
