import numpy as np
import pytest
from scipy.sparse import csr_matrix

from lutcore import analytic
from lutcore.bands import INTERIOR, bands
from lutcore.cosmoothing import shape_operators, smooth, smoothed_normals, surface
from lutcore.estimation import principal_curvatures
from lutcore.lowpass import low_pass
from lutcore.mesh import TriangleMesh
from lutcore.scale import rungs, rungs_for
from lutcore.selection import tilt_correction
from tests.lutcore.test_lowpass import matrix

ROOT = 2.0**0.5


def scales_of(on, *spacings):
    return [s * on.spacing for s in spacings]


def test_the_laplacian_is_stable_and_keeps_constants():
    on = surface(analytic.ellipsoid(500, irregular=True).mesh)
    dense = matrix(on)
    values = np.linalg.eigvals(dense)
    assert np.abs(values.imag).max() < 1e-6 * on.operator.bound
    assert values.real.min() > -1e-6 * on.operator.bound
    assert values.real.max() <= on.operator.bound * (1.0 + 1e-6)
    assert (dense[~np.eye(len(dense), dtype=bool)] <= 0.0).all()


def test_even_meshes_have_a_lower_bound_on_their_laplacian():
    even, random = (surface(analytic.torus(2_000, kind).mesh) for kind in (False, True))
    assert even.operator.bound * even.spacing**2 < 0.95 * random.operator.bound * random.spacing**2


@pytest.mark.parametrize("irregular", [False, True])
def test_exact_on_a_sphere_at_any_scale_when_normals_are(irregular):
    exact = analytic.sphere(1_500, irregular, radius=2.0)
    on = surface(exact.mesh)
    on.fields[:, :3] = exact.mesh.vertices
    on.fields[:, 3:] = exact.truth.normals
    smoothed = smooth(on, scales_of(on, 3.0, 8.0))
    for column in (0, 1, 2):
        assert np.allclose(smoothed.tensors[:, column], [0.5, 0.0, 0.5], atol=1e-4)


def test_a_flat_patch_stays_flat_and_its_rim_in_place():
    on = surface(analytic.saddle(900, irregular=False, k=(0.0, 0.0)).mesh)
    smoothed = smooth(on, scales_of(on, 4.0))
    assert np.abs(smoothed.tensors).max() < 1e-5
    corner = np.abs(on.fields[:, :2]).min(axis=1) > 0.4  # within 2.5 scales
    assert smoothed.stretch[~corner].min() > 0.9


def test_the_bias_is_of_fourth_order():
    exact = analytic.torus(20_000)
    on = surface(exact.mesh)
    smoothed = smooth(on, scales_of(on, 6.0, 6.0 * ROOT, 12.0))
    off = [
        np.abs(0.5 * (tensor[:, 0] + tensor[:, 2]) - exact.truth.mean).mean()
        for tensor in (smoothed.tensors[:, column] for column in (1, 2, 3))
    ]
    # A factor of 4 from rung to rung; less where the next order sets in.
    assert off[1] / off[0] > 3.0
    assert off[2] / off[1] > 3.0


def test_noise_in_the_bands_is_that_of_the_curvature():
    exact = analytic.torus(20_000)
    quiet, loud = (surface(mesh) for mesh in (exact.mesh, exact.noisy(0.05)))
    lengths = scales_of(quiet, *(ROOT**j for j in range(5)))
    clean, noisy = smooth(quiet, lengths, 3), smooth(loud, lengths, 3)
    found = bands(loud, noisy)
    for column in (2, 3, 4):
        apart = (noisy.tensors - clean.tensors)[:, column]
        # The grid's frames lie along the principal directions, so k1 and k2 change by the
        # entries on the diagonal. The entry off it holds how the two frames are turned.
        actual = np.mean(0.5 * (apart[:, 0] ** 2 + apart[:, 2] ** 2))
        assert found.left[INTERIOR, column] == pytest.approx(actual, rel=0.3)


def test_classes_follow_the_rim():
    mesh = analytic.saddle(2_500).mesh
    on = surface(mesh)
    place = bands(on, smooth(on, scales_of(on, 1.0, ROOT, 2.0))).place
    outermost = np.abs(mesh.vertices[:, :2]).max(axis=1) > 0.999
    assert (place[outermost] == 0).all()
    assert (place[~outermost] > 0).all()
    assert place[np.argmin(np.square(mesh.vertices).sum(axis=1))] == INTERIOR


def test_shortening_of_normals_by_noise_is_undone():
    exact = analytic.sphere(20_000)
    on = surface(exact.noisy(0.2))
    smoothed = smooth(on, scales_of(on, 8.0))
    mean = 0.5 * (smoothed.tensors[:, 1, 0] + smoothed.tensors[:, 1, 2]).mean()
    assert mean < 0.99
    assert tilt_correction(on, smoothed) * mean == pytest.approx(1.0, abs=0.003)


def test_more_noise_asks_for_a_larger_scale():
    exact = analytic.torus(10_000)
    lengths = [
        np.median(principal_curvatures(exact.noisy(share)).scale) for share in (0.0, 0.02, 0.3)
    ]
    assert lengths[0] < lengths[1] < lengths[2]


def test_each_vertex_has_its_own_scale():
    # Noise of the same size everywhere, and a crease: the edge of a roof stays sharp while the
    # flat parts are averaged far.
    flat = analytic.saddle(10_000, k=(0.0, 0.0)).mesh
    points = flat.vertices.copy()
    points[:, 2] = -np.abs(points[:, 0])
    points[:, 2] += 2e-4 * np.random.default_rng(0).standard_normal(len(points))
    found = principal_curvatures(TriangleMesh(points, flat.faces))
    away = np.abs(points[:, :2]).max(axis=1) < 0.7
    edge = away & (np.abs(points[:, 0]) < 0.01)
    plain = away & (np.abs(points[:, 0]) > 0.3)
    assert np.median(found.scale[edge]) < 0.4 * np.median(found.scale[plain])
    # A right angle over two spacings of .02: half the turn at a vertex of the ridge is over one.
    assert np.median(found.k1[edge]) > 10.0
    assert np.sqrt(np.mean(found.k1[plain] ** 2)) < 0.1


def test_a_large_mesh_tries_only_the_scales_that_its_patches_chose(monkeypatch):
    exact = analytic.torus(60_000, irregular=True)
    mesh = exact.noisy(0.05)
    whole = principal_curvatures(mesh)
    monkeypatch.setattr("lutcore.scale._WHOLE", 50_000)
    on = surface(mesh)
    few = rungs(on, mesh.diagonal, 0.002, 4.0)
    assert len(few) < 7
    sampled = principal_curvatures(mesh)
    size = np.sqrt(np.mean(exact.truth.k1**2 + exact.truth.k2**2))
    assert np.sqrt(np.mean((sampled.k1 - whole.k1) ** 2)) < 0.003 * size


def test_a_large_mesh_without_noise_keeps_the_finest_scales(monkeypatch):
    monkeypatch.setattr("lutcore.scale._WHOLE", 50_000)
    exact = analytic.torus(60_000)
    found = principal_curvatures(exact.mesh)
    assert np.median(found.scale) <= 1.5 * surface(exact.mesh).spacing
    assert np.abs(found.k1 - exact.truth.k1).max() < 1e-3 * exact.truth.k1.max()


def test_scales_around_given_lengths():
    np.testing.assert_allclose(rungs_for(np.array(3.0), 1.0), [3.0 / ROOT, 3.0, 3.0 * ROOT])
    many = rungs_for(np.array([1.0, 7.0]), 1.0)
    assert many[0] == pytest.approx(1.0 / ROOT)
    assert many[-1] == pytest.approx(7.0 * ROOT)
    assert (many[1:] / many[:-1] <= ROOT * (1.0 + 1e-9)).all()


@pytest.mark.parametrize("length", [1e-300, 1e-6, 0.01])
def test_noise_is_heard_however_short_the_scale(length):
    exact = analytic.sphere(2_000)
    found = principal_curvatures(exact.noisy(0.05), "co-smoothing", length)
    assert (found.scale > 0.2 * surface(exact.mesh).spacing).all()  # what it really is, not 1e-300
    apart = np.concatenate([np.abs(found.k1 - 1.0), np.abs(found.k2 - 1.0)])
    # Without averaging the bars are those of a class, not of a vertex: less than 95 %.
    assert np.mean(apart < 2.0 * np.tile(found.error, 2)) > 0.65


def test_nothing_but_specks_is_no_fault(monkeypatch):
    monkeypatch.setattr("lutcore.scale._WHOLE", 1_000)
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    places = 3.0 * np.arange(20_000)[:, None, None] * [1.0, 0.0, 0.0]
    points = (corners + places).reshape(-1, 3)
    found = principal_curvatures(TriangleMesh(points, np.arange(len(points)).reshape(-1, 3)))
    assert np.isfinite(found.k1).all()
    assert (found.error >= 1.0 / 3.0).all()


@pytest.mark.parametrize("radius", [1.0, 0.02])
def test_a_closed_speck_keeps_what_its_stars_say(radius):
    ball = analytic.sphere(40, radius=radius).mesh
    sheet = analytic.saddle(400, k=(0.0, 0.0)).mesh
    points = np.vstack([ball.vertices + [0.0, 0.0, 2.0 * radius], sheet.vertices])
    faces = np.vstack([ball.faces, sheet.faces + len(ball.vertices)])
    for mesh in (ball, TriangleMesh(points, faces)):
        found = principal_curvatures(mesh)
        assert np.isfinite([found.k1, found.k2]).all()
        there = slice(0, len(ball.vertices))
        assert np.median(found.k1[there]) * radius == pytest.approx(1.0, rel=0.3)


@pytest.mark.parametrize("method", ["auto", "co-smoothing"])
def test_a_scale_for_each_vertex(method):
    mesh = analytic.torus(5_000, irregular=True).noisy(0.02)
    lengths = np.where(mesh.vertices[:, 0] > 0.0, 0.1, 0.25)
    found = principal_curvatures(mesh, method, lengths)
    np.testing.assert_allclose(found.scale, lengths, rtol=1e-6)
    for length in (0.1, 0.25):
        same = principal_curvatures(mesh, method, length)
        # Alike but for the tangent planes, which are those of the middle scale, and for what the
        # last averaging, over 1.5 spacings, takes from the other half.
        far = (lengths == length) & (np.abs(mesh.vertices[:, 0]) > 0.3)
        np.testing.assert_allclose(found.k1[far], same.k1[far], atol=5e-3 * same.k1.max())


def test_a_square_corner_is_told_apart_by_its_error():
    exact = analytic.saddle(4_000)
    mesh = exact.noisy(0.02)
    found = principal_curvatures(mesh, "co-smoothing")
    corner = np.abs(mesh.vertices[:, :2]).min(axis=1) > 0.97
    assert np.abs(found.k1[corner] - exact.truth.k1[corner]).max() < 0.5
    assert np.median(found.error[corner]) > 2.0 * np.median(found.error)


def test_a_single_triangle_has_an_operator():
    on = surface(TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
    assert np.allclose(matrix(on).sum(axis=1), 0.0)


def test_rates_are_relative_to_the_largest_row():
    on = surface(analytic.torus(500).mesh)
    rows = csr_matrix((on.operator.rate, on.operator.neighbour, on.operator.start)).sum(axis=1)
    assert rows.max() == pytest.approx(1.0, rel=1e-6)


def test_what_is_left_out_changes_nothing_of_the_rest():
    on = surface(analytic.torus(2_000).noisy(0.02))
    change = low_pass(on.operator, on.fields, [2.0 * on.spacing, 4.0 * on.spacing])
    given = *on.operator.links, on.fields, change, 1, on.spacing
    normals, tensors, stretch = shape_operators(*given)
    np.testing.assert_array_equal(smoothed_normals(on.fields, change, 1), normals)
    for first in (1, 2):
        _, some, open_ = shape_operators(*given, first)
        np.testing.assert_array_equal(some, tensors[:, first:])
        np.testing.assert_array_equal(open_, stretch[:, first:])
