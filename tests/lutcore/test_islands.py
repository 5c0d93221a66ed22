import numpy as np

from lutcore.analytic import torus
from lutcore.islands import main_islands
from lutcore.mesh import TriangleMesh


def test_debris_and_unused_vertices_are_not_the_subject():
    body = torus(2000).mesh
    count = len(body.vertices)
    crumb = np.array([[9.0, 0, 0], [9, 1, 0], [9, 0, 1], [50, 50, 50]])
    mesh = TriangleMesh(
        np.concatenate([body.vertices, crumb]),
        np.concatenate([body.faces, [[count, count + 1, count + 2]]]),
    )
    found = main_islands(mesh)
    assert found[:count].all()
    assert not found[count:].any()


def test_triangle_soup_is_all_subject():
    soup = TriangleMesh(np.random.default_rng(0).random((30, 3)), np.arange(30).reshape(10, 3))
    assert main_islands(soup).all()
