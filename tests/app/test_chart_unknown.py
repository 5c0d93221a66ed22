import re

import numpy as np
import pytest

from app.chart.contestants import spacing_of
from app.chart.measuring import Measuring
from app.chart.perturbation import perturbation
from app.chart.reference import Seen, biases, distance, size, votes
from app.chart.unknown import mesh_chart
from lutcore import analytic
from lutcore.errors import MeshError
from lutcore.estimation import principal_curvatures
from lutcore.mesh import TriangleMesh
from lutcore.progress import silent


def test_noise_is_as_large_as_asked_for_and_along_the_normal():
    exact = analytic.sphere(3000)
    moved = perturbation(exact.mesh, 0.02)(1)
    offsets = moved.vertices - exact.mesh.vertices
    along = np.einsum("ij,ij->i", offsets, exact.truth.normals)
    edge = np.sqrt(4.0 * np.pi / 3000 * 2.0 / np.sqrt(3.0))  # of equilateral triangles
    # The spiral's triangles are not equilateral; 3000 samples tell a deviation to 1.3 %.
    assert along.std() == pytest.approx(0.02 * edge, rel=0.08)
    # Normals of the mesh are those of the sphere to about one squared edge.
    assert np.abs(offsets - along[:, None] * exact.truth.normals).max() < 0.1 * np.abs(along).max()
    np.testing.assert_array_equal(moved.faces, exact.mesh.faces)
    assert not np.array_equal(moved.vertices, perturbation(exact.mesh, 0.02)(2).vertices)


def test_noise_opens_no_seam_and_leaves_vertices_without_faces():
    mesh = analytic.torus(300).mesh
    loose = np.vstack([mesh.vertices[mesh.faces].reshape(-1, 3), [[9.0, 9.0, 9.0]]])
    soup = TriangleMesh(loose, np.arange(3 * len(mesh.faces)).reshape(-1, 3))
    moved = perturbation(soup, 0.1)(0).vertices
    again = np.empty_like(mesh.vertices)
    again[mesh.faces.ravel()] = moved[:-1]
    np.testing.assert_array_equal(again[mesh.faces].reshape(-1, 3), moved[:-1])
    assert (again != mesh.vertices).any(axis=1).all()
    np.testing.assert_array_equal(moved[-1], [9.0, 9.0, 9.0])


def seen(name, scale, level, change):
    return Seen(name, scale, np.full((5, 2), level), change)


def test_the_finest_steady_setting_votes():
    all_of_them = [
        seen("a", 0.0, 10.0, 5.0),  # noise
        seen("a", 2.0, 10.0, 0.5),
        seen("a", 8.0, 7.0, 0.01),  # steadier, but coarser
        seen("b", 4.0, 9.0, 0.89),  # just under a tenth
        seen("c", 0.0, 12.0, 3.0),
    ]
    assert {name: vote.scale for name, vote in votes(all_of_them).items()} == {"a": 2.0, "b": 4.0}
    found = biases(all_of_them)
    assert found is not None
    # a is judged by b, b by a, c by the median of both.
    assert found[0] == pytest.approx([1.0, 1.0, 2.0, 1.0, 2.5])
    assert found[1] == pytest.approx(9.5)


def test_an_estimator_alone_is_judged_by_its_own_vote():
    found = biases([seen("a", 2.0, 10.0, 0.5), seen("a", 8.0, 7.0, 0.0)])
    assert found is not None
    assert found[0] == pytest.approx([0.0, 3.0])


def test_without_a_steady_setting_nothing_stands_for_the_truth():
    assert biases([seen("a", 2.0, 1.0, 0.2)]) is None


def test_who_steadily_sees_no_curvature_votes():
    flat = [seen(name, 0.0, 0.0, 0.0) for name in "abc"]
    assert set(votes([*flat, seen("d", 0.0, 7.0, 0.0)])) == set("abcd")
    assert biases([*flat, seen("d", 0.0, 7.0, 0.0)]) is None


def test_on_a_flat_mesh_nothing_is_recommended():
    triangle = TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    methods = ["auto", "ball-jet", "rusinkiewicz2004"]
    found = mesh_chart(triangle, "flat", methods, (), Measuring(repeats=1), None, silent)
    assert found.points == ()
    assert "see no curvature" in found.advice.sentence


def test_the_error_on_a_mesh_follows_the_truth_and_oversmoothing_does_not_win():
    # A torus of 30 spacings around its tube, where 8 spacings smooth most away; 2 % of noise.
    exact = analytic.torus(2500, irregular=True)
    methods = ["ball-jet", "corrected-curvature", "rusinkiewicz2004"]
    found = mesh_chart(
        exact.mesh, "torus", methods, (2.0, 4.0, 8.0), Measuring(repeats=1), None, silent
    )
    noisy = perturbation(exact.mesh, 0.02)(0)
    truth = np.stack([exact.truth.k1, exact.truth.k2], axis=1)
    said, true = {}, {}
    for one in found.points:
        way = {"degree": 2} if "degree" in one.setting else {}
        length = re.search(r"([\d.]+) h", one.setting)
        scale = float(length[1]) * spacing_of(noisy) if length else None
        values = principal_curvatures(noisy, one.name, scale, **way)
        said[one.label] = one.share
        true[one.label] = distance(np.stack([values.k1, values.k2], axis=1), truth) / size(truth)
    # By the triangle inequality what is said is off by the reference's own error at most.
    own = max(true[f"{name}, {length:g} h"] for name, length in found.facts["reference"].items())
    assert own < 0.12
    assert max(abs(said[label] - true[label]) for label in said) < own

    steadiest = min(found.points, key=lambda one: one.details["change"])
    assert steadiest.setting == "8 h"
    # Whichever of those that can be recommended was the fastest, it is a good one.
    good = [label for label in said if said[label] <= 2.0 * min(said.values())]
    assert found.advice.point is not None
    assert found.advice.point.label in good
    assert steadiest.label not in good
    assert max(true[label] for label in good) < 2.5 * min(true.values())


@pytest.mark.parametrize("levels", [[0.0], [1.0, -1.0]])
def test_nothing_stands_for_the_truth_where_all_is_flat(levels):
    assert biases([seen(str(level), 2.0, level, 0.0) for level in levels]) is None


def test_a_flat_mesh_has_nothing_to_compare():
    flat = analytic.saddle(400, k=(0.0, 0.0)).mesh
    found = mesh_chart(flat, "flat", ["ball-jet"], (2.0,), Measuring(repeats=1), None, silent)
    assert found.points == ()
    assert "nothing can stand for the truth" in found.advice.sentence


def test_a_mesh_without_a_face_of_any_area_is_refused():
    line = TriangleMesh([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])
    with pytest.raises(MeshError, match="line: no face has an area"):
        mesh_chart(line, "line", ["ball-jet"], (2.0,), Measuring(), None, silent)
