"""Predicted errors against true ones, on surfaces small enough for brute force."""

from dataclasses import replace

import numpy as np
import pytest

from lutcore import analytic
from lutcore.baking import bake
from lutcore.blend import at
from lutcore.detail import detail_seen
from lutcore.error_terms import BENT, CUT, DOUBT
from lutcore.estimation import principal_curvatures
from lutcore.exitance import exitance
from lutcore.gather.exitance import exact
from lutcore.lights import DirectionalLight, Light, PointLight
from lutcore.prediction import COSINES, WEIGHTS, Knowledge, Scene
from lutcore.shading import ShadingInputs, ShadingModel, model_registry, shading_inputs
from tests.bumps import bare

LIGHT = DirectionalLight((0.6, 0.3, 0.74))
PREDICTED = (
    "bredow2002",
    "curvature-lut",
    "kolchin2007",
    "kolchin2007-simplified",
    "kubo2010",
    "lambert",
    "penner2011",
    "wrap",
)


def scene_on(
    body: analytic.Exact, mm: float, lights: list[Light] | None = None, material: str = "skin1"
) -> tuple[ShadingInputs, Scene]:
    given: list[Light] = [LIGHT] if lights is None else lights
    inputs = shading_inputs(body.mesh, body.truth, material, given, mm)
    return inputs, Scene.of(inputs, body.truth)


@pytest.fixture(scope="module")
def gathered() -> tuple[ShadingInputs, Scene, np.ndarray, np.ndarray]:
    """Return an ellipsoid of 3:1 whose sharpest end has a radius of 8 l_d, red."""
    body = analytic.ellipsoid(6000, axes=(3.0, 1.5, 1.0))
    inputs, scene = scene_on(body, 60.0)
    chosen = np.random.default_rng(5).choice(len(body.mesh.vertices), 250, replace=False)
    return inputs, scene.at(chosen), chosen, exact(inputs, body.mesh.vertices[chosen])


@pytest.mark.parametrize("name", PREDICTED)
def test_bounds_most_true_errors_and_is_not_far_above(
    name: str, gathered: tuple[ShadingInputs, Scene, np.ndarray, np.ndarray]
) -> None:
    inputs, scene, chosen, truth = gathered
    model = model_registry.get(name)()
    predicted = model.predicted_error(scene)
    assert predicted is not None
    true = np.abs(model.shade(at(inputs, chosen)) - truth) / inputs.table.total
    assert np.mean(true <= predicted) >= 0.95
    seen = np.maximum(true, predicted) > 1e-4
    assert np.median(predicted[seen] / true[seen]) <= 5.0


def test_flat_surface_leaves_only_what_is_resolved() -> None:
    body = analytic.sphere(400, radius=1e6)
    _, scene = scene_on(body, 1.0)
    # The corners of so coarse a sphere lack half a percent of their angle, and as much of the
    # gathered light: on a flat surface none.
    directional = model_registry.get("lambert")(fresnel="directional").predicted_error(
        replace(scene, corner=np.zeros_like(scene.corner))
    )
    assert directional is not None
    # 2.5 times the base is what its term can reach: c F_t is at most 1, the edge 1.5. What the
    # facets of so coarse a sphere bend by is half of what they are cut at, and no more.
    facets = (WEIGHTS["corner"] + WEIGHTS["unsure"]) * BENT * 0.5 * CUT
    assert directional.max() <= 2.5 * WEIGHTS["base"] + facets


def test_corners_of_a_coarse_body_lack_light_as_they_lack_angle() -> None:
    # Light reaches a thousandth of the facets' width.
    inputs, scene = scene_on(analytic.sphere(400, radius=1e4), 1.0)
    truth = exact(inputs, inputs.points)
    error = np.abs(exitance(model_registry.get("lambert")(fresnel="directional"), inputs) - truth)
    weights = np.array([float(term == "corner") for term in WEIGHTS])
    known = scene.bound(Knowledge(scene.entering), weights)
    lit = scene.normals @ np.asarray(LIGHT.direction) / np.linalg.norm(LIGHT.direction) > 0.3
    error /= inputs.table.total
    assert np.median(error[lit]) > 2e-3
    assert np.median(np.abs(error - known)[lit]) < 0.1 * np.median(error[lit])


def test_more_curvature_is_a_larger_error() -> None:
    body = analytic.sphere(400)
    largest = [
        model_registry.get("lambert")(fresnel="directional")
        .predicted_error(scene_on(body, mm)[1])
        .max()
        for mm in (1000.0, 300.0, 100.0, 30.0, 10.0)
    ]
    assert np.all(np.diff(largest) > 0.0)


def test_curvature_noise_counts_at_the_terminator_and_not_at_60_degrees() -> None:
    body = analytic.sphere(4000)
    inputs, scene = scene_on(body, 40.0)
    eps = 0.1
    weights = np.array([float(term == "beside") for term in WEIGHTS])
    noisy = replace(scene, error=np.full(len(scene.error), eps / 40.0))
    known = Knowledge(scene.entering)
    change = noisy.bound(known, weights) - scene.bound(known, weights)
    table = bake("skin1")
    E1 = table.mean_free_path / 40.0 * table.psi[:, 0]
    # Two independent parts of b*: it grows by less than either alone would make it.
    assert np.all(change >= 0.0)
    assert change.max() > 0.0
    assert np.all(change.max(axis=0) <= 1.01 * DOUBT * eps * E1)
    cosine = scene.normals @ np.asarray(LIGHT.direction) / np.linalg.norm(LIGHT.direction)
    # The bound's tail is algebraic where psi's is exponential: 1e-4 instead of 1e-5.
    assert change[np.abs(cosine - 0.5) < 0.02].max() <= 1e-4 * 2.0
    del inputs


def test_flat_ground_in_the_dark_fears_a_lit_ridge_beside_it() -> None:
    # The same vertices, flat and facing away, once on a plain and once where curvature changes.
    body = analytic.sphere(4000, radius=1e6)
    _, plain = scene_on(body, 1.0)
    slope = 0.05 * np.ones((len(plain.points), 1)) * np.array([1.0, 0.0, 0.0])
    changing = replace(plain, slope=slope)
    cosine = plain.normals @ np.asarray(LIGHT.direction) / np.linalg.norm(LIGHT.direction)
    dark = (cosine < -0.1) & (cosine > -0.3)
    model = model_registry.get("curvature-lut")()
    alone, beside = model.predicted_error(plain), model.predicted_error(changing)
    assert alone is not None
    assert beside is not None
    least = WEIGHTS["least"] * np.asarray(LIGHT.irradiance)
    np.testing.assert_allclose(alone[dark], np.broadcast_to(least, alone[dark].shape), rtol=1e-3)
    assert np.all(beside[dark, 0] > 3.0 * least[0])


def test_without_lights_no_light_is_worse() -> None:
    body = analytic.torus(600, major=3.0, minor=1.0)
    worst = model_registry.get("lambert")().predicted_error(scene_on(body, 20.0, [])[1])
    assert worst is not None
    for seed in range(5):
        direction = np.random.default_rng(seed).standard_normal(3)
        scene = scene_on(body, 20.0, [DirectionalLight(direction)])[1]
        one = model_registry.get("lambert")().predicted_error(scene)
        assert one is not None
        # Between the cosines that are tried the error may be a little larger.
        assert np.mean(one > 1.05 * worst + 1e-3) < 0.02


def test_lights_add() -> None:
    body = analytic.torus(500, major=3.0, minor=1.0)
    lights: list[Light] = [LIGHT, PointLight((9.0, 4.0, 5.0), (80.0, 60.0, 40.0))]
    model = model_registry.get("curvature-lut")()
    alone = [model.predicted_error(scene_on(body, 20.0, [light])[1]) for light in lights]
    both = model.predicted_error(scene_on(body, 20.0, lights)[1])
    np.testing.assert_allclose(both, np.sum(alone, axis=0), rtol=1e-12)


def test_part_of_a_scene_is_predicted_as_the_whole() -> None:
    _, scene = scene_on(analytic.torus(500, major=3.0, minor=1.0), 20.0)
    known = Knowledge(np.maximum(COSINES, 0.0), bend="none")
    some = np.arange(3, 400, 7)
    np.testing.assert_array_equal(scene.at(some).error_of(known), scene.error_of(known)[some])


def test_bumps_count_where_light_crosses_facets() -> None:
    # Not where it comes from those of one corner alone, and not where there are none.
    weights = np.array([float(term == "bumps") for term in WEIGHTS])
    smooth = analytic.torus(3000, major=24.0, minor=10.0).mesh
    bumpy = analytic.torus(3000, irregular=True, major=24.0, minor=10.0).noisy(0.1)
    largest = []
    for mesh, mm in ((bumpy, 10.0), (bumpy, 1e4), (smooth, 10.0)):
        found = principal_curvatures(mesh, "auto", 3.0)
        seen = detail_seen(mesh, "skin1", mm)
        scene = Scene.of(shading_inputs(mesh, found, "skin1", [LIGHT], mm, detail=seen), found)
        largest.append(scene.bound(Knowledge(scene.entering), weights).max())
    assert largest[0] > 100.0 * max(largest[1], largest[2])


@pytest.mark.parametrize("by_channel", [True, False])
def test_noise_that_light_shows_is_known_from_the_facets(by_channel: bool) -> None:
    # Light reaches a seventh of the facets' width: what comes out follows from the angles and the
    # normals around each vertex, of which the noise makes most of the error.
    mesh, mm = analytic.torus(3000, irregular=True, major=24.0, minor=10.0).noisy(0.1), 40.0
    found = principal_curvatures(mesh, "auto", 3.0)
    seen = detail_seen(mesh, "skin1", mm) if by_channel else None
    inputs = shading_inputs(mesh, found, "skin1", [LIGHT], mm, detail=seen)
    chosen = np.random.default_rng(3).choice(len(mesh.vertices), 200, replace=False)
    truth = exact(shading_inputs(mesh, bare(mesh), "skin1", [LIGHT], mm), mesh.vertices[chosen])
    given = exitance(model_registry.get("curvature-lut")(hinges=8), at(inputs, chosen))
    scene = Scene.of(inputs, found).at(chosen)
    weights = np.array([float(term == "corner") for term in WEIGHTS])
    known = scene.bound(Knowledge(scene.entering), weights)
    error = np.abs(given - truth) / inputs.table.total
    lit = np.einsum("cnk,k->nc", scene.shaded, np.array(LIGHT.direction)) > 0.3
    lit = np.broadcast_to(lit, error.shape)
    assert np.median(error[lit]) > 3e-3
    assert np.corrcoef(error[lit], known[lit])[0, 1] > 0.8
    assert np.median(np.abs(error - known)[lit]) < 0.5 * np.median(error[lit])


@pytest.mark.parametrize(
    ("axes", "mm", "alike", "rest"),
    [((4.0, 1.0, 1.0), 800.0, 0.7, 0.25), ((2.0, 1.0, 1.0), 60.0, 0.95, 0.5)],
)
def test_sign_and_size_of_what_a_smooth_mesh_makes_are_known(
    axes: tuple[float, float, float], mm: float, alike: float, rest: float
) -> None:
    # At 800 mm it is the light in the middle of facets, four times as long as wide, off the mean of
    # their corners; at 60 mm the gradient of curvature.
    body = analytic.ellipsoid(6000, axes=axes)
    inputs, scene = scene_on(body, mm)
    chosen = np.random.default_rng(5).choice(len(body.mesh.vertices), 400, replace=False)
    truth = exact(inputs, body.mesh.vertices[chosen])
    scene = scene.at(chosen)
    given = exitance(model_registry.get("monge-patch")(), at(inputs, chosen))
    error = np.abs(given - truth) / inputs.table.total
    weights = np.array([float(term == "corner") for term in WEIGHTS])
    known = scene.bound(Knowledge(scene.entering), weights)
    lit = (scene.normals @ np.asarray(LIGHT.direction) / np.linalg.norm(LIGHT.direction)) > 0.3
    assert np.corrcoef(error[lit].ravel(), known[lit].ravel())[0, 1] > alike
    assert np.median(np.abs(error - known)[lit]) < rest * np.median(error[lit])


def test_dark_ground_fears_what_strays_to_the_light() -> None:
    _, plain = scene_on(analytic.sphere(4000, radius=1e6), 1.0)
    rough = replace(plain, variance=np.full((1, len(plain.points)), 0.04))
    model = model_registry.get("curvature-lut")()
    cosine = plain.normals @ np.asarray(LIGHT.direction) / np.linalg.norm(LIGHT.direction)
    change = model.predicted_error(rough) - model.predicted_error(plain)
    assert change.min() >= 0.0
    lit, edge, dark = (change[np.abs(cosine - a) < 0.02] for a in (0.5, -0.1, -0.9))
    # One of the standard deviation .2 at the terminator, less where the light stands high, most of
    # it just behind the terminator, none in the dark.
    whole = 0.2 * WEIGHTS["strays"]
    np.testing.assert_allclose(lit, whole / 1.5, rtol=0.1)
    assert 0.05 < edge.min() / whole < 0.8
    assert dark.max() < 0.05 * lit.min()


def test_normals_by_channel_of_a_smooth_body_stray_no_more_than_curvature_makes() -> None:
    body = analytic.torus(3000, major=26.0, minor=10.0)
    seen = detail_seen(body.mesh, "skin1", 1.0)
    inputs = shading_inputs(body.mesh, body.truth, "skin1", [LIGHT], 1.0, detail=seen)
    scene = Scene.of(inputs, body.truth)
    weights = np.array([float(term == "strays") for term in WEIGHTS])
    known = Knowledge(scene.entering)
    none = replace(scene, variance=np.zeros_like(scene.variance))
    assert scene.variance.max() > 1e-3
    change = scene.bound(known, weights) - none.bound(known, weights)
    assert np.quantile(change, 0.99) < 1e-3


def test_normals_of_a_smooth_body_smooth_nothing() -> None:
    # Those of the facets differ a little from the given ones: by no noise.
    weights = np.array([float(term == "corner") for term in WEIGHTS])
    _, scene = scene_on(analytic.torus(3000, major=3.0, minor=1.0), 40.0)
    exactly = replace(scene, bare=scene.normals)
    known = Knowledge(scene.entering)
    np.testing.assert_allclose(
        scene.bound(known, weights), exactly.bound(known, weights), atol=3e-5
    )


def test_prediction_has_no_jumps() -> None:
    # As the light goes round and as the body grows, no step is much larger than the next.
    body = analytic.torus(400, irregular=True, major=3.0, minor=1.0).noisy(0.05)
    found = principal_curvatures(body, "auto", 1.0)
    for name in ("lambert", "curvature-lut", "kubo2010"):
        model = model_registry.get(name)()

        def predicted(angle: float, mm: float, model: ShadingModel = model) -> np.ndarray:
            lights = [DirectionalLight((np.sin(angle), 0.3, np.cos(angle)))]
            inputs = shading_inputs(body, found, "skin1", lights, mm)
            value = model.predicted_error(Scene.of(inputs, found))
            assert value is not None
            return value

        for along in (
            lambda t: predicted(2.0 * np.pi * t, 20.0),
            lambda t: predicted(0.7, float(np.exp(6.0 * t))),
        ):
            steps = [
                np.abs(np.diff([along(t) for t in np.linspace(0.0, 1.0, n)], axis=0)).max()
                for n in (200, 400)
            ]
            assert steps[1] < 0.75 * steps[0]
