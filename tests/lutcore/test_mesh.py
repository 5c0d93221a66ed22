import numba
import numpy as np
import pytest

from lutcore.errors import MeshError
from lutcore.mesh import TriangleMesh

TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def test_a_mesh_keeps_a_checked_copy_that_nobody_can_change():
    vertices = np.array(TRIANGLE, dtype=np.float32)
    mesh = TriangleMesh(vertices, [[0, 1, 2]])
    vertices[:] = 9.0
    assert mesh.vertices.dtype == np.float64
    assert mesh.faces.dtype == np.int32
    assert mesh.vertices.max() == 1.0
    with pytest.raises(ValueError, match="read-only"):
        mesh.vertices[0, 0] = 2.0


def test_what_is_compiled_for_a_checked_mesh_serves_for_a_trusted_one():
    checked = TriangleMesh(TRIANGLE, [[0, 1, 2]])
    trusted = TriangleMesh.trusted(checked.vertices.copy(), checked.faces.copy())
    assert numba.typeof(trusted.vertices) == numba.typeof(checked.vertices)
    assert numba.typeof(trusted.faces) == numba.typeof(checked.faces)


@pytest.mark.parametrize(
    ("vertices", "faces", "said"),
    [
        (TRIANGLE, [], "no faces"),
        ([], [], "vertices have shape"),
        (TRIANGLE, [[0, 1]], "faces have shape"),
        (TRIANGLE, [[0, 1, 3]], r"face 0: \[0, 1, 3\] of 3 vertices"),
        (TRIANGLE, [[0, 1, -1]], "do not exist"),
        (TRIANGLE, [[0.0, 1.0, 2.0]], "whole numbers"),
        ([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]], "vertices have shape"),
        ([[0, 0, 0], [1, 0, np.nan], [0, 1, 0]], [[0, 1, 2]], "the first is vertex 1"),
        ([[0, 0, 0], [1, 0, np.inf], [0, 1, 0]], [[0, 1, 2]], "not finite"),
        ([["a", "b", "c"]] * 3, [[0, 1, 2]], "not numbers"),
        (TRIANGLE, [[0, 1, 2**40]], "do not exist"),
    ],
)
def test_what_is_no_mesh_is_refused_in_words(vertices, faces, said):
    with pytest.raises(MeshError, match=said):
        TriangleMesh(vertices, faces)


def test_the_diagonal_ignores_vertices_without_a_face():
    mesh = TriangleMesh([*TRIANGLE, [100, 100, 100]], [[0, 1, 2]])
    assert mesh.diagonal == pytest.approx(np.sqrt(2.0))


def test_unsigned_and_wide_indices_are_taken():
    for kind in (np.uint8, np.uint32, np.int64):
        assert TriangleMesh(TRIANGLE, np.array([[0, 1, 2]], dtype=kind)).faces.sum() == 3
