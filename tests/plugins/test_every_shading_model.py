"""What every shading model must do; a new one is tested by being registered."""

import dataclasses
from functools import cache

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from lutcore.baking import bake
from lutcore.curvature import PrincipalCurvatures
from lutcore.exitance import shade
from lutcore.fresnel import hinges, mean_transmittance, transmittance
from lutcore.lights import ConeLight, DirectionalLight, Light, PointLight
from lutcore.materials import Material, material
from lutcore.mesh import TriangleMesh
from lutcore.prediction import Scene
from lutcore.shading import model_registry, shading_inputs, shading_models
from tests.plugins.shading_violations import ENERGY, LAMBERT, MONOTONE, cases
from tests.surfaces import bent, sphere, torus

FloatArray = NDArray[np.float64]
MODELS = shading_models()
LOCAL = [name for name in MODELS if model_registry.get(name).local]
# What a flat surface lets in: F_t(N.w) within the error given, and <F_t> for the other models.
DIRECTIONAL = {"curvature-lut": hinges(1.3, 4).error, "monge-patch": 0.0, "sphere-table": 0.0}
LIGHTS: list[Light] = [
    DirectionalLight((1.0, 0.3, 0.5), (1.0, 0.9, 0.8)),
    PointLight((-60.0, 20.0, 40.0), (3000.0, 2000.0, 4000.0)),
    ConeLight((0.0, 0.0, 90.0), (0.0, 0.0, -1.0), 2000.0, 15.0),
]
# Sums of a few dozen terms of order one.
ROUNDING = 1e-12
ABOVE = DirectionalLight((0.0, 0.0, 1.0))
PRISM = Material("prism", (0.74, 0.88, 1.01), (0.032, 0.17, 0.48), (1.1, 1.3, 1.7))


def size(model: str) -> int:
    """Return how many vertices: more than a block, or a few, as each gathers from all triangles."""
    return 900 if model in LOCAL else 196


def on_torus(model: str, lights: list[Light], substance: Material | str = "skin1") -> FloatArray:
    return shade(*torus(size(model)), substance, lights, model)


@cache
def in_all_lights(model: str, name: str = "skin1") -> FloatArray:
    """Return what most tests compare with, not to be written to."""
    shaded = on_torus(model, LIGHTS, name)
    shaded.flags.writeable = False
    return shaded


def slack(model: str) -> float:
    """Return how far sums may be apart: what clusters stand for depends on all the light."""
    return ROUNDING if model in LOCAL else 0.005


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("name", ["skin1", "marble", "spectralon"])
def test_shape_finite_and_not_negative(model: str, name: str) -> None:
    shaded = in_all_lights(model, name)
    assert shaded.shape == (size(model), 3)
    assert shaded.dtype == np.float64
    assert np.isfinite(shaded).all()
    assert (shaded >= 0.0).all()
    assert (shaded.max(axis=0) > 0.1).all()


@pytest.mark.parametrize("model", MODELS)
def test_dark_without_light(model: str) -> None:
    np.testing.assert_array_equal(on_torus(model, []), 0.0)
    np.testing.assert_array_equal(on_torus(model, [DirectionalLight((0.0, 0.0, 1.0), 0.0)]), 0.0)


@pytest.mark.parametrize("model", MODELS)
def test_lights_add_and_scale(model: str) -> None:
    apart = [on_torus(model, [light]) for light in LIGHTS]
    together = np.sum(apart, axis=0)
    np.testing.assert_allclose(in_all_lights(model), together, rtol=0.0, atol=slack(model))
    bright = PointLight((-60.0, 20.0, 40.0), (6000.0, 4000.0, 8000.0))
    np.testing.assert_allclose(on_torus(model, [bright]), 2.0 * apart[1])


def grey(substance: Material, channel: int) -> Material:
    """Return the material that is in all channels what `substance` is in one."""
    return Material(
        "one channel",
        (substance.scattering[channel],) * 3,
        (substance.absorption[channel],) * 3,
        substance.eta[channel],
    )


@pytest.mark.parametrize("model", MODELS)
def test_channels_do_not_mix(model: str) -> None:
    skin = material("skin1")
    together = in_all_lights(model)
    for channel in range(3):
        alone = on_torus(model, LIGHTS, grey(skin, channel))
        close = slack(model) if model not in LOCAL else 0.0
        np.testing.assert_allclose(alone[:, channel], together[:, channel], rtol=0.0, atol=close)


@pytest.mark.parametrize("model", MODELS)
def test_each_channel_has_the_refractive_index_of_its_own(model: str) -> None:
    together = on_torus(model, LIGHTS, PRISM)
    for channel in range(3):
        alone = on_torus(model, LIGHTS, grey(PRISM, channel))
        # Every local model treats channels apart, from the same tables: no bit may differ.
        close = slack(model) if model not in LOCAL else 0.0
        np.testing.assert_allclose(alone[:, channel], together[:, channel], rtol=0.0, atol=close)
    # More light is reflected at the surface, and back inside, where the index is higher.
    assert (together[:, 0] != together[:, 1]).any() and (together[:, 1] != together[:, 2]).any()


@pytest.mark.parametrize("model", MODELS)
def test_three_equal_indices_are_one_to_the_last_bit(model: str) -> None:
    skin = material("skin1")
    three = Material("skin1", skin.scattering, skin.absorption, (1.3, 1.3, 1.3))
    np.testing.assert_array_equal(on_torus(model, LIGHTS, three), in_all_lights(model))


@pytest.mark.parametrize("model", MODELS)
def test_each_channels_error_is_predicted_with_its_own_index(model: str) -> None:
    mesh, curvatures = torus(900)

    def predicted(substance: Material) -> FloatArray | None:
        inputs = shading_inputs(mesh, curvatures, substance, LIGHTS)
        return model_registry.get(model)().predicted_error(Scene.of(inputs, curvatures))

    together = predicted(PRISM)
    for channel in range(3):
        alone = predicted(grey(PRISM, channel))
        assert (alone is None) == (together is None)
        if alone is not None and together is not None:
            np.testing.assert_array_equal(alone[:, channel], together[:, channel])


@pytest.mark.parametrize("model", LOCAL)
@settings(max_examples=4, deadline=None, derandomize=True)
@example(eta=(1.0, 1.0, 3.0))
@given(eta=st.tuples(*[st.floats(1.0, 3.0)] * 3))
def test_no_index_makes_a_fault_or_light_on_a_flat_surface(
    model: str, eta: tuple[float, float, float]
) -> None:
    skin = material("skin1")
    made = Material("any index", skin.scattering, skin.absorption, eta)
    cosines = np.linspace(-1.0, 1.0, 41)
    for radius in (0.5, 5.0, np.inf):
        shaded = shade(*sphere(cosines, radius), made, [ABOVE], model)
        assert np.isfinite(shaded).all() and (shaded >= 0.0).all()
    # What gets in, F_t(N.w), and what of it comes out are 1 at most; c F_t(c) by hinges may be off.
    off = [hinges(index, 4).error for index in eta]
    assert (shaded.max(axis=0) <= 1.0 + np.array(off)).all()


@pytest.mark.parametrize("model", LOCAL)
def test_rotating_everything_changes_nothing(model: str) -> None:
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_rotvec([0.4, -1.1, 0.7]).as_matrix()
    mesh, curvatures = torus(900)
    turned = TriangleMesh(mesh.vertices @ turn.T, mesh.faces)
    moved = {name: getattr(curvatures, name) @ turn.T for name in ("d1", "d2", "normals")}
    # Without the cone: at its edge a rounding decides.
    lights: list[Light] = [
        DirectionalLight(turn @ [1.0, 0.3, 0.5], (1.0, 0.9, 0.8)),
        PointLight(turn @ [-60.0, 20.0, 40.0], (3000.0, 2000.0, 4000.0)),
    ]
    again = shade(turned, dataclasses.replace(curvatures, **moved), "skin1", lights, model)
    np.testing.assert_allclose(again, on_torus(model, LIGHTS[:2]), rtol=0.0, atol=ROUNDING)


@pytest.mark.parametrize("model", cases(LAMBERT, LOCAL))
def test_a_large_radius_is_lambert(model: str) -> None:
    cosines = np.linspace(-1.0, 1.0, 201)
    reflectance = bake("skin1").total
    lit = np.maximum(cosines, 0.0)
    let_in = transmittance(lit, 1.3) if model in DIRECTIONAL else mean_transmittance(1.3)
    flat, slack = lit * let_in, DIRECTIONAL.get(model, 0.0)
    for radius in (1e6, np.inf):
        shaded = shade(*sphere(cosines, radius), "skin1", [ABOVE], model)
        # First order in curvature: the glow at the terminator is psi(0) l_u/radius < 1.3/radius.
        difference = np.abs(shaded / reflectance - flat[:, None]).max()
        assert difference <= slack + 1.3 / radius + ROUNDING


@pytest.mark.parametrize("model", LOCAL)
def test_directions_do_not_matter_at_an_umbilic(model: str) -> None:
    cosines = np.linspace(-1.0, 1.0, 101)
    mesh, curvatures = sphere(cosines, 5.0)
    angle = np.linspace(0.0, 7.0, 101)[:, None]
    turned = dataclasses.replace(
        curvatures,
        d1=np.cos(angle) * curvatures.d1 + np.sin(angle) * curvatures.d2,
        d2=np.cos(angle) * curvatures.d2 - np.sin(angle) * curvatures.d1,
    )
    lights: list[Light] = [DirectionalLight((0.3, 0.4, 0.5))]
    np.testing.assert_allclose(
        shade(mesh, turned, "skin1", lights, model),
        shade(mesh, curvatures, "skin1", lights, model),
        rtol=0.0,
        atol=ROUNDING,
    )


@pytest.mark.parametrize("model", LOCAL)
@pytest.mark.parametrize("radius", [5.0, 50.0, np.inf])
def test_a_higher_light_never_darkens(model: str, radius: float) -> None:
    cosines = np.cos(np.linspace(np.pi, 0.0, 721))
    shaded = shade(*sphere(cosines, radius), "skin1", [ABOVE], model)
    # The cubics between knots and the last knot are within 1e-6 of psi.
    assert (np.diff(shaded, axis=0) >= -1e-6).all()


@pytest.mark.parametrize("model", LOCAL)
def test_concave_is_flat(model: str) -> None:
    cosines = np.linspace(-1.0, 1.0, 101)
    mesh, curvatures = sphere(cosines, 5.0)
    bowl = dataclasses.replace(curvatures, k1=-curvatures.k1, k2=-2.0 * curvatures.k2)
    plane = dataclasses.replace(curvatures, k1=0.0 * curvatures.k1, k2=0.0 * curvatures.k2)
    np.testing.assert_array_equal(
        shade(mesh, bowl, "skin1", LIGHTS, model), shade(mesh, plane, "skin1", LIGHTS, model)
    )


@pytest.mark.parametrize("model", LOCAL)
def test_millimetres_count_not_units(model: str) -> None:
    # The same body, measured in units of 1 mm and of 2.5 mm.
    mesh, curvatures = torus(900)
    small = TriangleMesh(mesh.vertices / 2.5, mesh.faces)
    scaled = dataclasses.replace(curvatures, k1=2.5 * curvatures.k1, k2=2.5 * curvatures.k2)
    lights: list[Light] = [
        LIGHTS[0],
        PointLight((-24.0, 8.0, 16.0), np.array([3000.0, 2000.0, 4000.0]) / 2.5**2),
    ]
    np.testing.assert_allclose(
        shade(small, scaled, "skin1", lights, model, mm_per_unit=2.5),
        on_torus(model, LIGHTS[:2]),
        rtol=0.0,
        atol=ROUNDING,
    )


@pytest.mark.parametrize("model", LOCAL)
def test_vertices_without_normal_or_at_the_light_are_dark(model: str) -> None:
    points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    normals = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])
    nothing, tangent = np.zeros(3), np.zeros((3, 3))
    curvatures = PrincipalCurvatures(nothing, nothing, tangent, tangent, normals, nothing, 0.0)
    mesh = TriangleMesh(points, [[0, 1, 2]])
    shaded = shade(mesh, curvatures, "skin1", [PointLight((1.0, 0.0, 0.0))], model)
    np.testing.assert_array_equal(shaded[1:], 0.0)
    sunlit = shade(mesh, curvatures, "skin1", [ABOVE], model)
    assert (sunlit[:2] > 0.0).all()
    np.testing.assert_array_equal(sunlit[2], 0.0)


@pytest.mark.parametrize("model", MODELS)
def test_the_number_of_threads_changes_no_bit(model: str) -> None:
    import numba

    before, whole = numba.get_num_threads(), in_all_lights(model)
    try:
        numba.set_num_threads(1)
        np.testing.assert_array_equal(on_torus(model, LIGHTS), whole)
    finally:
        numba.set_num_threads(before)


@pytest.mark.parametrize("model", LOCAL)
def test_every_vertex_is_on_its_own(model: str) -> None:
    # More than one block, and a last block that is not full.
    mesh, curvatures = torus(900)
    part = slice(100, 613)
    fields = {
        name: getattr(curvatures, name)[part]
        for name in ("k1", "k2", "d1", "d2", "normals", "error")
    }
    some = TriangleMesh(mesh.vertices[part], [[0, 1, 2]])
    alone = shade(some, PrincipalCurvatures(scale=0.0, **fields), "skin1", LIGHTS, model)
    np.testing.assert_array_equal(alone, in_all_lights(model)[part])


@pytest.mark.parametrize("model", LOCAL)
def test_cast_shadows_multiply_each_light(model: str) -> None:
    shares = np.random.default_rng(2).uniform(0.0, 1.0, (len(LIGHTS), 900))
    shaded = shade(*torus(900), "skin1", LIGHTS, model, visibility=shares)
    alone = [on_torus(model, [light]) for light in LIGHTS]
    np.testing.assert_allclose(
        shaded, np.einsum("ln,lnc->nc", shares, alone), rtol=0.0, atol=ROUNDING
    )


@pytest.mark.parametrize("model", LOCAL)
def test_enormous_curvature_stays_finite_and_not_negative(model: str) -> None:
    cosines = np.linspace(-1.0, 1.0, 101)
    for radius in (1.0, 1e-3, 1e-12):
        for name in ("skin1", "spectralon"):
            shaded = shade(*sphere(cosines, radius), name, [ABOVE], model)
            assert np.isfinite(shaded).all()
            assert (shaded >= 0.0).all()


def leaving(model: str, name: str) -> float:
    """Return the largest share of a beam that leaves a sphere of .02 to 300 l_u again."""
    nodes, weights = np.polynomial.legendre.leggauss(100)
    cosines = np.concatenate((0.5 * (nodes - 1.0), 0.5 * (nodes + 1.0)))
    length = float(material(name).mean_free_path[0])
    shares = [
        # int M dA/(pi radius^2), dA = 2 pi radius^2 dcos
        np.concatenate((weights, weights)) @ shade(*sphere(cosines, r), name, [ABOVE], model)
        for r in length * np.geomspace(0.02, 300.0, 15)
    ]
    return float(np.max(shares))


@pytest.mark.parametrize(("model", "name"), cases(ENERGY, LOCAL, ("skin1", "marble", "spectralon")))
def test_no_more_light_leaves_a_sphere_than_falls_on_it(model: str, name: str) -> None:
    assert leaving(model, name) <= 1.0


@pytest.mark.parametrize(("model", "radius"), cases(MONOTONE, LOCAL, (0.1, 0.5, 2.0)))
def test_a_higher_light_never_darkens_a_strongly_curved_surface(model: str, radius: float) -> None:
    cosines = np.cos(np.linspace(np.pi, 0.0, 361))
    shaded = shade(*sphere(cosines, radius), "skin1", [ABOVE], model)
    # Tables are within 5e-6 of what is monotone, with knots at least four steps apart.
    assert (np.diff(shaded, axis=0) >= -1e-6).all()


@pytest.mark.parametrize("model", LOCAL)
@pytest.mark.parametrize("height", [-0.3, 0.0, 0.02, 0.7])
def test_no_seam_in_curvature(model: str, height: float) -> None:
    light: list[Light] = [DirectionalLight((0.6, 0.8, height))]
    # Across 0, where concave turns flat and flat convex: 1e-9 of a curvature near 1 is nothing.
    step = np.array([-1e-9, 0.0, 1e-9])
    for other in (-1.0, 0.0, 0.3):
        shaded = shade(*bent(step, np.full(3, other)), "skin1", light, model)
        assert np.abs(np.diff(shaded, axis=0)).max() < 1e-7
    # Across every limit, on a sphere and on a body whose k2 passes k1: a step of .1 % changes the
    # first order, which is the steepest, by .1 % of the glow.
    k = np.geomspace(1e-5, 1e3, 18_500)
    for k1 in (k, np.full(len(k), 0.2)):
        shaded = shade(*bent(k1, k), "skin1", light, model)
        assert (np.abs(np.diff(shaded, axis=0)) <= 2e-3 * (shaded[1:] + 0.5)).all()


@pytest.mark.parametrize("model", LOCAL)
@pytest.mark.parametrize("radius", [0.05, 1.0, 30.0, np.inf])
def test_no_seam_in_the_height_of_light(model: str, radius: float) -> None:
    cosines = np.cos(np.linspace(np.pi, 0.0, 18_001))
    shaded = shade(*sphere(cosines, radius), "skin1", [ABOVE], model)
    # .01 degrees: sharpest is c F_t(c), whose slope is 1.1 at most; a glow adds less than itself.
    bound = np.radians(0.01) * 2.0 * np.maximum(shaded.max(axis=0), 1.0)
    assert (np.abs(np.diff(shaded, axis=0)) <= bound).all()
