"""That the measurements of curvature run, and measure what they say, on tiny meshes."""

import numpy as np
import pytest

from lutcore.analytic import saddle, torus
from lutcore.estimation import principal_curvatures
from tests.bench import bandwidth, error_bars, growth, steadiness


def test_the_bars_of_a_smooth_torus_are_judged_by_surface_and_noise():
    interior, border, lost = error_bars.measured(error_bars.TUNED, ("torus",), 0.05)
    assert len(interior) == 2 * len(error_bars.NOISES)
    assert not border
    assert lost == 0
    total = error_bars.totals(interior)
    assert set(total) == {*error_bars.NOISES, "all"}
    mean = np.mean([row["k1 within 1"] for row in interior.values()])
    assert total["all"]["k1 within 1"] == pytest.approx(mean)


def test_correlated_noise_has_the_size_and_the_length_it_says():
    exact = torus(4000)
    edges = exact.mesh.vertices[exact.mesh.faces]
    lengths = np.linalg.norm(edges - np.roll(edges, 1, axis=1), axis=2)
    moved = error_bars.correlated(exact, 0).vertices - exact.mesh.vertices
    offset = np.einsum("ij,ij->i", moved, exact.truth.normals)
    np.testing.assert_allclose(offset[:, None] * exact.truth.normals, moved, atol=1e-12)
    assert offset.std() == pytest.approx(error_bars.CORRELATED * lengths.mean(), rel=1e-6)
    ends = offset[exact.mesh.faces]
    along = np.mean(ends * np.roll(ends, 1, axis=1)) / offset.var()
    assert 0.6 < along < 0.95  # a Gauss kernel of 1.5 edges: exp(-1/(4 x 1.5^2)) = .89


def test_vertices_near_the_rim_are_told_from_those_inside():
    exact = saddle(2000)
    found = principal_curvatures(exact.mesh, "rusinkiewicz2004")
    points = np.abs(exact.mesh.vertices[:, :2]).max(axis=1)
    np.testing.assert_array_equal(error_bars.near_rim(exact.mesh, found), points > 1.0 - 1e-9)


def test_every_stage_of_auto_is_seen_and_takes_the_time_of_the_call():
    found = bandwidth.report(2000, 2, 100_000)
    assert set(found["stages"]) == {*bandwidth.STAGES, "a product", "arrangement"}
    assert 0.3 < found["share_of_time_seen"] <= 1.0
    moved = {name: row["bytes_per_vertex_and_call"] for name, row in found["stages"].items()}
    # Positions and faces in (24 + 2 x 12 bytes), centred positions and the index out (24 + 4).
    assert moved["weld"] == pytest.approx(76.0, rel=0.01)
    assert moved["rungs"] == 0.0
    assert moved["low_pass"] > 10.0 * moved["a product"] > 0.0


def test_bytes_count_an_array_once_and_twice_where_it_is_rewritten():
    a, b = np.zeros(10), np.zeros(4, np.float32)
    assert bandwidth.rewriting()((a, b, a, 3.0), (b, np.zeros(2))) == 80 + 16 + 16
    assert bandwidth.rewriting(1)((a, b), None) == 80 + 2 * 16
    assert bandwidth.size(np.broadcast_to(1.0, 1000)) == 8


def test_growth_is_told_over_the_first_size():
    meshes = {"small": torus(500).mesh, "shuffled": growth.shuffled(torus(500).mesh)}
    found = growth.times_per_vertex(meshes, 1)
    assert all(np.isfinite(value) for row in found.values() for value in row.values())
    first, other = (np.sort(mesh.vertices, axis=0) for mesh in meshes.values())
    np.testing.assert_array_equal(first, other)


def test_the_change_of_curvature_is_over_the_median_of_the_vertices_in_use():
    still = np.array([2.0, 2.0, 2.0, 0.0]), np.array([2.0, -2.0, 2.0, 0.0])
    moved = np.array([2.0, 2.0, 4.0, 0.0]), np.array([2.0, -2.0, 4.0, 0.0])
    found = steadiness.change(still, moved, np.array([True, True, True, False]))
    assert found["rms"] == pytest.approx(np.sqrt(1.0 / 3.0))
    assert found["median"] == 0.0
    assert found["rms of calmest 99 %"] == 0.0


def test_an_estimator_that_takes_too_long_is_left_out():
    table = steadiness.changes(torus(500).mesh, 0.0, 0)
    assert "more than 0 s" in table["auto"]["stopped"]
