import numpy as np
import pytest

from app import samples
from app.loading import load_mesh
from lutcore.errors import ParameterError


@pytest.mark.parametrize("name", samples.names())
def test_every_sample_loads(name):
    found = samples.sample(name)
    loaded = load_mesh(found.path)
    assert len(loaded.mesh.faces) > 500
    assert found.summary
    assert not found.remark


def test_the_raw_scan_is_whole():
    mesh = load_mesh(samples.sample("marble-face-raw").path).mesh
    assert (len(mesh.vertices), len(mesh.faces)) == (85_849, 166_259)


def test_the_marble_face_has_the_papers_44_thousand_polygons():
    found = samples.sample("marble-face")
    mesh = load_mesh(found.path).mesh
    assert abs(len(mesh.faces) - 44_000) <= 10
    assert found.path.stat().st_size < 1_000_000


@pytest.mark.parametrize("name", ["sphere", "cylinder", "torus", "saddle", "ellipsoid"])
def test_exact_curvature_stands_beside_the_shapes(name):
    found = samples.sample(name)
    mesh = load_mesh(found.path).mesh
    with np.load(found.exact) as exact:
        assert exact["k1"].shape == exact["k2"].shape == (len(mesh.vertices),)
        assert (exact["k1"] >= exact["k2"]).all()
        np.testing.assert_allclose(
            np.einsum("ij,ij->i", exact["d1"], exact["normals"]), 0.0, atol=1e-6
        )


def test_the_prefix_may_be_given_or_left_out():
    assert samples.sample("sample:torus") == samples.sample("torus")


def test_an_unknown_sample_is_refused_with_the_nearest():
    with pytest.raises(ParameterError, match="did you mean 'bunny'"):
        samples.sample("buny")


def test_without_the_scan_in_the_wheel_the_committed_copy_serves_and_says_so(monkeypatch):
    monkeypatch.setattr(samples, "find_spec", lambda package: None)
    found = samples.sample("marble-face-raw")
    assert found.path == samples.sample("marble-face").path
    assert "no more" in found.remark
    with pytest.raises(ParameterError, match="pymeshlab"):
        samples.sample("bunny")
