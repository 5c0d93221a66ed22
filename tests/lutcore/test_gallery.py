"""The gallery's cases: the truth is true, the defect is there, and nothing else is."""

from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from lutcore.errors import ParameterError
from lutcore.gallery import catalogue
from lutcore.gallery.surfaces import egg
from lutcore.health import inspect
from lutcore.tiling import grid_cells

NAMES = catalogue.names()
RANDOM = {
    *("holes", "spike", "bow-tie", "double-sided", "debris", "flipped-some", "cracked-soup"),
    *("repeated-faces", "isolated", "random-order", "irregular", "slivers-8", "slivers-32"),
    *("correlated-noise", *(name for name in NAMES if name.startswith("resolution-"))),
    *(f"noise-{percent}" for percent in (1, 2, 5, 10, 20)),
}
MOVED = {
    *("spike", "correlated-noise", "far", "farther", "cracked-soup"),
    *(name for name in NAMES if name.startswith(("noise-", "resolution-"))),
}
"""Cases whose vertices are off the surface that they have the truth of."""


@cache
def case(name, seed=0):
    return catalogue.build(name, seed)


@cache
def health(name):
    return inspect(case(name).broken.mesh)


def torus(points, minor=0.35):
    around = np.hypot(points[:, 0], points[:, 1])
    assert_allclose((around - 1.0) ** 2 + points[:, 2] ** 2, minor**2, atol=1e-9)
    return np.full(len(points), 1.0 / minor), (around - 1.0) / (minor * around)


def ellipsoid(points, axes=(1.0, 0.7, 0.5)):
    """K and H by the textbook's formulas in the coordinates themselves."""
    a, b, c = axes
    steep = (points**2 / np.array(axes) ** 4).sum(axis=1)
    gauss = 1.0 / (a * b * c * steep) ** 2
    mean = (a**2 + b**2 + c**2 - (points**2).sum(axis=1)) / (2.0 * (a * b * c) ** 2 * steep**1.5)
    return pair(mean, gauss)


def sheet(kind):
    """K and H of a graph by the first and second fundamental forms."""

    def curvatures(points):
        x, y = points[:, 0], points[:, 1]
        one = np.ones_like(x)
        if kind == "monkey":
            p, q = 1.5 * (x**2 - y**2), -3.0 * x * y
            r, s, t = 3.0 * x, -3.0 * y, -3.0 * x
        else:
            bend = -1.0 if kind == "saddle" else 1.0
            p, q, r, s, t = -x, -bend * y, -one, 0.0 * one, -bend * one
        w = 1.0 + p**2 + q**2
        gauss = (r * t - s**2) / w**2
        mean = -((1.0 + q**2) * r - 2.0 * p * q * s + (1.0 + p**2) * t) / (2.0 * w**1.5)
        return pair(mean, gauss)

    return curvatures


def pair(mean, gauss):
    root = np.sqrt(np.maximum(mean**2 - gauss, 0.0))
    return mean + root, mean - root


def unit(points):
    return np.ones(len(points)), np.ones(len(points))


SURFACES = {
    "border": (unit, unit),
    "bow-tie": (unit, unit),
    "umbilic": (unit, ellipsoid),
    "patch": (sheet("saddle"), sheet("saddle")),
    "saddle": (sheet("saddle"), sheet("bowl")),
    "monkey-saddle": (sheet("monkey"), sheet("saddle")),
    "thin": (lambda points: torus(points, 0.05), torus),
    **dict.fromkeys((name for name in NAMES if "resolution" in name), (ellipsoid, ellipsoid)),
}
FACTORS = {"metres": 1e-3, "micrometres": 1e6}


@pytest.mark.parametrize("name", NAMES)
def test_the_truth_is_that_of_the_textbook(name):
    broken, sound = SURFACES.get(name, (torus, torus))
    made = case(name)
    judged = made.broken.judged
    factor = FACTORS.get(name, 1.0)
    k1, k2 = broken(at_rest(made)[judged] / factor)
    if name == "flipped-all":
        k1, k2 = -k2, -k1
    if name == "flipped-half":
        left = made.broken.mesh.vertices[judged, 0] < 0.0
        k1, k2 = np.where(left, -k2, k1), np.where(left, -k1, k2)
    # Where k1 = k2 the root in `pair` makes 1e-8 of rounding.
    assert_allclose(factor * made.broken.k1[judged], k1, atol=1e-6 * np.abs(k1).max())
    assert_allclose(factor * made.broken.k2[judged], k2, atol=1e-6 * np.abs(k1).max())
    if name == "correlated-noise":
        return  # its twin is noisy as well, with the same truth
    points = made.sound.mesh.vertices[made.sound.judged]
    if name == "bow-tie":
        return  # the spheres have other middles
    k1, k2 = sound(points)
    assert_allclose(made.sound.k1[made.sound.judged], k1, atol=1e-6 * np.abs(k1).max())
    assert_allclose(made.sound.k2[made.sound.judged], k2, atol=1e-6 * np.abs(k1).max())


def at_rest(made):
    """Positions on the surface itself."""
    points = made.broken.mesh.vertices
    if made.name not in MOVED:
        return points
    if made.name.startswith("resolution-"):
        return egg(len(points)).mesh.vertices
    return case("soup" if made.name == "cracked-soup" else "noise-0").broken.mesh.vertices


@pytest.mark.parametrize("name", NAMES)
def test_a_case_is_complete(name):
    made = case(name)
    assert made.title
    assert made.why.endswith(".")
    for subject in (made.broken, made.sound):
        count = len(subject.mesh.vertices)
        assert subject.k1.shape == subject.k2.shape == subject.judged.shape == (count,)
        assert (subject.k1 >= subject.k2).all()
        assert np.count_nonzero(subject.judged) > 40
        used = np.zeros(count, bool)
        used[subject.mesh.faces] = True
        assert used[subject.judged].all()


@pytest.mark.parametrize("name", NAMES)
def test_the_seed_decides(name):
    one, again, other = (catalogue.build(name, seed).broken for seed in (3, 3, 4))
    assert np.array_equal(one.mesh.vertices, again.mesh.vertices)
    assert np.array_equal(one.mesh.faces, again.mesh.faces)
    assert np.array_equal(one.judged, again.judged)
    same = np.array_equal(one.mesh.vertices, other.mesh.vertices) and np.array_equal(
        one.mesh.faces, other.mesh.faces
    )
    assert same != (name in RANDOM)


def test_a_case_that_does_not_exist_names_the_nearest():
    with pytest.raises(ParameterError, match="did you mean 'spike'"):
        catalogue.build("spikes")


def test_a_negative_seed_is_refused():
    with pytest.raises(ParameterError, match="seed"):
        catalogue.build("spike", -1)


# Everything that `inspect` can say of a mesh, by the number that each defect must show; what is
# not named is 0, so that no case has a second defect.
COUNTED = (
    *("boundary_loops", "nonmanifold_edges", "nonmanifold_vertices", "duplicate_faces"),
    *("flipped_edges", "inside_out_islands", "unreferenced_vertices", "coincident_vertices"),
    "zero_area_faces",
)
DEFECTS = {
    "border": {"boundary_loops": 1},
    "patch": {"boundary_loops": 1},
    "saddle": {"boundary_loops": 1},
    "monkey-saddle": {"boundary_loops": 1},
    "holes": {"boundary_loops": 40},
    "fin": {"boundary_loops": 1, "nonmanifold_edges": 19},
    "bow-tie": {"nonmanifold_vertices": 1},
    "debris": {"boundary_loops": 20},
    "flipped-all": {"inside_out_islands": 1},
    "soup": {"coincident_vertices": 23754 - 3959},
    "isolated": {"unreferenced_vertices": 198},
}
SEVERAL = {"double-sided", "flipped-half", "flipped-some", "cracked-soup", "repeated-faces"}


@pytest.mark.parametrize("name", [name for name in NAMES if name not in SEVERAL])
def test_a_mesh_has_the_defect_that_it_is_there_for_and_no_other(name):
    found = {count: getattr(health(name), count) for count in COUNTED}
    assert found == dict.fromkeys(COUNTED, 0) | DEFECTS.get(name, {})


@pytest.mark.parametrize("name", NAMES)
def test_the_sound_mesh_is_sound(name):
    found = inspect(case(name).sound.mesh)
    open_ = name in ("patch", "saddle", "monkey-saddle")
    expected = {"boundary_loops": 1} if open_ else {}
    counts = {count: getattr(found, count) for count in COUNTED}
    assert counts == dict.fromkeys(COUNTED, 0) | expected


def test_repeated_faces_are_repeated_or_empty():
    found = health("repeated-faces")
    twentieth = round(0.05 * len(case("noise-0").broken.mesh.faces))
    assert (found.duplicate_faces, found.zero_area_faces) == (twentieth, twentieth)
    assert found.vertices == len(case("noise-0").broken.mesh.vertices)


def test_a_doubled_patch_has_edges_of_four_faces():
    assert health("double-sided").nonmanifold_edges > 100
    assert health("double-sided").boundary_edges == 0


def test_flipped_faces_meet_others_the_wrong_way():
    assert health("flipped-some").flipped_edges > 1000
    assert 0 < health("flipped-half").flipped_edges < 200  # two seams around the tube


def test_cracked_soup_has_no_two_faces_that_meet():
    assert health("cracked-soup").islands == health("cracked-soup").faces
    whole = case("soup").broken.mesh.vertices
    apart = np.linalg.norm(case("cracked-soup").broken.mesh.vertices - whole, axis=1)
    assert apart.max() < 1e-5 * health("soup").typical_edge


def test_debris_is_forty_specks_that_touch_nothing():
    assert health("debris").islands == 41
    assert sorted(set(health("debris").island_faces[1:])) == [4]
    assert len(case("debris").broken.mesh.faces) == health("noise-0").faces + 20 * 4 + 20


def test_the_spike_is_one_vertex_four_edges_out():
    made = case("spike")
    moved = np.linalg.norm(made.broken.mesh.vertices - made.sound.mesh.vertices, axis=1)
    assert np.count_nonzero(moved) == 1
    assert moved.max() > 3.0 * health("noise-0").typical_edge
    assert not made.broken.judged[np.argmax(moved)]


def test_the_fin_stands_upright():
    made = case("fin")
    points, first = made.broken.mesh.vertices, len(made.sound.mesh.vertices)
    height = np.hypot(points[first:, 0], points[first:, 1]) - 1.35
    assert_allclose(height, 0.15, atol=1e-9)


def test_random_order_shuffles_all_and_loses_nothing():
    made = case("random-order")
    apart = np.abs(np.diff(made.broken.mesh.faces[:, :2].astype(int), axis=1))
    assert np.median(apart) > 500.0
    assert np.median(np.abs(np.diff(made.sound.mesh.faces[:, :2].astype(int), axis=1))) < 100.0
    corners = [np.sort(s.mesh.vertices[s.mesh.faces].sum(axis=1).ravel()) for s in twins(made)]
    assert_allclose(corners[0], corners[1], atol=1e-12)


def twins(made):
    return made.broken, made.sound


def test_random_triangles_have_stars_of_any_number():
    valence = np.bincount(case("irregular").broken.mesh.faces.ravel())
    assert valence.min() <= 4
    assert valence.max() >= 9
    assert set(np.bincount(case("irregular").sound.mesh.faces.ravel())) == {6}


@pytest.mark.parametrize("aspect", [8, 32])
def test_slivers_are_as_long_as_they_say(aspect):
    for subject, expected in zip(twins(case(f"slivers-{aspect}")), (aspect, 1), strict=True):
        x, y, z = subject.mesh.vertices.T
        along = np.arctan2(y, x)[subject.mesh.faces]
        across = 0.35 * np.arctan2(z, np.hypot(x, y) - 1.0)[subject.mesh.faces]
        along, across = np.diff(along, axis=1), np.diff(across, axis=1)
        inside = (np.abs(along) < 2.0) & (np.abs(across) < 1.0)  # not across the ends of a turn
        longer = np.abs(along[inside]).mean() / np.abs(across[inside]).mean()
        assert longer == pytest.approx(expected, rel=0.1)


def test_the_worst_slivers_fold_over_and_the_others_do_not():
    for aspect, folded in ((8, False), (32, True)):
        broken = case(f"slivers-{aspect}").broken
        corners = broken.mesh.vertices[broken.mesh.faces]
        middle = corners.mean(axis=1)
        ring = middle * [1.0, 1.0, 0.0]
        outward = middle - ring / np.linalg.norm(ring, axis=1, keepdims=True)
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert (np.mean(np.einsum("ij,ij->i", normals, outward) < 0.0) > 0.01) == folded


@pytest.mark.parametrize("percent", [1, 2, 5, 10, 20])
def test_noise_has_its_size_along_the_normal(percent):
    made = case(f"noise-{percent}")
    offset, edge = offsets(made), mean_edge(made.sound.mesh)
    # 4 000 samples tell a deviation to 1.1 %.
    assert offset.std() / edge == pytest.approx(percent / 100.0, rel=0.05)


def offsets(made):
    """Signed distances of a noisy torus's vertices from it."""
    points = made.broken.mesh.vertices
    return np.hypot(np.hypot(points[:, 0], points[:, 1]) - 1.0, points[:, 2]) - 0.35


def mean_edge(mesh):
    corners = mesh.vertices[mesh.faces]
    return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean()


def test_correlated_noise_moves_neighbours_together_and_white_noise_does_not():
    made = case("correlated-noise")
    a, b = made.broken.mesh.faces[:, 0], made.broken.mesh.faces[:, 1]
    found = offsets(made)
    # A Gauss kernel of length L correlates over a distance d by exp(-d^2/4 L^2): .94 at L = 2 d.
    assert np.corrcoef(found[a], found[b])[0, 1] > 0.85
    white = offsets(case("noise-10"))
    assert abs(np.corrcoef(white[a], white[b])[0, 1]) < 0.05
    assert found.std() == pytest.approx(white.std(), rel=0.05)


@pytest.mark.parametrize("count", [250, 1000, 4000, 16000])
def test_every_resolution_has_the_same_noise_in_mesh_units(count):
    made = case(f"resolution-{count}")
    assert len(made.broken.mesh.vertices) == count
    moved = np.linalg.norm(made.broken.mesh.vertices - at_rest(made), axis=1)
    first = case("resolution-1000")
    sigma = 0.02 * mean_edge(type(first.broken.mesh)(at_rest(first), first.broken.mesh.faces))
    assert np.sqrt(np.mean(moved**2)) == pytest.approx(sigma, rel=3.0 / np.sqrt(count))


def test_units_and_places():
    usual = health("noise-0").diagonal
    assert health("metres").diagonal == pytest.approx(1e-3 * usual)
    assert health("micrometres").diagonal == pytest.approx(1e6 * usual)
    for name, away in (("far", 1e3), ("farther", 1e5)):
        points = case(name).broken.mesh.vertices
        assert np.array_equal(points, points.astype(np.float32))
        assert health(name).distance == pytest.approx(away * usual, rel=1e-3)
    assert health("farther").float32_step > 0.4 * health("farther").typical_edge


def test_the_thin_tube_has_fourteen_vertices_around_it():
    made = case("thin").broken.mesh
    _, faces = grid_cells(4000, (2.0 * np.pi, 2.0 * np.pi * 0.05), (True, True))
    assert np.array_equal(made.faces, faces)
    first = np.isclose(np.arctan2(made.vertices[:, 1], made.vertices[:, 0]), 0.0)
    assert np.count_nonzero(first) == 14
