import dataclasses

import numpy as np
import pytest

from lutcore.health import inspect
from lutcore.mesh import TriangleMesh

# A tetrahedron with edges of 20 to 28 mm, faces outward.
CORNERS = np.array([[0, 0, 0], [20, 0, 0], [0, 20, 0], [0, 0, 20]], dtype=float)
SIDES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])

SOUND = {
    "islands": 1,
    "boundary_edges": 0,
    "boundary_loops": 0,
    "nonmanifold_edges": 0,
    "nonmanifold_vertices": 0,
    "duplicate_faces": 0,
    "flipped_edges": 0,
    "inside_out_islands": 0,
    "unreferenced_vertices": 0,
    "coincident_vertices": 0,
    "zero_area_faces": 0,
}


def check(vertices, faces, **odd):
    """Check every count: those given, and that all others are sound."""
    health = inspect(TriangleMesh(vertices, faces))
    assert {name: getattr(health, name) for name in SOUND} == SOUND | odd
    return health


def two(shift):
    """Return two tetrahedra, the second moved by `shift`."""
    return np.concatenate((CORNERS, CORNERS + shift)), np.concatenate((SIDES, SIDES + 4))


def test_a_sound_mesh_has_no_remarks():
    health = check(CORNERS, SIDES)
    assert health.watertight
    assert health.remarks() == []
    assert (health.vertices, health.faces, health.island_faces) == (4, 4, (4,))
    assert health.diagonal == pytest.approx(np.sqrt(1200.0))
    # Three edges of 20 and three of 20 sqrt(2).
    assert health.typical_edge == pytest.approx(10 + 10 * np.sqrt(2))


def test_a_missing_face_leaves_one_loop_of_three_edges():
    health = check(CORNERS, SIDES[1:], boundary_edges=3, boundary_loops=1)
    assert not health.watertight
    assert "boundary edges: 3, holes and outlines made of them: 1 " in health.remarks()[0]


def test_islands_are_listed_by_size():
    vertices, faces = two([50, 0, 0])
    health = check(vertices, faces[:-1], islands=2, boundary_edges=3, boundary_loops=1)
    assert health.island_faces == (4, 3)
    assert "separate parts: 2 (faces: 4, 3)" in health.remarks()[0]


def test_only_ten_islands_are_listed():
    vertices = np.concatenate([CORNERS + np.array([50 * i, 0, 0]) for i in range(12)])
    health = check(vertices, np.concatenate([SIDES + 4 * i for i in range(12)]), islands=12)
    assert health.island_faces == (4,) * 10
    assert health.remarks()[0].endswith("4, ...)")


def test_an_inside_out_part_is_told_from_a_flipped_face():
    vertices, faces = two([50, 0, 0])
    faces[4:] = faces[4:, ::-1]
    health = check(vertices, faces, islands=2, inside_out_islands=1)
    assert "inside out: 1 " in health.remarks()[1]
    one_turned = SIDES.copy()
    one_turned[2] = one_turned[2, ::-1]
    health = check(CORNERS, one_turned, flipped_edges=3)
    assert not health.watertight
    assert "edges between faces oriented against each other: 3 " in health.remarks()[0]


@pytest.mark.parametrize("far", [0.0, 1e6])
def test_inside_out_is_seen_far_from_the_origin(far):
    check(CORNERS + far, SIDES[:, ::-1], inside_out_islands=1)
    check(CORNERS + far, SIDES)


def test_two_solids_that_touch_in_a_point():
    vertices, faces = two([20, 0, 0])
    # Vertex 4 lies on vertex 1.
    check(vertices, faces, islands=1, nonmanifold_vertices=1, coincident_vertices=1)
    faces[faces == 4] = 1
    check(vertices, faces, islands=1, nonmanifold_vertices=1, unreferenced_vertices=1)


def test_three_faces_on_one_edge():
    vertices = np.array([[0, 0, 0], [9, 0, 0], [0, 9, 0], [0, 0, 9], [0, -9, 0]], dtype=float)
    faces = [[0, 1, 2], [1, 0, 3], [0, 1, 4]]
    check(vertices, faces, nonmanifold_edges=1, boundary_edges=6, boundary_loops=1)


def test_soup_counts_as_the_surface_that_it_makes():
    health = check(
        CORNERS[SIDES].reshape(-1, 3), np.arange(12).reshape(4, 3), coincident_vertices=8
    )
    assert health.watertight
    assert "vertices in the place of another: 8 " in health.remarks()[0]


def test_unreferenced_vertices():
    health = check(np.concatenate((CORNERS, [[900, 900, 900]])), SIDES, unreferenced_vertices=1)
    # A vertex without a face is no part of the surface's box.
    assert health.diagonal == pytest.approx(np.sqrt(1200.0))


def test_zero_area_and_duplicate_faces():
    faces = np.concatenate((SIDES, [[0, 0, 1], [1, 2, 2]]))
    assert "faces without area: 2" in check(CORNERS, faces, zero_area_faces=2).remarks()[0]
    # The same three corners in another order, and turned over.
    faces = np.concatenate((SIDES, [[2, 1, 0], [2, 0, 1]]))
    check(CORNERS, faces, duplicate_faces=2, nonmanifold_edges=3)


def test_nothing_but_zero_area():
    health = check([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]], zero_area_faces=1, islands=0)
    assert not health.watertight


@pytest.mark.parametrize(
    ("scale", "guess"), [(0.001, "metres or inches"), (1.0, None), (100.0, None), (1e3, "micro")]
)
def test_suspicious_units_are_named(scale, guess):
    remarks = check(CORNERS * scale, SIDES).remarks()
    if guess is None:
        assert remarks == []
    else:
        assert guess in remarks[0]
        assert "millimetres per unit" in remarks[0]


@pytest.mark.parametrize(("far", "count"), [(1e3, 0), (1e6, 0), (1e8, 1)])
def test_a_place_that_float32_cannot_resolve_is_named(far, count):
    # float32 steps at 1e6 are 1/16, at 1e8 they are 8; the edges are about 24.
    health = check(CORNERS + far, SIDES)
    assert len(health.remarks()) == count
    assert health.float32_step == np.spacing(np.float32(far + 20))


def test_the_counts_are_plain_numbers():
    health = inspect(TriangleMesh(CORNERS, SIDES))
    for value in dataclasses.asdict(health).values():
        assert type(value) in (int, float, tuple)


@pytest.mark.parametrize("seed", range(5))
def test_counts_do_not_depend_on_the_order_of_vertices_and_faces(seed):
    random = np.random.default_rng(seed)
    faces = random.integers(0, 30, (60, 3))
    vertices = random.normal(size=(30, 3)) * 30
    order = random.permutation(30)
    shuffled = np.argsort(order)[faces][random.permutation(60)]
    health = inspect(TriangleMesh(vertices, faces))
    again = inspect(TriangleMesh(vertices[order], np.roll(shuffled, 1, axis=1)))
    for name in SOUND:
        assert getattr(health, name) == getattr(again, name)


@pytest.mark.parametrize("seed", range(3))
def test_nonmanifold_vertices_agree_with_walking_the_fans(seed):
    random = np.random.default_rng(seed)
    faces = np.array([random.choice(15, 3, replace=False) for _ in range(20)])
    vertices = random.normal(size=(15, 3)) * 30
    expected = 0
    for vertex in np.unique(faces):
        ring = [set(face) - {vertex} for face in faces.tolist() if vertex in face]
        fan = ring.pop()
        while joined := [edge for edge in ring if edge & fan]:
            fan |= joined[0]
            ring.remove(joined[0])
        expected += bool(ring)
    assert inspect(TriangleMesh(vertices, faces)).nonmanifold_vertices == expected
