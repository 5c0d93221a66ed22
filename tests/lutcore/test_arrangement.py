import numpy as np
import pytest

from lutcore import analytic
from lutcore.arrangement import arranged
from lutcore.estimation import principal_curvatures
from lutcore.mesh import TriangleMesh
from lutcore.weld import weld


def shuffled(mesh, seed=0):
    generator = np.random.default_rng(seed)
    order = generator.permutation(len(mesh.vertices))
    faces = np.argsort(order)[mesh.faces]
    return TriangleMesh(mesh.vertices[order], generator.permutation(faces)), order


def test_a_mesh_in_good_order_is_left_as_it_is():
    welded = weld(analytic.torus(60_000).mesh)
    assert arranged(welded) is welded


def test_a_shuffled_mesh_is_brought_together_and_the_way_back_kept():
    mesh, _ = shuffled(analytic.torus(60_000).mesh)
    welded = weld(mesh)
    found = arranged(welded)
    apart = np.ptp(found.mesh.faces.astype(int), axis=1)
    assert np.median(apart) < 2_000
    assert np.median(np.abs(np.diff(found.mesh.faces[:, 0].astype(int)))) < 2_000
    np.testing.assert_array_equal(found.mesh.vertices[found.index], welded.mesh.vertices)
    # The same triangles, turned the same way round.
    old = np.sort(welded.mesh.vertices[welded.mesh.faces].sum(axis=(1, 2)))
    new = np.sort(found.mesh.vertices[found.mesh.faces].sum(axis=(1, 2)))
    np.testing.assert_allclose(new, old, atol=1e-12)


@pytest.mark.parametrize("method", ["auto", "rusinkiewicz2004"])
def test_values_come_back_in_the_order_of_the_input(method):
    mesh = analytic.torus(50_000, irregular=True).noisy(0.02)
    moved, order = shuffled(mesh)
    found, again = principal_curvatures(mesh, method), principal_curvatures(moved, method)
    # Sums over a star run in another order; smoothing is in single precision.
    np.testing.assert_allclose(again.k1, found.k1[order], atol=1e-3 * np.abs(found.k1).max())
    np.testing.assert_allclose(again.normals, found.normals[order], atol=1e-4)
