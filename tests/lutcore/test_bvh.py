import numpy as np
import pytest

from lutcore import analytic
from lutcore.bvh import any_hit, bvh
from lutcore.errors import ParameterError
from lutcore.mesh import TriangleMesh


def by_brute_force(mesh, origins, directions, far=np.inf):
    """Möller-Trumbore against every triangle."""
    a, b, c = (mesh.vertices[mesh.faces[:, j]] for j in range(3))
    u, v = b - a, c - a
    hits = []
    for origin, direction in zip(origins, directions, strict=True):
        p = np.cross(direction, v)
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = 1.0 / (u * p).sum(axis=1)
            s = origin - a
            q = np.cross(s, u)
            first, second = (s * p).sum(axis=1) * inverse, (q @ direction) * inverse
            t = (v * q).sum(axis=1) * inverse
            inside = (first >= 0.0) & (second >= 0.0) & (first + second <= 1.0)
            hits.append(bool((inside & (t > 0.0) & (t < far)).any()))
    return np.array(hits)


def soup(generator, count, size=0.3):
    middles = generator.normal(size=(count, 1, 3))
    corners = middles + size * generator.normal(size=(count, 3, 3))
    return TriangleMesh(corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))


@pytest.mark.parametrize("far", [np.inf, 0.7])
@pytest.mark.parametrize("count", [1, 5, 300])
def test_rays_meet_what_brute_force_finds(count, far):
    generator = np.random.default_rng(count)
    mesh = soup(generator, count)
    origins, directions = generator.normal(size=(2, 400, 3))
    directions[:90][generator.random((90, 3)) < 0.4] = 0.0  # along planes and axes
    directions[(directions == 0.0).all(axis=1)] = (0.0, 0.0, 1.0)
    hit = any_hit(bvh(mesh), origins, directions, far)
    np.testing.assert_array_equal(hit, by_brute_force(mesh, origins, directions, far))
    assert count < 300 or 0.1 < hit.mean() < 0.9


def test_no_ray_slips_through_an_edge_or_a_corner():
    mesh = analytic.sphere(500, irregular=True, radius=3.0).mesh
    corners = mesh.vertices[mesh.faces]
    shares = np.random.default_rng(0).random((len(corners), 3, 1))
    on_edges = corners + shares * (np.roll(corners, 1, axis=1) - corners)
    middles = 0.5 * (corners + np.roll(corners, 1, axis=1))
    targets = np.concatenate([mesh.vertices, on_edges.reshape(-1, 3), middles.reshape(-1, 3)])
    inside = np.broadcast_to([0.3, -0.2, 0.1], targets.shape)
    assert any_hit(bvh(mesh), inside, targets - inside).all()
    # Just before the surface nothing is met, just beyond it is.
    assert not any_hit(bvh(mesh), inside, targets - inside, 1.0 - 1e-9).any()
    assert any_hit(bvh(mesh), inside, targets - inside, 1.0 + 1e-9).all()


def test_triangles_without_an_area_are_never_met():
    points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    mesh = TriangleMesh(points, [[0, 1, 2], [0, 0, 1], [3, 3, 3]])
    along = np.array([[1.5, 0.0, 1.0], [0.0, 1.0, 1.0], [-1.0, 0.0, 0.0]])
    down = np.array([[0.0, 0.0, -1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])
    assert not any_hit(bvh(mesh), along, down).any()


def test_triangles_all_in_one_place_make_a_tree_that_ends():
    mesh = TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.tile([[0, 1, 2]], (3000, 1)))
    tree = bvh(mesh)
    assert len(tree.skip) < 3000
    assert any_hit(tree, np.array([[0.2, 0.2, 1.0]]), np.array([[0.0, 0.0, -1.0]]))[0]


def test_sizes_that_shrink_without_end_do_not_exhaust_the_stack():
    # Each triangle is half the last: every split by area takes one off.
    scale = 0.5 ** np.arange(900.0)
    corners = scale[:, None, None] * np.array([[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0]])
    mesh = TriangleMesh(corners.reshape(-1, 3), np.arange(2700).reshape(-1, 3))
    tree = bvh(mesh)
    assert np.sort(tree.triangle).tolist() == list(range(900))
    assert any_hit(tree, np.array([[1.2, 0.1, 1.0]]), np.array([[0.0, 0.0, -1.0]]))[0]


@pytest.mark.parametrize(
    ("origins", "directions"),
    [
        ([[0.0, 0.0, np.nan]], [[0.0, 0.0, 1.0]]),
        ([[0.0, 0.0, 0.0]], [[0.0, 0.0, 0.0]]),
        ([[0.0, 0.0, 0.0]], [[np.inf, 0.0, 0.0]]),
        ([0.0, 0.0, 0.0], [[1.0, 0.0, 0.0]]),
    ],
)
def test_rays_that_are_none_are_refused(origins, directions):
    tree = bvh(soup(np.random.default_rng(0), 3))
    with pytest.raises(ParameterError):
        any_hit(tree, origins, directions)
