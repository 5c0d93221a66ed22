"""The default model, against NumPy, the sphere's quadrature, and known errors of all models."""

import numpy as np
import pytest

from lutcore.detail import Detail
from lutcore.exitance import shade
from lutcore.lights import DirectionalLight
from lutcore.shading import ShadingModel, shading_inputs
from plugins.shading.curvature_lut import CurvatureLut
from tests import numpy_shading
from tests.bench.shading_accuracy import ENERGY_RATIOS, RATIOS, model_energies, model_errors
from tests.bench.shading_speed import LIGHTS
from tests.surfaces import sphere, torus

# Relative L2 error on the sphere, per cent, at RATIOS; found independently of this code.
KNOWN = {
    "lambert, <F_t>": (13.4, 3.6, 4.9, 5.4, 5.6),
    "lambert, F_t(N.w)": (17.8, 4.0, 1.2, 0.35, 0.06),
    "wrap": (23.0, 19.0, 20.0, 21.0, 21.0),
    "kolchin2007-simplified": (12.9, 4.1, 5.0, 5.4, 5.6),
    "kolchin2007": (12.9, 4.1, 5.0, 5.4, 5.6),
    "first order, F_t inside": (15.6, 2.6, 0.67, 0.17, 0.03),
    "monge-patch": (5.3, 0.52, 0.06, 0.01, 0.0),
    "penner2011": (7.9, 3.6, 5.0, 5.4, 5.6),
    "curvature-lut": (1.5, 0.19, 0.13, 0.15, 0.19),
}


@pytest.mark.parametrize("ratio", RATIOS)
def test_errors_on_the_sphere_are_the_known_ones(ratio: int) -> None:
    errors = model_errors(ratio)
    for model, row in KNOWN.items():
        known = row[RATIOS.index(ratio)]
        # Within a tenth, or half of the last digit known.
        assert errors[model] == pytest.approx(known, rel=0.1, abs=0.005), model


# Light that leaves the sphere over R_d <F_t>, at ENERGY_RATIOS.
KNOWN_ENERGY = {
    "kolchin2007": (1.38, 1.12, 1.02, 1.006, 1.002),
    "curvature-lut": (0.85, 0.97, 0.9985, 0.9999, 1.0),
}


@pytest.mark.parametrize("ratio", ENERGY_RATIOS)
def test_energies_on_the_sphere_are_the_known_ones(ratio: int) -> None:
    energies = model_energies(ratio)
    for model, row in KNOWN_ENERGY.items():
        # The known ones of c1 are without F_t, which adds up to 2 % where R = l_d.
        assert energies[model] == pytest.approx(row[ENERGY_RATIOS.index(ratio)], rel=0.025), model


@pytest.mark.parametrize("name", ["skin1", "marble"])
def test_it_equals_plain_numpy(name: str) -> None:
    surface = torus(3000)
    np.testing.assert_allclose(
        shade(*surface, name, LIGHTS, "curvature-lut"),
        numpy_shading.curvature_lut(*surface, name, LIGHTS),
        rtol=0.0,
        # The compiled logarithm is good to 5e-13, psi's slope and the sum of lights to order 1.
        atol=1e-11,
    )


def test_more_hinges_come_closer_to_the_true_sphere_when_it_is_large() -> None:
    cosines = np.linspace(0.0, 1.0, 201)
    light = [DirectionalLight((0.0, 0.0, 1.0))]
    flat = sphere(cosines, np.inf)
    truth = shade(*flat, "skin1", light, "lambert", fresnel="directional")
    errors = [
        np.abs(shade(*flat, "skin1", light, "curvature-lut", hinges=count) - truth).max()
        for count in (1, 2, 4, 8, 16)
    ]
    assert errors == sorted(errors, reverse=True)


@pytest.mark.parametrize("lights", [LIGHTS, [DirectionalLight((1.0, 0.2, 0.3), (0.0, 2.0, 0.0))]])
@pytest.mark.parametrize("area", ["curved", "flat"])
def test_channels_at_once_are_channels_one_by_one_to_the_last_bit(area: str, lights) -> None:
    mesh, curvatures = torus(1800)
    rng = np.random.default_rng(0)
    inputs = shading_inputs(mesh, curvatures, "skin1", lights)
    tilted = inputs.normals + 0.1 * rng.normal(size=(3, *inputs.normals.shape))
    tilted /= np.linalg.norm(tilted, axis=2, keepdims=True)
    shapes = inputs.shape * rng.uniform(0.5, 2.0, (3, len(inputs.shape), 1))
    none = np.zeros(shapes.shape[:2])
    seen = Detail(tilted, shapes, none, inputs.normals, np.ones(3), 1.0, inputs.normals)
    model = CurvatureLut(area=area)
    found = model.shade_detail(inputs, seen)
    assert found.max() > 0.0
    np.testing.assert_array_equal(found, ShadingModel.shade_detail(model, inputs, seen))
