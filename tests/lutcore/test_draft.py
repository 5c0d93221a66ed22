"""Shading while a light is dragged, against the model that it stands in for."""

import numpy as np
import pytest

from lutcore.detail import detail_seen
from lutcore.exitance import exitance
from lutcore.lights import ConeLight, DirectionalLight, PointLight
from lutcore.mesh import TriangleMesh
from lutcore.shading import model_registry, shading_inputs
from plugins.shading.curvature_lut import CurvatureLut
from tests.surfaces import torus

LIGHTS = [
    DirectionalLight((1.0, 0.3, 0.5), (1.0, 0.9, 0.8)),
    PointLight((-60.0, 20.0, 40.0), (3000.0, 2000.0, 4000.0)),
    ConeLight((0.0, 0.0, 90.0), (0.0, 0.0, -1.0), 2000.0, 15.0),
]
# Of R_d of unit light: what the table leaves, and single precision.
NEARLY = 2e-3


def _inputs(material="skin1", lights=LIGHTS[:1], **more):
    mesh, curvatures = torus(3000)
    return shading_inputs(mesh, curvatures, material, lights, **more)


@pytest.mark.parametrize("material", ["skin1", "marble", "ketchup"])
@pytest.mark.parametrize("model", [CurvatureLut(), CurvatureLut(hinges=8, area="flat")])
def test_it_is_nearly_the_model(material, model) -> None:
    inputs = _inputs(material)
    found = model.draft(inputs).exitance(inputs.lights)
    assert found.dtype == np.float64
    np.testing.assert_allclose(found, exitance(model, inputs), rtol=0.0, atol=NEARLY)


def test_each_channel_sees_its_own_surface() -> None:
    mesh, _ = torus(3000)
    inputs = _inputs(detail=detail_seen(mesh, "skin1"))
    found = CurvatureLut().draft(inputs).exitance(inputs.lights)
    np.testing.assert_allclose(found, exitance(CurvatureLut(), inputs), rtol=0.0, atol=NEARLY)


def test_lights_of_all_kinds_are_added() -> None:
    inputs = _inputs(lights=LIGHTS)
    exact, found = exitance(CurvatureLut(), inputs), CurvatureLut().draft(inputs)
    most = NEARLY * exact.max()
    np.testing.assert_allclose(found.exitance(inputs.lights), exact, rtol=0.0, atol=most)
    np.testing.assert_array_equal(found.exitance(inputs.lights[:0]), 0.0)


def test_a_vertex_without_a_normal_is_dark() -> None:
    mesh, _ = torus(900)
    lonely = TriangleMesh(np.vstack([mesh.vertices, [[9.0, 9.0, 9.0]]]), mesh.faces)
    inputs = shading_inputs(lonely, None, "skin1", LIGHTS, detail=detail_seen(lonely, "skin1"))
    found = CurvatureLut().draft(inputs).exitance(inputs.lights)
    assert (found[-1] == 0.0).all() and found[:-1].any()


def test_other_models_have_no_such_way() -> None:
    assert model_registry.get("wrap")().draft(_inputs()) is None
