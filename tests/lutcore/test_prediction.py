"""Predicted errors against true ones, on surfaces small enough for brute force."""

from dataclasses import replace

import numpy as np
import pytest

from lutcore import analytic
from lutcore.baking import bake
from lutcore.blend import at
from lutcore.detail import detail_seen
from lutcore.error_terms import DOUBT
from lutcore.estimation import principal_curvatures
from lutcore.gather.exitance import exact
from lutcore.lights import DirectionalLight, Light, PointLight
from lutcore.prediction import COSINES, WEIGHTS, Knowledge, Scene
from lutcore.shading import ShadingInputs, model_registry, shading_inputs

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
    directional = model_registry.get("lambert")(fresnel="directional").predicted_error(scene)
    assert directional is not None
    # 2.5 times the base is what its term can reach: c F_t is at most 1, the edge 1.5. On the sphere
    # k1^2 + k2^2 = 2/r^2.
    facets = WEIGHTS["facet"] * 2.0 * scene.facet.max() / 1e12
    assert directional.max() <= 2.5 * WEIGHTS["base"] + facets


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
    body = analytic.sphere(400, radius=1e6)
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


def test_bumps_that_light_blurs_or_shows_are_no_error() -> None:
    # What the normals of each channel's light leave out counts where facets are as wide as light
    # reaches, and neither the error bar of one scale nor its tilt counts then.
    weights = np.array([float(term == "bumps") for term in WEIGHTS])
    body = analytic.torus(3000, irregular=True, major=24.0, minor=10.0)
    mesh = body.noisy(0.1)
    found, largest = principal_curvatures(mesh, "auto", 3.0), []
    for mm in (1e-3, 1.0, 1e3):
        seen = detail_seen(mesh, "skin1", mm)
        scene = Scene.of(shading_inputs(mesh, found, "skin1", [LIGHT], mm, detail=seen), found)
        assert not scene.tilt.any()
        largest.append(scene.bound(Knowledge(scene.entering), weights).max())
    assert largest[1] > 3.0 * max(largest[0], largest[2])
    single = Scene.of(shading_inputs(mesh, found, "skin1", [LIGHT], 1.0), found)
    assert single.tilt.any()
    assert not single.bumps.any()
