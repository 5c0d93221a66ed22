import numpy as np
import pytest

from lutcore.analytic import ellipsoid, sphere, torus
from lutcore.cosmoothing import surface
from lutcore.errors import ParameterError
from lutcore.estimation import principal_curvatures
from lutcore.lowpass import low_pass
from lutcore.mesh import TriangleMesh


@pytest.mark.parametrize("size", [1e-30, 1e-15, 1.0, 1e15])
@pytest.mark.parametrize("method", ["auto", "co-smoothing", "rusinkiewicz2004"])
def test_the_size_of_the_unit_does_not_matter(method, size):
    mesh = sphere(500).mesh
    found = principal_curvatures(TriangleMesh(mesh.vertices * size, mesh.faces), method=method)
    one = principal_curvatures(mesh, method=method)
    # Only the unit differs, and the rounding of the vertices with it; smoothing carries single
    # precision, 1e-7, through differences over an edge, a tenth of the surface.
    np.testing.assert_allclose(found.k1 * size, one.k1, rtol=1e-5)
    np.testing.assert_allclose(found.error * size, one.error, rtol=1e-2, atol=1e-6)


@pytest.mark.parametrize("scale", [1e9, 1e300, 0.0, -1.0, np.nan])
def test_a_scale_that_cannot_be_is_refused(scale):
    with pytest.raises(ParameterError, match="scale"):
        principal_curvatures(sphere(500).mesh, method="co-smoothing", scale=scale)


@pytest.mark.parametrize("method", ["auto", "co-smoothing"])
def test_what_a_lone_triangle_is_cannot_be_known(method):
    mesh = TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    found = principal_curvatures(mesh, method=method)
    assert (found.error >= 1.0).all()


def test_a_vertex_without_faces_gets_none_from_a_neighbour_in_its_place():
    ball = sphere(500).mesh
    mesh = TriangleMesh(np.vstack([ball.vertices, ball.vertices[:1]]), ball.faces)
    found = principal_curvatures(mesh, method="rusinkiewicz2004")
    assert np.isinf(found.error[-1])
    assert found.k1[-1] == 0.0
    assert np.isfinite(found.error[:-1]).all()


def test_patches_with_a_ragged_rim_still_choose_a_scale():
    # A vertex on the rim of a patch keeps one neighbour here.
    mesh = torus(50_000, irregular=True).noisy(0.05)
    assert np.isfinite(principal_curvatures(mesh).k1).all()


def test_islands_smaller_than_a_patch_still_choose_a_scale():
    parts = [sphere(count).mesh for count in (12_000, 12_000, 11_999, 5_000)]
    vertices, faces, count = [], [], 0
    for place, mesh in enumerate(parts):
        vertices.append(mesh.vertices + (4.0 * place, 0.0, 0.0))
        faces.append(mesh.faces + count)
        count += len(mesh.vertices)
    mesh = TriangleMesh(np.vstack(vertices), np.vstack(faces))
    off = np.abs(principal_curvatures(mesh).k1 - 1.0)
    assert np.sqrt(np.mean(off**2)) < 0.004  # `auto` aims at a precision of .002
    assert off.max() < 0.04  # at the poles of the spirals, whose stars are uneven


def smoothed_noise(exact, share, length):
    """The mesh with noise along the normal that neighbours over some edges have in common."""
    points, faces = exact.mesh.vertices, exact.mesh.faces
    edge = np.linalg.norm(points[faces] - points[np.roll(faces, 1, axis=1)], axis=2).mean()
    white = np.random.default_rng(0).standard_normal((len(points), 6))
    operator = surface(exact.mesh).operator
    waves = (white + low_pass(operator, white, [length * edge])[0])[:, 0]
    waves *= share * edge / waves.std()
    return TriangleMesh(points + waves[:, None] * exact.truth.normals, faces)


@pytest.mark.parametrize("noise", ["white 2 %", "white 10 %", "correlated 5 %"])
@pytest.mark.parametrize("shape", [ellipsoid, torus])
def test_error_bars_hold_the_truth_as_often_as_they_say(shape, noise):
    # Other surfaces than those that the constants were found on: other radii, counts and seeds.
    own = {ellipsoid: {"axes": (1.0, 0.8, 0.6)}, torus: {"minor": 0.5}}[shape]
    exact = shape(25_000, irregular=True, seed=7, **own)
    if noise.startswith("white"):
        mesh = exact.noisy(float(noise.split()[1]) / 100.0, seed=8)
    else:
        mesh = smoothed_noise(exact, 0.05, 1.5)
    found = principal_curvatures(mesh)
    truth = exact.truth
    apart = np.concatenate([np.abs(found.k1 - truth.k1), np.abs(found.k2 - truth.k2)])
    bars = np.tile(found.error, 2)
    # A Gaussian has .683 and .954; a single surface may stray by as much as its kind is alike.
    assert 0.55 < np.mean(apart < bars) < 0.9
    assert np.mean(apart < 2.0 * bars) > 0.85


def test_progress_only_grows_and_ends_at_one():
    shares = []
    principal_curvatures(torus(3000).mesh, progress=lambda share, step: not shares.append(share))
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
