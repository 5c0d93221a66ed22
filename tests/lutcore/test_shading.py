"""The call that shades: its checks, and what it hands to a model."""

import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from lutcore.arrays import FloatArray
from lutcore.errors import ParameterError
from lutcore.lights import DirectionalLight
from lutcore.shading import (
    ShadingInputs,
    ShadingModel,
    bending,
    invariants,
    model_registry,
    shade,
    shading_models,
)
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
