"""The call that shades: its checks, and what it hands to a model."""

import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from lutcore.arrays import FloatArray
from lutcore.baking import bake
from lutcore.convexity import bending, invariants
from lutcore.diffusion import diffusion_profile
from lutcore.errors import ParameterError
from lutcore.exitance import shade
from lutcore.lights import DirectionalLight
from lutcore.progress import silent
from lutcore.shading import ShadingInputs, ShadingModel, model_registry, shading_models
from tests.surfaces import torus

LIGHT = DirectionalLight((1.0, 2.0, 3.0))
SEEN: list[ShadingInputs] = []


@dataclass(frozen=True)
class Spy(ShadingModel):
    """Keeps what it is given."""

    def shade(self, inputs: ShadingInputs) -> FloatArray:
        SEEN.append(inputs)
        return np.ones(inputs.points.shape)


@pytest.fixture
def spy(monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setitem(model_registry._loaded, "spy", Spy)
    SEEN.clear()
    return "spy"


def test_the_five_models_are_there() -> None:
    assert {"lambert", "wrap", "kolchin2007", "kolchin2007-simplified", "curvature-lut"} <= set(
        shading_models()
    )


def test_the_tensor_is_that_of_the_convex_curvatures(spy: str) -> None:
    mesh, curvatures = torus(500)
    shade(mesh, curvatures, "skin1", [LIGHT], spy, mm_per_unit=2.0)
    shape = SEEN[0].shape
    k1, k2 = np.maximum(curvatures.k1, 0.0) / 2.0, np.maximum(curvatures.k2, 0.0) / 2.0
    assert (curvatures.k2 < 0.0).any()
    tensor = np.einsum("n,ni,nj->nij", k1, curvatures.d1, curvatures.d1)
    tensor += np.einsum("n,ni,nj->nij", k2, curvatures.d2, curvatures.d2)
    order = ([0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2])
    np.testing.assert_allclose(shape, tensor[:, order[0], order[1]], atol=1e-15)
    for vertex in (0, 123, 480):
        trace, squares = invariants(shape, vertex)
        assert trace == pytest.approx(k1[vertex] + k2[vertex])
        assert squares == pytest.approx(k1[vertex] ** 2 + k2[vertex] ** 2)
        w = np.array([0.6, 0.0, 0.8])
        w1, w2 = curvatures.d1[vertex] @ w, curvatures.d2[vertex] @ w
        expected = np.hypot(w1 * k1[vertex], w2 * k2[vertex])
        assert bending(shape, vertex, *w) == pytest.approx(expected)


def test_the_curvatures_normals_are_used_without_a_copy(spy: str) -> None:
    mesh, curvatures = torus(200)
    shade(mesh, curvatures, "skin1", [LIGHT], spy)
    assert np.shares_memory(SEEN[0].normals, curvatures.normals)


def test_given_normals_replace_them_and_are_made_unit(spy: str) -> None:
    mesh, curvatures = torus(200)
    shade(mesh, curvatures, "skin1", [LIGHT], spy, normals=-3.0 * curvatures.normals)
    np.testing.assert_allclose(SEEN[0].normals, -curvatures.normals, atol=1e-15)


def test_a_vertex_without_a_normal_is_dark_whatever_the_model_says(spy: str) -> None:
    mesh, curvatures = torus(200)
    normals = curvatures.normals.copy()
    normals[[3, 77]] = 0.0
    shaded = shade(mesh, curvatures, "skin1", [LIGHT], spy, normals=normals)
    np.testing.assert_array_equal(np.flatnonzero(shaded.sum(axis=1) == 0.0), [3, 77])


def test_a_model_is_told_of_the_mesh_the_medium_and_the_progress(spy: str) -> None:
    mesh, curvatures = torus(200)
    profile = diffusion_profile("jensen2001")
    shade(mesh, curvatures, "skin1", [LIGHT], spy, 2.0, profile=profile, progress=silent)
    np.testing.assert_array_equal(SEEN[0].faces, mesh.faces)
    assert SEEN[0].mm_per_unit == 2.0
    assert SEEN[0].profile is profile
    assert SEEN[0].progress is silent
    assert SEEN[0].table is bake("skin1", profile=profile)


def test_a_local_model_shades_each_light_alone_where_shadows_are_cast(spy: str) -> None:
    mesh, curvatures = torus(200)
    shares = np.linspace(0.0, 1.0, 2 * len(mesh.vertices)).reshape(2, -1)
    shaded = shade(mesh, curvatures, "skin1", [LIGHT, LIGHT], spy, visibility=shares)
    assert [len(seen.lights) for seen in SEEN] == [1, 1]
    assert all(seen.visibility is None for seen in SEEN)
    np.testing.assert_allclose(shaded, np.repeat(shares.sum(axis=0)[:, None], 3, axis=1))


def test_a_model_that_is_not_local_gets_all_lights_and_their_visibility(
    spy: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Spy, "local", False)
    mesh, curvatures = torus(200)
    shares = np.zeros((2, len(mesh.vertices)))
    shade(mesh, curvatures, "skin1", [LIGHT, LIGHT], spy, visibility=shares)
    assert len(SEEN) == 1
    assert len(SEEN[0].lights) == 2
    np.testing.assert_array_equal(SEEN[0].visibility, shares)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"material": "skn1"}, "skin1"),
        ({"model": "lambrt"}, "lambert"),
        ({"model": "wrap", "widht": 0.1}, "width"),
        ({"model": "wrap", "width": 2.0}, "width"),
        ({"model": "curvature-lut", "hinges": 2.5}, "whole"),
        ({"model": "lambert", "fresnel": "none"}, "mean"),
        ({"mm_per_unit": 0.0}, "mm_per_unit"),
        ({"mm_per_unit": -1.0}, "mm_per_unit"),
        ({"mm_per_unit": np.nan}, "mm_per_unit"),
        ({"lights": ["sun"]}, "light"),
        ({"lights": LIGHT}, "sequence"),
        ({"normals": np.zeros((3, 3))}, "normals"),
        ({"profile": "jensen2002"}, "jensen2001"),
        ({"visibility": np.ones((1, 7))}, "visibility"),
        ({"visibility": np.full((1, 100), 1.5)}, "visibility"),
        ({"visibility": np.full((1, 100), np.nan)}, "visibility"),
    ],
)
def test_bad_arguments_are_refused(arguments: dict[str, Any], message: str) -> None:
    mesh, curvatures = torus(100)
    whole = {"material": "skin1", "lights": [LIGHT], **arguments}
    with pytest.raises(ParameterError, match=message):
        shade(mesh, curvatures, **whole)


@pytest.mark.parametrize("field", ["k1", "k2", "d1", "d2", "normals"])
def test_curvatures_of_another_mesh_or_not_finite_are_refused(field: str) -> None:
    mesh, curvatures = torus(100)
    values = getattr(curvatures, field)
    short = dataclasses.replace(curvatures, **{field: values[:-1]})
    with pytest.raises(ParameterError, match=field):
        shade(mesh, short, "skin1", [LIGHT])
    broken = values.copy()
    broken[4] = np.nan
    with pytest.raises(ParameterError, match=field):
        shade(mesh, dataclasses.replace(curvatures, **{field: broken}), "skin1", [LIGHT])
