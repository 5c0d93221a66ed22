import numpy as np
import pytest
import pyvista
import trimesh

from app.export import columns, curvature_arrays, save, shading_arrays
from app.loading import load_mesh
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import ParameterError
from lutcore.mesh import TriangleMesh

MESH = TriangleMesh([[0, 0, 1e6], [1, 0, 1e6], [0, 1, 1e6], [9, 9, 9]], [[0, 1, 2]])
RANDOM = np.random.default_rng(0)
CURVATURES = PrincipalCurvatures(
    *(RANDOM.random(4) for _ in range(2)),
    *(RANDOM.random((4, 3)) for _ in range(3)),
    np.array([0.1, 0.2, 0.3, np.inf]),
    0.0,
)
NAMES = {
    "k1",
    "k2",
    "d1",
    "d2",
    "mean_curvature",
    "gauss_curvature",
    "shape_index",
    "curvedness",
    "curvature_error",
    "k1_error",
    "k2_error",
    "curvature_scale",
}


@pytest.fixture
def arrays():
    return curvature_arrays(CURVATURES) | shading_arrays(RANDOM.random((4, 3)), 1.0)


def test_the_names_scripts_rely_on(arrays):
    assert set(arrays) == NAMES | {"shading", "shading_srgb"}
    assert arrays["shading"].dtype == np.float32
    assert arrays["shading_srgb"].dtype == np.uint8


def test_a_scale_is_one_number_a_vertex_and_a_disagreement_comes_where_there_is_one():
    spread = RANDOM.random(4)
    found = curvature_arrays(CURVATURES, spread)
    np.testing.assert_array_equal(found["curvature_scale"], np.zeros(4))
    np.testing.assert_array_equal(found["curvature_disagreement"], spread)
    assert set(found) == NAMES | {"curvature_disagreement"}


def test_npz_keeps_every_array_exactly(tmp_path, arrays):
    save(tmp_path / "x.npz", MESH, arrays)
    with np.load(tmp_path / "x.npz") as found:
        assert set(found) == set(arrays) | {"vertices", "faces"}
        for name, array in arrays.items():
            np.testing.assert_array_equal(found[name], array)


def test_vtp_keeps_every_array_exactly(tmp_path, arrays):
    save(tmp_path / "x.vtp", MESH, arrays)
    found = pyvista.read(tmp_path / "x.vtp")
    for name, array in arrays.items():
        np.testing.assert_array_equal(found[name], array)
    np.testing.assert_array_equal(found.points, MESH.vertices)


def test_ply_is_read_by_others_with_positions_and_values(tmp_path, arrays):
    save(tmp_path / "x.ply", MESH, arrays)
    peer = trimesh.load(tmp_path / "x.ply", process=False)
    np.testing.assert_array_equal(peer.vertices, MESH.vertices)
    np.testing.assert_array_equal(peer.faces, MESH.faces)
    np.testing.assert_allclose(
        np.ravel(peer.metadata["_ply_raw"]["vertex"]["data"]["k1"]), CURVATURES.k1, rtol=1e-7
    )
    ours = load_mesh(tmp_path / "x.ply")
    np.testing.assert_array_equal(ours.mesh.vertices, MESH.vertices)
    np.testing.assert_array_equal(np.rint(255.0 * ours.colors), arrays["shading_srgb"])


def test_csv_has_a_heading_and_a_row_for_each_vertex(tmp_path, arrays):
    save(tmp_path / "x.csv", MESH, arrays)
    found = np.genfromtxt(tmp_path / "x.csv", delimiter=",", names=True)
    assert len(found) == 4
    np.testing.assert_allclose(found["k1"], CURVATURES.k1, rtol=1e-8)
    np.testing.assert_allclose(found["d2_z"], CURVATURES.d2[:, 2], rtol=1e-8)
    assert np.isinf(found["curvature_error"][3])


def test_vectors_are_taken_apart_by_axis_and_colours_by_channel(arrays):
    flat = columns(arrays)
    assert {"d1_x", "d1_y", "d1_z", "shading_r", "shading_srgb_b"} < set(flat)
    assert all(array.shape == (4,) for array in flat.values())


def test_an_ending_that_cannot_be_written_is_refused(tmp_path, arrays):
    with pytest.raises(ParameterError, match="output format"):
        save(tmp_path / "x.docx", MESH, arrays)
    assert not list(tmp_path.iterdir())
