import numpy as np
import pytest
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import expm_multiply

from lutcore import analytic
from lutcore.cosmoothing import smooth, surface
from lutcore.heat import diffusion
from lutcore.mesh import TriangleMesh
from lutcore.noise import extrapolated_noise, plain_noise, vertex_noise
from lutcore.scale import best_scale
from lutcore.selection import extrapolated, tilt_correction

TORUS = analytic.torus(2_000, irregular=True)
ROOT = 2.0**0.5


def matrix(on):
    start, neighbour, rate, bound = on.operator
    weights = csr_matrix((0.5 * bound * rate.astype(float), neighbour, start))
    return csr_matrix(np.diag(np.asarray(weights.sum(axis=1)).ravel())) - weights


def test_the_laplacian_is_stable_and_keeps_constants():
    on = surface(analytic.ellipsoid(500, irregular=True).mesh)
    dense = matrix(on).toarray()
    values = np.linalg.eigvals(dense)
    assert np.abs(values.imag).max() < 1e-6 * on.operator.bound
    assert values.real.min() > -1e-6 * on.operator.bound
    assert values.real.max() <= on.operator.bound * (1.0 + 1e-6)
    assert (dense[~np.eye(len(dense), dtype=bool)] <= 0.0).all()


@pytest.mark.parametrize("make", [analytic.torus, analytic.saddle])
def test_the_recurrence_gives_the_matrix_exponential(make):
    on = surface(make(600, irregular=True).mesh)
    scales = [2.0 * on.spacing, 6.0 * on.spacing]
    change = diffusion(on.operator, on.fields, scales, 1e-6)
    operator = matrix(on)
    for column, scale in enumerate(scales):
        exact = expm_multiply(-0.5 * scale**2 * operator, on.fields) - on.fields
        # The tolerance asked for, and single precision over some fifty terms.
        assert np.abs(change[:, column] - exact).max() < 1e-5 * np.abs(exact).max()


def test_diffusion_is_a_gaussian_of_the_scale():
    # On a regular flat grid a single bump becomes exp(-r^2/2 s^2) / (2 pi s^2) times its area.
    grid = analytic.saddle(3_600, k=(0.0, 0.0)).mesh
    on = surface(grid)
    middle = int(np.argmin(np.square(grid.vertices).sum(axis=1)))
    fields = np.zeros((len(grid.vertices), 6))
    fields[middle] = 1.0
    scale = 4.0 * on.spacing
    after = fields + diffusion(on.operator, fields, [scale], 1e-6)[:, 0]
    radius = np.square(grid.vertices - grid.vertices[middle]).sum(axis=1)
    gauss = on.spacing**2 / (2.0 * np.pi * scale**2) * np.exp(-0.5 * radius / scale**2)
    # The five-point stencil is a Gaussian up to fourth order: (h/s)^2/8 = .8 % of the peak; the
    # least weight on the diagonals, .01, widens it by another per cent.
    assert np.abs(after[:, 0] - gauss).max() < 0.02 * gauss.max()


@pytest.mark.parametrize("irregular", [False, True])
def test_exact_on_a_sphere_at_any_scale_when_normals_are(irregular):
    exact = analytic.sphere(1_500, irregular, radius=2.0)
    on = surface(exact.mesh)
    on.fields[:, 3:] = exact.truth.normals
    smoothed = smooth(on, [3.0 * on.spacing, 8.0 * on.spacing])
    for column in (0, 1, 2):
        tensors = smoothed.tensors[:, column]
        assert np.allclose(tensors, [0.5, 0.0, 0.5], atol=1e-4)


def test_a_flat_patch_stays_flat_and_its_rim_in_place():
    on = surface(analytic.saddle(900, irregular=False, k=(0.0, 0.0)).mesh)
    smoothed = smooth(on, [4.0 * on.spacing])
    assert np.abs(smoothed.tensors).max() < 1e-5
    corner = np.abs(on.fields[:, :2]).min(axis=1) > 0.4  # within 2.5 scales
    assert smoothed.stretch[~corner].min() > 0.9


def test_extrapolation_removes_the_error_of_second_order():
    exact = analytic.torus(20_000)
    on = surface(exact.mesh)
    scales = [4.0 * on.spacing * ROOT**j for j in range(4)]
    smoothed = smooth(on, scales)
    plain, better = [], []
    for column in (1, 2, 3):
        mean = 0.5 * (smoothed.tensors[:, column, 0] + smoothed.tensors[:, column, 2])
        plain.append(np.abs(mean - exact.truth.mean).mean())
        both = extrapolated(smoothed, column)
        better.append(np.abs(0.5 * (both[:, 0] + both[:, 2]) - exact.truth.mean).mean())
    # Orders 2 and 4 in s: factors 2 and 4 from rung to rung.
    assert plain[2] / plain[1] == pytest.approx(2.0, rel=0.1)
    assert better[2] / better[1] > 3.0
    assert better[0] < 0.15 * plain[0]


@pytest.mark.parametrize("irregular", [False, True])
@pytest.mark.parametrize("share", [0.02, 0.1])
def test_noise_is_read_from_the_mesh(irregular, share):
    exact = analytic.torus(10_000, irregular)
    mesh = exact.noisy(share)
    on = surface(mesh)
    smoothed = smooth(on, [5.0 * on.spacing])
    found = vertex_noise(
        on.operator.start,
        on.operator.neighbour,
        mesh.vertices,
        smoothed.normals,
        smoothed.tensors[:, 1].copy(),
    )
    points = mesh.vertices - exact.mesh.vertices
    sigma = np.einsum("ij,ij->i", points, exact.truth.normals).std()
    # 10,000 samples: 1 % by chance; rings of other than six neighbours: a few per cent.
    assert found == pytest.approx(sigma, rel=0.1)


def test_noise_of_k_follows_the_gaussian_theory():
    exact = analytic.torus(20_000)
    quiet, loud = (surface(mesh) for mesh in (exact.mesh, exact.noisy(0.02)))
    scales = [s * quiet.spacing for s in (1.0, 2.0, 2.0 * ROOT, 4.0)]
    clean, noisy = smooth(quiet, scales), smooth(loud, scales)
    edges = exact.mesh.vertices[exact.mesh.faces] - np.roll(
        exact.mesh.vertices[exact.mesh.faces], 1, axis=1
    )
    sigma = 0.02 * np.linalg.norm(edges, axis=2).mean()

    def half_trace(tensors):
        # The mean curvature has 2/3 of the variance of either: their covariance is a third.
        return 0.5 * (tensors[:, 0] + tensors[:, 2]).std() * np.sqrt(1.5)

    for column in (1, 2, 3, 4):
        actual = half_trace((noisy.tensors - clean.tensors)[:, column])
        assert plain_noise(sigma, quiet.spacing, scales[column - 1]) == pytest.approx(
            actual, rel=0.25
        )
    actual = half_trace(extrapolated(noisy, 2) - extrapolated(clean, 2))
    assert extrapolated_noise(sigma, quiet.spacing, scales[1]) == pytest.approx(actual, rel=0.25)


def test_shortening_of_normals_by_noise_is_undone():
    exact = analytic.sphere(20_000)
    on = surface(exact.noisy(0.2))
    smoothed = smooth(on, [8.0 * on.spacing])
    mean = 0.5 * (smoothed.tensors[:, 1, 0] + smoothed.tensors[:, 1, 2]).mean()
    assert mean < 0.99
    assert tilt_correction(on, smoothed) * mean == pytest.approx(1.0, abs=0.003)


def test_more_noise_asks_for_a_larger_scale():
    exact = analytic.torus(10_000)
    lengths = [best_scale(surface(exact.noisy(share))) for share in (0.0, 0.02, 0.3)]
    assert lengths[0] < lengths[1] < lengths[2]


def test_patches_of_a_large_mesh_choose_the_scale_of_the_whole(monkeypatch):
    mesh = analytic.torus(60_000, irregular=True).noisy(0.05)
    sampled = best_scale(surface(mesh))
    monkeypatch.setattr("lutcore.scale._PATCH", 60_000)
    assert sampled == best_scale(surface(mesh))


def test_a_square_corner_takes_its_value_from_around():
    exact = analytic.saddle(4_000)
    mesh = exact.noisy(0.02)
    from lutcore.estimation import principal_curvatures

    found = principal_curvatures(mesh, "co-smoothing")
    corner = np.abs(mesh.vertices[:, :2]).min(axis=1) > 0.97
    assert (np.ravel(found.scale)[corner] == 0.0).any()  # the star has closed there
    assert np.abs(found.k1[corner] - exact.truth.k1[corner]).max() < 0.5
    assert np.median(found.error[corner]) > 2.0 * np.median(found.error)


def test_a_single_triangle_has_an_operator():
    on = surface(TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
    assert np.allclose(matrix(on).toarray().sum(axis=1), 0.0)
