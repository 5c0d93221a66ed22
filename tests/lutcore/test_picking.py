"""The first triangle along a line of sight, against the plain formula and known bodies."""

import numpy as np
import pytest

from lutcore.mesh import TriangleMesh
from lutcore.picking import first_hit

OCTAHEDRON = TriangleMesh(
    [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]],
    [
        [0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4],
        [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5],
    ],
)  # fmt: skip


def test_the_nearer_of_two_sides_is_hit_where_the_line_meets_it() -> None:
    hit = first_hit(OCTAHEDRON, np.array([0.25, 0.125, 5.0]), np.array([0.0, 0.0, -2.0]))
    assert hit is not None
    assert hit.face == 0
    # On x + y + z = 1.
    np.testing.assert_allclose(hit.position, [0.25, 0.125, 0.625], atol=1e-15)
    corners = OCTAHEDRON.vertices[OCTAHEDRON.faces[0]]
    np.testing.assert_allclose(hit.weights @ corners, hit.position, atol=1e-15)


def test_a_line_beside_or_behind_meets_nothing() -> None:
    start = np.array([0.7, 0.7, 5.0])
    assert first_hit(OCTAHEDRON, start, np.array([0.0, 0.0, -1.0])) is None
    assert first_hit(OCTAHEDRON, np.array([0.1, 0.1, 5.0]), np.array([0.0, 0.0, 1.0])) is None


def test_a_surface_is_hit_from_behind_too() -> None:
    hit = first_hit(OCTAHEDRON, np.zeros(3), np.array([0.3, 0.2, 0.5]))
    assert hit is not None
    assert hit.position.sum() == pytest.approx(1.0)


def test_many_triangles_against_the_plain_formula() -> None:
    random = np.random.default_rng(3)
    vertices = random.normal(size=(30_000, 3))
    mesh = TriangleMesh(vertices, np.arange(30_000).reshape(-1, 3))
    a, b, c = vertices[mesh.faces].transpose(1, 0, 2)
    for _ in range(20):
        start, direction = random.normal(size=3) * 4.0, random.normal(size=3)
        # a + u (b - a) + v (c - a) = start + t direction
        matrix = np.stack([b - a, c - a, np.broadcast_to(-direction, a.shape)], axis=-1)
        u, v, t = np.linalg.solve(matrix, (start - a)[..., None])[..., 0].T
        met = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0)
        hit = first_hit(mesh, start, direction)
        if not met.any():
            assert hit is None
            continue
        assert hit is not None
        assert hit.face == np.where(met, t, np.inf).argmin()
