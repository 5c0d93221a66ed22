import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lutcore.analytic import torus
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
