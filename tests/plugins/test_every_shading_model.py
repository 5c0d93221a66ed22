"""What every shading model must do; a new one is tested by being registered."""

import dataclasses

import numpy as np
import pytest
from numpy.typing import NDArray

from lutcore.baking import bake
from lutcore.curvature import PrincipalCurvatures
from lutcore.fresnel import hinges, mean_transmittance, transmittance
from lutcore.lights import ConeLight, DirectionalLight, Light, PointLight
from lutcore.materials import Material, material
from lutcore.mesh import TriangleMesh
from lutcore.shading import shade, shading_models
from tests.surfaces import sphere, torus

FloatArray = NDArray[np.float64]
MODELS = shading_models()
LIGHTS: list[Light] = [
    DirectionalLight((1.0, 0.3, 0.5), (1.0, 0.9, 0.8)),
    PointLight((-60.0, 20.0, 40.0), (3000.0, 2000.0, 4000.0)),
    ConeLight((0.0, 0.0, 90.0), (0.0, 0.0, -1.0), 2000.0, 15.0),
]
# Sums of a few dozen terms of order one.
ROUNDING = 1e-12
ABOVE = DirectionalLight((0.0, 0.0, 1.0))


def on_torus(model: str, lights: list[Light], substance: Material | str = "skin1") -> FloatArray:
    return shade(*torus(900), substance, lights, model)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("name", ["skin1", "marble", "spectralon"])
def test_shape_finite_and_not_negative(model: str, name: str) -> None:
    shaded = on_torus(model, LIGHTS, name)
    assert shaded.shape == (900, 3)
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
    apart = np.sum([on_torus(model, [light]) for light in LIGHTS], axis=0)
    np.testing.assert_allclose(on_torus(model, LIGHTS), apart, rtol=0.0, atol=ROUNDING)
    dim = PointLight((-60.0, 20.0, 40.0), (3000.0, 2000.0, 4000.0))
    bright = PointLight((-60.0, 20.0, 40.0), (6000.0, 4000.0, 8000.0))
    np.testing.assert_allclose(on_torus(model, [bright]), 2.0 * on_torus(model, [dim]))


@pytest.mark.parametrize("model", MODELS)
def test_channels_do_not_mix(model: str) -> None:
    skin = material("skin1")
    together = on_torus(model, LIGHTS)
    for channel in range(3):
        grey = Material(
            "one channel", (skin.scattering[channel],) * 3, (skin.absorption[channel],) * 3, 1.3
        )
        alone = on_torus(model, LIGHTS, grey)
        np.testing.assert_array_equal(alone[:, channel], together[:, channel])


@pytest.mark.parametrize("model", MODELS)
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


@pytest.mark.parametrize("model", [name for name in MODELS if name != "wrap"])
def test_a_large_radius_is_lambert(model: str) -> None:
    cosines = np.linspace(-1.0, 1.0, 201)
    reflectance = bake("skin1").total
    lit = np.maximum(cosines, 0.0)
    if model == "curvature-lut":
        # Fresnel inside: Lambert x F_t(N.w), within the error of the hinges.
        flat, slack = lit * transmittance(lit, 1.3), hinges(1.3, 4).error
    else:
        # Fresnel outside: Lambert x <F_t>.
        flat, slack = lit * mean_transmittance(1.3), 0.0
    for radius in (1e6, np.inf):
        shaded = shade(*sphere(cosines, radius), "skin1", [ABOVE], model)
        # First order in curvature: the glow at the terminator is psi(0) l_u/radius < 1.3/radius.
        difference = np.abs(shaded / reflectance - flat[:, None]).max()
        assert difference <= slack + 1.3 / radius + ROUNDING


@pytest.mark.parametrize("model", MODELS)
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


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("radius", [5.0, 50.0, np.inf])
def test_a_higher_light_never_darkens(model: str, radius: float) -> None:
    cosines = np.cos(np.linspace(np.pi, 0.0, 721))
    shaded = shade(*sphere(cosines, radius), "skin1", [ABOVE], model)
    # The cubics between knots and the last knot are within 1e-6 of psi.
    assert (np.diff(shaded, axis=0) >= -1e-6).all()


@pytest.mark.parametrize("model", MODELS)
def test_concave_is_flat(model: str) -> None:
    cosines = np.linspace(-1.0, 1.0, 101)
    mesh, curvatures = sphere(cosines, 5.0)
    bowl = dataclasses.replace(curvatures, k1=-curvatures.k1, k2=-2.0 * curvatures.k2)
    plane = dataclasses.replace(curvatures, k1=0.0 * curvatures.k1, k2=0.0 * curvatures.k2)
    np.testing.assert_array_equal(
        shade(mesh, bowl, "skin1", LIGHTS, model), shade(mesh, plane, "skin1", LIGHTS, model)
    )


@pytest.mark.parametrize("model", MODELS)
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


@pytest.mark.parametrize("model", MODELS)
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

    before = numba.get_num_threads()
    whole = on_torus(model, LIGHTS)
    try:
        numba.set_num_threads(1)
        np.testing.assert_array_equal(on_torus(model, LIGHTS), whole)
    finally:
        numba.set_num_threads(before)


@pytest.mark.parametrize("model", MODELS)
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
    np.testing.assert_array_equal(alone, on_torus(model, LIGHTS)[part])


@pytest.mark.parametrize("model", MODELS)
def test_enormous_curvature_stays_finite(model: str) -> None:
    cosines = np.linspace(-1.0, 1.0, 101)
    for radius in (1e-3, 1e-12):
        assert np.isfinite(shade(*sphere(cosines, radius), "skin1", [ABOVE], model)).all()
