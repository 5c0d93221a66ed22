import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lutcore.analytic import sphere, torus
from lutcore.estimation import principal_curvatures
from lutcore.mesh import TriangleMesh
from lutcore.weld import weld

TRIANGLE = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]


def soup(mesh):
    faces = np.arange(3 * len(mesh.faces)).reshape(-1, 3)
    return TriangleMesh(mesh.vertices[mesh.faces.ravel()], faces)


def test_a_clean_mesh_keeps_its_numbering_and_is_centred():
    mesh = torus(500).mesh
    welded = weld(TriangleMesh(mesh.vertices + [7.0, -3.0, 2.0], mesh.faces))
    assert np.array_equal(welded.index, np.arange(len(mesh.vertices)))
    assert np.array_equal(welded.mesh.faces, mesh.faces)
    assert np.allclose(welded.mesh.vertices.max(axis=0), -welded.mesh.vertices.min(axis=0))


def test_soup_is_joined_to_the_mesh_it_came_from():
    mesh = torus(500, irregular=True).mesh
    welded = weld(soup(mesh))
    assert len(welded.mesh.vertices) == len(mesh.vertices)
    values = np.arange(len(mesh.vertices), dtype=float)
    places = welded.mesh.vertices[:, 0]
    assert np.allclose(
        welded.spread(places, 0.0) - welded.spread(places, 0.0)[0],
        mesh.vertices[mesh.faces.ravel(), 0] - mesh.vertices[mesh.faces[0, 0], 0],
    )
    assert len(np.unique(welded.spread(values, -1.0))) == len(mesh.vertices)


def test_minus_zero_is_zero():
    points = [*TRIANGLE, [1.0, -0.0, -0.0], [1.0, 1.0, 0.0]]
    assert len(weld(TriangleMesh(points, [[0, 1, 2], [3, 4, 2]])).mesh.vertices) == 4


def test_near_vertices_are_not_joined():
    points = [*TRIANGLE, [1.0, 1e-15, 0.0], [1.0, 1.0, 0.0]]
    assert len(weld(TriangleMesh(points, [[0, 1, 2], [3, 4, 2]])).mesh.vertices) == 5


def test_faces_without_area_are_dropped_and_their_vertices_marked():
    points = [*TRIANGLE, [5.0, 5.0, 5.0], [6.0, 6.0, 6.0], [7.0, 7.0, 7.0]]
    welded = weld(TriangleMesh(points, [[0, 1, 2], [3, 4, 5], [0, 0, 1]]))
    assert len(welded.mesh.faces) == 1
    assert np.array_equal(welded.index, [0, 1, 2, -1, -1, -1])
    assert np.array_equal(
        welded.spread(np.array([1.0, 2.0, 3.0]), np.inf), [1, 2, 3, *[np.inf] * 3]
    )


def test_a_mesh_of_flat_faces_only_has_nothing_left():
    welded = weld(TriangleMesh([[0, 0, 0], [1, 1, 1], [2, 2, 2]], [[0, 1, 2]]))
    assert welded.mesh is None
    assert np.array_equal(welded.index, [-1, -1, -1])


def small_beside_large(times):
    """Return a ball of radius 1 and one smaller by `times`, far from the middle of both."""
    ball = sphere(300).mesh
    points = np.concatenate([ball.vertices, ball.vertices / times + [0.5, 3.0, 0.3]])
    return TriangleMesh(points, np.concatenate([ball.faces, ball.faces + len(ball.vertices)]))


@pytest.mark.parametrize("times", [1e13, 1e14, 1e15, 3e15, 1e16, 1e17])
def test_what_is_lost_in_rounding_beside_the_rest_is_dropped(times):
    mesh = small_beside_large(times)
    welded = weld(mesh)
    count = len(mesh.vertices) // 2
    assert np.all(welded.index[:count] >= 0)
    ready = welded.mesh
    assert len(ready.faces) >= len(mesh.faces) // 2
    a, b, c = np.moveaxis(ready.vertices[ready.faces], 1, 0)
    assert np.all(np.linalg.norm(np.cross(b - a, c - a), axis=1) > 0.0)
    there = welded.index >= 0
    shift = mesh.vertices[there] - ready.vertices[welded.index[there]]
    assert np.ptp(shift, axis=0).max() < 1e-15
    found = principal_curvatures(mesh, "rusinkiewicz2004")
    assert np.all(np.isfinite(found.k1)) and np.all(np.isfinite(found.k2))
    assert np.all(np.abs(found.k1[:count] - 1.0) < 0.1)


@pytest.mark.parametrize("radius", [1e-150, 1e-200, 1e150])
def test_a_unit_of_any_size_leaves_the_area(radius):
    ball = sphere(300).mesh
    mesh = TriangleMesh(radius * ball.vertices, ball.faces)
    assert len(weld(mesh).mesh.faces) == len(ball.faces)
    found = principal_curvatures(mesh, "rusinkiewicz2004")
    truth = principal_curvatures(ball, "rusinkiewicz2004")
    # On a sphere k1 - k2 is the root of a difference of rounded numbers.
    assert np.allclose(found.k1 * radius, truth.k1, rtol=10.0 * np.sqrt(np.finfo(float).eps))


@settings(deadline=None, max_examples=50)
@given(st.lists(st.tuples(*[st.integers(-1, 1)] * 3), min_size=3, max_size=40))
def test_every_vertex_is_led_to_its_own_position(points):
    vertices = np.array(points, dtype=float)
    count = len(vertices)
    faces = np.stack([np.arange(count), np.arange(1, count + 1), np.arange(2, count + 2)], axis=1)
    mesh = TriangleMesh(vertices, faces % count)
    welded = weld(mesh)
    if welded.mesh is None:
        return
    there = welded.index >= 0
    shift = vertices[there] - welded.mesh.vertices[welded.index[there]]
    assert np.array_equal(shift, np.broadcast_to(shift[0], shift.shape))
    assert len(np.unique(welded.mesh.vertices, axis=0)) == len(welded.mesh.vertices)
