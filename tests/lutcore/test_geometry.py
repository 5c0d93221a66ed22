import numba
import numpy as np
import pytest

from lutcore.analytic import sphere, torus
from lutcore.geometry import (
    area_normals,
    face_areas,
    face_normals,
    median_vertex_area,
    vertex_areas,
    vertex_corners,
    vertex_normals,
)
from lutcore.mesh import TriangleMesh

SQUARE = TriangleMesh([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]], [[0, 1, 2], [0, 2, 3]])


def test_corners_are_those_of_the_faces_in_ascending_order():
    mesh = torus(300, irregular=True).mesh
    start, corner = vertex_corners(mesh)
    for vertex in range(len(mesh.vertices)):
        expected = np.flatnonzero(mesh.faces.ravel() == vertex)
        assert np.array_equal(corner[start[vertex] : start[vertex + 1]], expected)


def test_corners_do_not_depend_on_the_number_of_threads():
    mesh = torus(500).mesh
    many = vertex_corners(mesh)
    before = numba.get_num_threads()
    numba.set_num_threads(1)
    try:
        one = vertex_corners(mesh)
    finally:
        numba.set_num_threads(before)
    assert np.array_equal(many.corner, one.corner)


def test_areas_and_normals_of_a_square():
    assert np.allclose(face_areas(SQUARE), 2.0)
    assert np.allclose(face_normals(SQUARE), [0.0, 0.0, 1.0])
    areas = vertex_areas(SQUARE, vertex_corners(SQUARE))
    assert np.allclose(areas, np.array([4.0, 2.0, 4.0, 2.0]) / 3.0)
    assert np.isclose(median_vertex_area(areas), 1.0)


def test_vertex_areas_add_up_to_the_surface():
    mesh = torus(20_000).mesh
    total = vertex_areas(mesh, vertex_corners(mesh)).sum()
    # A mesh of edge h inscribed in radius r lacks a share of order (h/r)^2/6, h^2 = area/10,000.
    assert np.isclose(total, 4.0 * np.pi**2 * 0.35, rtol=0.003)


@pytest.mark.parametrize("irregular", [False, True])
def test_max_normals_are_exact_on_a_sphere(irregular):
    exact = sphere(500, irregular)
    normals = vertex_normals(exact.mesh, vertex_corners(exact.mesh))
    # Rounding over the sine of the thinnest corner, some 1e-4 in random points.
    assert np.abs(normals - exact.truth.normals).max() < 1e-10


def test_area_normals_bear_noise_on_random_triangles_better_than_max_normals():
    exact = torus(5_000, irregular=True)
    mesh = exact.noisy(0.02)
    corners = vertex_corners(mesh)
    tilt = [
        np.square(normals(mesh, corners) - exact.truth.normals).mean()
        for normals in (area_normals, vertex_normals)
    ]
    # Weights of e^-2 pass on the noise of the shortest edges undiminished.
    assert tilt[0] < 0.5 * tilt[1]


def test_a_vertex_between_cancelling_faces_still_has_a_unit_normal():
    sheet = TriangleMesh(np.eye(3), [[0, 1, 2], [0, 2, 1]])
    for normals in (area_normals, vertex_normals):
        lengths = np.linalg.norm(normals(sheet, vertex_corners(sheet)), axis=1)
        assert np.allclose(lengths, 1.0)


def test_an_unreferenced_vertex_has_a_zero_normal_and_no_area():
    mesh = TriangleMesh(np.vstack([SQUARE.vertices, [[9, 9, 9]]]), SQUARE.faces)
    corners = vertex_corners(mesh)
    assert not vertex_normals(mesh, corners)[4].any()
    assert vertex_areas(mesh, corners)[4] == 0.0
