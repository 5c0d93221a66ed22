from dataclasses import replace

import numpy as np
import pytest

from lutcore.analytic import cylinder, saddle, sphere, torus
from lutcore.diagnostics import diagnose, vertex_scales
from lutcore.estimation import principal_curvatures
from lutcore.mesh import TriangleMesh


def test_a_closed_surface_is_all_interior_and_obeys_gauss_and_bonnet():
    exact = sphere(3000)
    found = diagnose(exact.mesh, exact.truth)
    assert found.interior.all()
    assert not (found.border.any() or found.debris.any())
    assert found.angle_defect == pytest.approx(4.0 * np.pi, rel=1e-9)
    # The polyhedron's area is short of the sphere's by some 1/count.
    assert found.gauss_bonnet_residual < 2e-3


def test_a_torus_has_no_total_curvature():
    exact = torus(3000)
    found = diagnose(exact.mesh, exact.truth)
    assert found.angle_defect == pytest.approx(0.0, abs=1e-8)
    assert found.gauss_bonnet_residual < 2e-3


def test_a_wrong_scale_shows_in_the_residual():
    exact = sphere(3000)
    doubled = principal_curvatures(TriangleMesh(exact.mesh.vertices * 0.5, exact.mesh.faces))
    assert diagnose(exact.mesh, doubled).gauss_bonnet_residual > 0.5


def test_an_open_surface_is_judged_inside_its_rim():
    exact = saddle(3000, k=(-0.5, 0.5))
    found = diagnose(exact.mesh, exact.truth)
    rim = (np.abs(exact.mesh.vertices[:, :2]) > 1.0 - 1e-9).any(axis=1)
    np.testing.assert_array_equal(found.border, rim)  # the truth has scale 0
    # A regular grid's rim cells are half counted: one row of 55.
    assert found.gauss_bonnet_residual < 0.05


def test_the_border_is_as_wide_as_the_scale():
    exact = cylinder(3000, length=4.0)
    measured = principal_curvatures(exact.mesh, method="co-smoothing", scale=0.5)
    found = diagnose(exact.mesh, measured)
    height = exact.mesh.vertices[:, 2]
    from_rim = np.minimum(height - height.min(), height.max() - height)
    assert found.border[from_rim < 0.45].all()
    assert not found.border[from_rim > 0.55].any()


def test_the_border_is_as_wide_as_each_vertexs_own_scale():
    exact = cylinder(3000, length=4.0)
    x, _, height = exact.mesh.vertices.T
    scales = np.where(x > 0.0, 0.8, 0.3)
    found = diagnose(exact.mesh, replace(exact.truth, scale=scales))
    from_rim = np.minimum(height - height.min(), height.max() - height)
    # The nearest rim vertex is not always straight below: it is within half a spacing of that.
    aside = 0.1
    for side, reach in ((x > 0.1, 0.8), (x < -0.1, 0.3)):
        assert found.border[side & (from_rim < reach - aside)].all()
        assert not found.border[side & (from_rim > reach)].any()


def test_one_scale_for_all_is_each_vertexs_scale():
    truth = sphere(500).truth
    np.testing.assert_array_equal(vertex_scales(truth), np.zeros(len(truth.k1)))
    each = np.arange(float(len(truth.k1)))
    np.testing.assert_array_equal(vertex_scales(replace(truth, scale=each)), each)


def test_groups_without_vertices_are_not_listed():
    exact = sphere(500)
    assert list(diagnose(exact.mesh, exact.truth).groups) == ["interior"]


def test_debris_and_unused_vertices_are_kept_apart():
    body = sphere(2000).mesh
    count = len(body.vertices)
    crumb = np.array([[9.0, 0, 0], [9, 0.1, 0], [9, 0, 0.1], [50, 50, 50]])
    mesh = TriangleMesh(
        np.concatenate([body.vertices, crumb]),
        np.concatenate([body.faces, [[count, count + 1, count + 2]]]),
    )
    found = diagnose(mesh, principal_curvatures(mesh, method="rusinkiewicz2004"))
    assert found.debris[count : count + 3].all()
    assert not (found.interior | found.border | found.debris)[-1]
    assert found.interior[:count].all()


def test_noise_drowns_flat_parts_below_their_error():
    exact = saddle(4000, k=(-1e-3, 1e-3))
    noisy = exact.noisy(0.3)
    # The larger of two errors is above one sigma more often than not, so the share stays small.
    assert diagnose(noisy, principal_curvatures(noisy)).below_error > 0.05
    assert diagnose(exact.mesh, exact.truth).below_error == 0.0
