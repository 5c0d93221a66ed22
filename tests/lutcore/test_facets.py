"""What the facets around a vertex tell, against closed forms."""

import numpy as np
import pytest

from lutcore import analytic
from lutcore.facets import facets
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
