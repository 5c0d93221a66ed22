import numpy as np
import pytest

from lutcore import analytic

SHAPES = ["sphere", "ellipsoid", "cylinder", "torus", "saddle", "monkey_saddle"]
EULER = {"sphere": 2, "ellipsoid": 2, "cylinder": 0, "torus": 0, "saddle": 1, "monkey_saddle": 1}


@pytest.fixture(params=[(name, irregular) for name in SHAPES for irregular in (False, True)])
def shape(request):
    name, irregular = request.param
    return name, getattr(analytic, name)(2_000, irregular)


def test_meshes_are_whole(shape):
    name, exact = shape
    faces, count = exact.mesh.faces, len(exact.mesh.vertices)
    directed = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    assert len(np.unique(directed, axis=0)) == len(directed)  # one orientation everywhere
    edges = np.unique(np.sort(directed, axis=1), axis=0)
    assert count - len(edges) + len(faces) == EULER[name]
    assert len(np.unique(faces)) == count


def test_faces_look_outwards(shape):
    _, exact = shape
    points, faces = exact.mesh.vertices, exact.mesh.faces
    a, b, c = (points[faces[:, j]] for j in range(3))
    outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), exact.truth.normals[faces[:, 0]])
    assert np.mean(outward > 0.0) > 0.999  # slivers of random points may stand on edge


def test_truth_is_a_right_handed_frame_in_order(shape):
    _, exact = shape
    truth = exact.truth
    assert (truth.k1 >= truth.k2).all()
    assert np.allclose(np.cross(truth.d1, truth.d2), truth.normals, atol=1e-12)
    assert np.allclose(np.linalg.norm(truth.normals, axis=1), 1.0)


def test_truth_agrees_with_textbooks():
    assert np.allclose(analytic.sphere(100, radius=2.0).truth.k2, 0.5)
    cylinder = analytic.cylinder(100, radius=2.0).truth
    assert np.allclose(cylinder.k1, 0.5)
    assert np.allclose(cylinder.k2, 0.0)
    assert np.allclose(np.abs(cylinder.d2[:, 2]), 1.0)
    torus = analytic.torus(400)
    ring = np.hypot(*torus.mesh.vertices[:, :2].T)
    assert np.allclose(torus.truth.k1, 1.0 / 0.35)
    assert np.allclose(torus.truth.k2, (ring - 1.0) / 0.35 / ring)


def test_a_saddle_has_its_curvatures_in_the_middle():
    exact = analytic.saddle(400, k=(2.0, -3.0))
    middle = np.argmin(np.square(exact.mesh.vertices).sum(axis=1))
    assert np.isclose(exact.truth.k1[middle], 2.0)
    assert np.isclose(exact.truth.k2[middle], -3.0)
    assert np.isclose(abs(exact.truth.d1[middle, 0]), 1.0)


def test_gauss_bonnet_holds_on_an_ellipsoid():
    exact = analytic.ellipsoid(20_000)
    points, faces = exact.mesh.vertices, exact.mesh.faces
    a, b, c = (points[faces[:, j]] for j in range(3))
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    total = (areas * exact.truth.gauss[faces].mean(axis=1)).sum()
    # The chords lack area of order h^2 k^2/6; h = .02 and k <= 4.
    assert np.isclose(total, 4.0 * np.pi, rtol=2e-3)


def test_noise_has_the_size_asked_for_and_the_seed_repeats_it():
    exact = analytic.torus(10_000)
    noisy = exact.noisy(0.1, seed=3)
    assert np.array_equal(noisy.vertices, exact.noisy(0.1, seed=3).vertices)
    points, faces = exact.mesh.vertices, exact.mesh.faces
    edge = np.linalg.norm(points[faces] - points[np.roll(faces, 1, axis=1)], axis=2).mean()
    moved = np.einsum("ij,ij->i", noisy.vertices - points, exact.truth.normals)
    # A standard deviation from n samples is known to 1/sqrt(2 n) = .7 %; five of those.
    assert np.isclose(moved.std(), 0.1 * edge, rtol=0.035)
