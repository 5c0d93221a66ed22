"""What rims take over from the inside: exact on constant shape, and blind to order."""

import numpy as np
from numpy.testing import assert_allclose

from lutcore import analytic
from lutcore.borrowing import borrow
from lutcore.cosmoothing import surface
from lutcore.mesh import TriangleMesh

CURVED = np.array([2.0, 0.5, -1.0])


def patch(count=900):
    """A flat patch: tensors of all vertices are in one frame."""
    return surface(analytic.saddle(count, irregular=True, k=(0.0, 0.0)).mesh)


def borrowed(on, weak, closed, tensors, square, doubt):
    tensors, square = tensors.copy(), square.copy()
    links = (on.operator.start, on.operator.neighbour)
    normals = np.tile([0.0, 0.0, 1.0], (len(tensors), 1))
    borrow(*links, normals, weak.astype(np.int32), closed, tensors, square, doubt)
    return tensors, square


def near_rim(on, rings=3):
    near = on.operator.rim.copy()
    start, neighbour = on.operator.start, on.operator.neighbour
    for _ in range(rings):
        for i in np.flatnonzero(near):
            near[neighbour[start[i] : start[i + 1]]] = True
    return near


def test_a_rim_that_knows_nothing_takes_what_the_inside_has():
    on = patch()
    near = near_rim(on)
    tensors = np.where(near[:, None], 100.0, CURVED)
    weak = np.flatnonzero(near)
    square = np.where(near, 1e12, 1e-4)
    for closed in (np.zeros(len(weak), bool), np.ones(len(weak), bool)):
        found, _ = borrowed(on, weak, closed, tensors, square, square[weak])
        assert_allclose(found, np.tile(CURVED, (len(found), 1)), atol=1e-6)


def test_a_rim_that_is_precise_stays_as_it_is():
    on = patch()
    near = near_rim(on)
    generator = np.random.default_rng(0)
    tensors = np.where(near[:, None], 0.0, CURVED) + generator.standard_normal((len(near), 3))
    weak = np.flatnonzero(near)
    square = np.where(near, 1e-12, 1e-4)
    found, _ = borrowed(on, weak, np.zeros(len(weak), bool), tensors, square, square[weak])
    assert_allclose(found, tensors, atol=1e-6)


def test_doubt_of_its_own_makes_a_vertex_borrow_more():
    on = patch()
    near = near_rim(on)
    generator = np.random.default_rng(0)
    tensors = np.where(near[:, None], generator.standard_normal((len(near), 3)), 0.0)
    tensors += 1e-3 * generator.standard_normal((len(near), 3))
    weak = np.flatnonzero(near)
    square = np.full(len(near), 1e-4)
    closed = np.zeros(len(weak), bool)
    left = [
        np.abs(borrowed(on, weak, closed, tensors, square, times * square[weak])[0][weak]).mean()
        for times in (0.1, 1.0, 10.0, 100.0)
    ]
    assert left == sorted(left, reverse=True)
    assert left[-1] < 0.5 * left[0]


def test_an_island_without_an_inside_is_left_with_the_mean_of_what_it_knows():
    on = patch(80)
    generator = np.random.default_rng(1)
    tensors = CURVED + generator.standard_normal((len(on.fields), 3))
    weak = np.arange(len(tensors))
    # Bars a hundred times wider than what neighbours may differ by where nothing else is known.
    square = np.full(len(tensors), 1e4)
    found, _ = borrowed(on, weak, np.zeros(len(weak), bool), tensors, square, square)
    assert np.isfinite(found).all()
    assert found.std(axis=0).max() < tensors.std(axis=0).min()


def test_the_order_of_vertices_and_neighbours_does_not_matter():
    mesh = analytic.saddle(900, irregular=True, k=(0.0, 0.0)).mesh
    generator = np.random.default_rng(2)
    order = generator.permutation(len(mesh.vertices))
    rank = np.argsort(order)
    faces = rank[mesh.faces][generator.permutation(len(mesh.faces))][:, [1, 2, 0]]
    tensors = generator.standard_normal((len(order), 3))
    square = generator.uniform(0.1, 1.0, len(order))
    found = []
    for one, values, bars in (
        (mesh, tensors, square),
        (TriangleMesh(mesh.vertices[order], faces), tensors[order], square[order]),
    ):
        on = surface(one)
        weak = np.flatnonzero(near_rim(on))
        closed = bars[weak] > 0.9
        found.append(borrowed(on, weak, closed, values, bars, bars[weak]))
    assert_allclose(found[1][0], found[0][0][order], atol=1e-9)
    assert_allclose(found[1][1], found[0][1][order], atol=1e-9)
