import numpy as np
import pytest

from app.loading.errors import BadContentError
from app.loading.polygons import triangulated


def areas(vertices, faces):
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    return 0.5 * np.cross(b - a, c - a)


def split(points, *polygons):
    vertices = np.column_stack((np.array(points, float), np.zeros(len(points))))
    corners = np.concatenate([np.array(polygon) for polygon in polygons])
    warnings = []
    faces = triangulated(vertices, corners, np.array(list(map(len, polygons))), warnings)
    return vertices, faces, warnings


@pytest.mark.parametrize("turn", range(4))
def test_a_concave_quad_is_split_inside_though_the_other_diagonal_is_shorter(turn):
    points = np.array([(-0.1, 0.0), (0.0, 1.0), (0.1, 0.0), (0.0, 10.0)])
    vertices, faces, _ = split(points, np.roll(np.arange(4), turn))
    # Every piece turns the same way and they sum to the polygon's area, .9 by the shoelace formula.
    signed = areas(vertices, faces)[:, 2]
    assert (signed > 0).all()
    assert signed.sum() == pytest.approx(0.9, rel=1e-12)


def test_a_convex_quad_is_split_along_its_shorter_diagonal():
    _, faces, _ = split([(0, 0), (2, 0), (3, 1), (1, 1)], [0, 1, 2, 3])
    assert faces.tolist() == [[1, 2, 3], [1, 3, 0]]


def star(points):
    angle = np.linspace(0, 2 * np.pi, 2 * points, endpoint=False)
    radius = np.where(np.arange(2 * points) % 2, 1.0, 3.0)
    return np.column_stack((radius * np.cos(angle), radius * np.sin(angle)))


@pytest.mark.parametrize("points", [3, 5, 40])
def test_a_star_is_covered_once(points):
    outline = star(points)
    vertices, faces, warnings = split(outline, np.arange(2 * points))
    signed = areas(vertices, faces)[:, 2]
    assert len(faces) == 2 * points - 2
    assert (signed > 0).all()
    # 2n triangles of sides 3 and 1 about the centre.
    assert signed.sum() == pytest.approx(2 * points * 1.5 * np.sin(np.pi / points), rel=1e-12)
    assert warnings == []


def test_faces_come_in_the_order_of_their_polygons():
    points = [*star(3), (9, 0), (9, 1)]
    _, faces, _ = split(points, range(6), [0, 6, 7], [0, 6, 7, 1], range(6))
    assert faces[4].tolist() == [0, 6, 7]
    assert set(faces[5:7].ravel()) == {0, 1, 6, 7}
    assert set(faces[7:].ravel()) == set(range(6))


def test_a_polygon_without_area_becomes_a_fan_aloud():
    _, faces, warnings = split([(0, 0)] * 6, range(6), range(5))
    assert len(faces) == 4 + 3
    assert faces[0].tolist() == [0, 1, 2]
    assert "2 polygons" in warnings[0]


def test_a_polygon_that_would_take_minutes_is_refused():
    count = 200_000
    with pytest.raises(BadContentError, match="200000 corners"):
        triangulated(np.zeros((count, 3)), np.arange(count), np.array([count]), [])


@pytest.mark.parametrize("seed", range(20))
def test_any_polygons_give_two_triangles_less_than_corners(seed):
    random = np.random.default_rng(seed)
    counts = random.integers(3, 12, 50)
    corners = random.integers(0, 30, counts.sum())
    vertices = random.normal(size=(30, 3)).round(int(random.integers(0, 4)))
    faces = triangulated(vertices, corners, counts, [])
    assert len(faces) == (counts - 2).sum()
    assert faces.min() >= 0
    assert faces.max() < 30
