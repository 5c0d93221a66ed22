"""What the facets around a vertex tell, against closed forms."""

import numpy as np
import pytest

from lutcore import analytic
from lutcore.facets import facets, in_frames
from lutcore.geometry import area_normals, vertex_areas, vertex_corners
from lutcore.mesh import TriangleMesh


def sheet(count: int) -> TriangleMesh:
    """Return a flat square of count^2 vertices, cut along one diagonal of each cell."""
    x, y = (grid.ravel() for grid in np.meshgrid(*2 * [np.linspace(0.0, 1.0, count)]))
    cell = np.arange(count * count).reshape(count, count)
    a, b, c, d = (
        part.ravel() for part in (cell[:-1, :-1], cell[:-1, 1:], cell[1:, 1:], cell[1:, :-1])
    )
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return TriangleMesh(np.stack([x, y, 0.0 * x], axis=1), faces)


@pytest.mark.parametrize(
    ("body", "characteristic"),
    [(analytic.sphere(700, irregular=True), 2.0), (analytic.torus(900, major=3.0, minor=1.0), 0.0)],
)
def test_angles_that_lack_add_up_to_the_characteristic(
    body: analytic.Exact, characteristic: float
) -> None:
    mesh = body.noisy(0.1)
    found = facets(mesh.vertices, mesh.faces, np.zeros(len(mesh.vertices)))
    assert found.corner.sum() == pytest.approx(characteristic, abs=1e-9)  # Gauss and Bonnet


def test_smooth_bodies_lack_their_gaussian_curvature() -> None:
    body = analytic.ellipsoid(4000, axes=(2.0, 1.5, 1.0))
    found = facets(body.mesh.vertices, body.mesh.faces, np.zeros(4000))
    expected = body.truth.k1 * body.truth.k2 * found.area / (2.0 * np.pi)
    assert np.median(np.abs(found.corner / expected - 1.0)) < 0.1


def test_plane_is_smooth_and_lacks_nothing_at_its_border() -> None:
    mesh = sheet(9)
    field = mesh.vertices @ np.array([2.0, -3.0, 0.0])
    found = facets(mesh.vertices, mesh.faces, field)
    np.testing.assert_allclose(found.slope, np.tile([2.0, -3.0, 0.0], (81, 1)), atol=1e-12)
    np.testing.assert_allclose(found.corner, 0.0, atol=1e-12)
    np.testing.assert_allclose(found.grain, 0.0, atol=1e-12)
    assert found.area.sum() == pytest.approx(1.0)
    assert np.isinf(found.radius)


def test_sides_are_those_of_the_facets() -> None:
    mesh = sheet(9)
    found = facets(mesh.vertices, mesh.faces, np.zeros(81))
    # Every triangle has a side along x, one along y and one along both, an eighth each.
    expected = np.array([2.0, 1.0, 0.0, 2.0, 0.0, 0.0]) / 3.0 / 64.0
    np.testing.assert_allclose(found.sides, np.tile(expected, (81, 1)), atol=1e-15)
    turned = np.tile([[0.0, 1.0, 0.0], [0.6, 0.0, 0.8]], (81, 1, 1))
    in_plane = np.array([2.0, 0.6, 2.0 * 0.36]) / 3.0 / 64.0
    np.testing.assert_allclose(
        in_frames(found.sides, turned), np.tile(in_plane, (81, 1)), atol=1e-15
    )


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (analytic.sphere(4000, radius=3.0), 3.0),
        (analytic.torus(4000, major=3.0, minor=1.0), 1.5),
        (analytic.cylinder(4000, radius=2.0, length=10.0), 3.0),  # open at both ends
    ],
)
def test_radius_is_thrice_volume_over_area(body: analytic.Exact, expected: float) -> None:
    turn = np.linalg.qr(np.random.default_rng(0).standard_normal((3, 3)))[0]
    turn *= np.linalg.det(turn)
    points = body.mesh.vertices @ turn.T + np.array([5.0, -3.0, 2.0])
    found = facets(points, body.mesh.faces, np.zeros(len(points)))
    assert found.radius == pytest.approx(expected, rel=0.01)


def test_normals_and_areas_are_those_of_the_mesh() -> None:
    mesh = analytic.torus(900, irregular=True, major=3.0, minor=1.0).noisy(0.2)
    corners = vertex_corners(mesh)
    found = facets(mesh.vertices, mesh.faces, np.zeros(len(mesh.vertices)))
    np.testing.assert_allclose(found.bare, area_normals(mesh, corners), atol=1e-12)
    np.testing.assert_allclose(found.area, vertex_areas(mesh, corners), rtol=1e-12)
    assert np.all(found.grain > 0.0)


def test_loose_vertices_and_flat_faces_tell_nothing() -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [5, 5, 5]])
    found = facets(points, np.array([[0, 1, 2]], dtype=np.int32), np.arange(4.0))
    for each in found[:-1]:
        assert not np.any(each)
