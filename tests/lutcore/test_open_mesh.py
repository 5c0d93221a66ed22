"""Light that an open mesh does not hold."""

import numpy as np
import pytest

from lutcore import analytic
from lutcore.baking import bake
from lutcore.gather.exitance import exact
from lutcore.lights import DirectionalLight
from lutcore.mesh import TriangleMesh
from lutcore.open_mesh import beyond, light_lost
from lutcore.shading import shading_inputs
from tests.bumps import bare


def test_a_closed_mesh_loses_nothing() -> None:
    body = analytic.torus(500)
    inputs = shading_inputs(body.mesh, body.truth, "skin1", [])
    assert not light_lost(inputs).any()
    # Nor one whose triangles share no vertex.
    soup = TriangleMesh(
        body.mesh.vertices[body.mesh.faces].reshape(-1, 3),
        np.arange(body.mesh.faces.size).reshape(-1, 3),
    )
    assert not light_lost(shading_inputs(soup, bare(soup), "skin1", [])).any()


def test_half_of_the_light_comes_from_either_side() -> None:
    table = bake("marble")
    assert beyond(table, np.zeros(1))[0] == pytest.approx(0.5, abs=1e-6)
    assert beyond(table, np.array([1e6]))[0] == 0.0
    assert np.all(np.diff(beyond(table, np.linspace(0.0, 50.0, 200))) <= 1e-12)


def test_it_is_what_a_sheet_loses_at_its_border() -> None:
    side, count = 60.0, 61
    x, y = np.meshgrid(np.linspace(0.0, side, count), np.linspace(0.0, side, count), indexing="ij")
    points = np.stack([x, y, 0.0 * x], axis=-1).reshape(-1, 3)
    at = np.arange(count * count).reshape(count, count)
    a, b, c, d = (one.ravel() for one in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    mesh = TriangleMesh(points, faces)
    inputs = shading_inputs(mesh, bare(mesh), "skin1", [DirectionalLight((0.0, 0.0, 1.0))])
    middle = at[: count // 2, count // 2]  # from the border at x = 0 to the middle
    lit = exact(inputs, points[middle])
    # Of the channel that reaches farthest; the other borders are 30 mm away.
    missing = 1.0 - lit[:, 0] / lit[-1, 0]
    np.testing.assert_allclose(light_lost(inputs)[middle], missing, atol=2e-3)
