"""The estimators of other packages: their own numbers, in our sign, order and unit."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from app import samples
from app.loading import load_mesh
from lutcore import analytic
from lutcore.errors import ParameterError
from lutcore.estimation import principal_curvatures
from lutcore.geometry import vertex_areas, vertex_corners
from lutcore.isolated import IsolatedError
from lutcore.mesh import TriangleMesh
from lutcore.progress import silent
from plugins.curvature import _foreign
from plugins.curvature._foreign import foreign
from tests.plugins.known_failures import known_failure

DIRECTIONS = {
    "meshlab-quadric": "Quadric Fitting",
    "meshlab-scaled-quadric": "Scale Dependent Quadric Fitting",
    "meshlab-taubin": "Taubin approximation",
    "meshlab-normal-cycles": "Normal Cycles",
}
FOREIGN = [*DIRECTIONS, "meshlab-discrete", "meshlab-apss", "vtk", "libigl", "trimesh"]
PEERS = [*FOREIGN, "ball-jet", "corrected-curvature"]
SCALE = 0.3


def from_mean_and_gauss(mean, gauss):
    half = np.sqrt(np.maximum(mean**2 - gauss, 0.0))
    return mean + half, mean - half


def raw(method, mesh):
    """The package's own two values and its first direction, called without the plug-in."""
    if method in DIRECTIONS:
        import pymeshlab

        found = []
        for kind in ("Min Curvature", "Max Curvature"):
            meshes = pymeshlab.MeshSet()
            meshes.add_mesh(pymeshlab.Mesh(mesh.vertices, mesh.faces))
            scale = {"scale": pymeshlab.PureValue(SCALE)} if "scaled" in method else {}
            meshes.compute_curvature_principal_directions_per_vertex(
                method=DIRECTIONS[method], curvcolormethod=kind, autoclean=False, **scale
            )
            found.append(meshes.current_mesh().vertex_scalar_array())
        per = 2.0 * vertex_areas(mesh, vertex_corners(mesh)) if "cycles" in method else 1.0
        return found[0] / per, found[1] / per
    if method.startswith("meshlab"):
        import pymeshlab

        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(mesh.vertices, mesh.faces))
        found = []
        if method == "meshlab-apss":
            spacing = np.sqrt(np.median(vertex_areas(mesh, vertex_corners(mesh))))
            for kind in ("K1", "K2"):
                meshes.compute_curvature_and_color_apss_per_vertex(
                    curvaturetype=kind, filterscale=SCALE / spacing
                )
                found.append(meshes.current_mesh().vertex_scalar_array())
            return tuple(found)
        for kind in ("Mean Curvature", "Gaussian Curvature"):
            meshes.compute_scalar_by_discrete_curvature_per_vertex(curvaturetype=kind)
            found.append(meshes.current_mesh().vertex_scalar_array())
        return from_mean_and_gauss(*found)
    if method == "vtk":
        import pyvista as pv

        data = pv.PolyData.from_regular_faces(mesh.vertices, mesh.faces.astype(int))
        return data.curvature("maximum"), data.curvature("minimum")
    if method == "libigl":
        igl = pytest.importorskip("igl")
        spacing = np.sqrt(np.median(vertex_areas(mesh, vertex_corners(mesh))))
        rings = round(SCALE / (1.0746 * spacing))
        return igl.principal_curvature(mesh.vertices, mesh.faces.astype(np.int64), rings)[2:4]
    pytest.importorskip("rtree")
    trimesh = pytest.importorskip("trimesh")
    whole = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    of = trimesh.curvature
    mean = of.discrete_mean_curvature_measure(whole, mesh.vertices, SCALE)
    gauss = of.discrete_gaussian_curvature_measure(whole, mesh.vertices, SCALE)
    # On the unit sphere trimesh's own area of the ball's cap is what measures are divided by.
    cap = of.sphere_ball_intersection(1.0, SCALE)
    return from_mean_and_gauss(mean / cap, gauss / cap)


@pytest.mark.parametrize("method", FOREIGN)
def test_values_are_the_packages_own(method):
    exact = analytic.torus(1_500, irregular=True)
    # The driver hands on centred vertices; the same, so that even rounding agrees.
    points = exact.mesh.vertices
    mesh = TriangleMesh(points - 0.5 * (points.min(axis=0) + points.max(axis=0)), exact.mesh.faces)
    expected = np.sort(raw(method, mesh), axis=0)
    found = principal_curvatures(mesh, method, SCALE)
    # MeshLab computes in single precision, and the driver's centring moves last bits.
    limit = (1e-5 if method.startswith("meshlab") else 1e-9) * np.abs(expected).max()
    if method == "meshlab-apss":
        # From one process to the next, ten vertices of these 1,500 differ by up to 1.4e-4: the
        # projection stops after a step that falls below a threshold or does not.
        limit *= 50.0
    assert_allclose(found.k2, expected[0], atol=limit)
    assert_allclose(found.k1, expected[1], atol=limit)


@pytest.mark.parametrize("shape", ["sphere", "cylinder", "torus", "saddle"])
@pytest.mark.parametrize("method", PEERS)
def test_sign_order_and_unit(method, shape):
    options = {
        "sphere": {"radius": 2.0},
        "cylinder": {"radius": 2.0},
        "torus": {"major": 2.0, "minor": 0.8},
        "saddle": {"k": (1.0, -0.5)},
    }[shape]
    exact = getattr(analytic, shape)(4_000, **options)
    found = principal_curvatures(exact.mesh, method)
    assert (found.k1 >= found.k2).all()
    values = "test_values_signs_and_directions_on_exact_surfaces"
    size = np.abs(exact.truth.k1).max()
    if method == "meshlab-taubin":  # only its mean is right
        assert np.median(np.abs(found.mean - exact.truth.mean)) < 0.15 * size
    elif not known_failure(values, f"{shape}-False-{method}", method) or shape == "torus":
        # A tenth, in the median, which rims do not move; five rings of libigl's are coarse.
        assert np.median(np.abs(found.k1 - exact.truth.k1)) < 0.15 * size
        if method != "meshlab-normal-cycles":
            assert np.median(np.abs(found.k2 - exact.truth.k2)) < 0.15 * size


@pytest.mark.parametrize("method", PEERS)
def test_a_real_scan_gives_values_or_a_stated_refusal(method, monkeypatch):
    mesh = load_mesh(samples.sample("marble-face-raw").path).mesh
    assert len(mesh.vertices) == 85_849
    if method == "meshlab-scaled-quadric":  # minutes, if it ends at all: refused after seconds
        monkeypatch.setattr(_foreign, "_SECONDS", 2.0)
        with pytest.raises(IsolatedError, match="took more than 3 s"):
            principal_curvatures(mesh, method, patience=0.01)
        return
    found = principal_curvatures(mesh, method)
    for values in (found.k1, found.k2):
        assert values.shape == (85_849,)
        assert np.isfinite(values).all()
    # 667 vertices have no face; libigl reports some bad ones.
    missing = np.count_nonzero(~found.estimated)
    assert 667 <= missing < 700 if method == "libigl" else missing == 667


def test_meshlabs_components_do_not_depend_on_curvature_and_are_refused():
    values = []
    for radius, flip in ((1.0, 1), (2.0, 1), (1.0, -1)):
        exact = analytic.sphere(2_000, radius=radius)
        mesh = TriangleMesh(exact.mesh.vertices, exact.mesh.faces[:, ::flip])
        found = foreign(
            *("meshlab_directions", "pymeshlab", mesh, 100.0, silent),
            method="Principal Component Analysis",
            scale=0.3 * radius,
        )
        values.append(np.median(found["min"]))
    # Half the curvature, or its opposite, changes the answer by less than a hundredth.
    assert_allclose(values, values[0], rtol=0.01)
    assert abs(values[0]) > 100.0
    with pytest.raises(ParameterError, match="do not depend on the curvature"):
        principal_curvatures(mesh, "meshlab-pca")


def test_a_filter_that_never_ends_is_stopped(monkeypatch):
    monkeypatch.setattr(_foreign, "_SECONDS", 2.0)
    mesh = TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    with pytest.raises(IsolatedError, match="pymeshlab took more than 2 s"):
        principal_curvatures(mesh, "meshlab-scaled-quadric")


def test_a_crash_is_an_error_and_the_next_call_works():
    flat = analytic.saddle(400).mesh
    twice = TriangleMesh(flat.vertices, np.vstack([flat.faces, flat.faces[:, ::-1]]))
    with pytest.raises(IsolatedError, match=r"libigl crashed on it \(SIG"):
        principal_curvatures(twice, "libigl")
    found = principal_curvatures(analytic.sphere(500).mesh, "libigl", 0.3)
    assert_allclose(found.k1, 1.0, atol=0.1)


@pytest.mark.parametrize("method", ["libigl", "trimesh"])
def test_a_missing_package_is_named_with_the_command(method, monkeypatch):
    monkeypatch.setattr(_foreign, "find_spec", lambda name: None)
    with pytest.raises(ParameterError, match=f"pip install {method}"):
        principal_curvatures(analytic.sphere(100).mesh, method)


@pytest.mark.parametrize("degree", [2, 3])
def test_a_jet_is_exact_on_a_quadric(degree):
    exact = analytic.saddle(2_000, irregular=True, k=(0.8, -0.3))
    found = principal_curvatures(exact.mesh, "ball-jet", 0.2, degree=degree)
    # At the middle the height is the polynomial itself: only rounding is left.
    middle = np.argmin(np.hypot(*exact.mesh.vertices[:, :2].T))
    assert np.hypot(*exact.mesh.vertices[middle, :2]) < 0.05
    inner = np.abs(exact.mesh.vertices[:, :2]).max(axis=1) < 0.75
    # Elsewhere the tilted frame makes higher terms: r^2 k^3 and smaller.
    assert_allclose(found.k1[inner], exact.truth.k1[inner], atol=0.2**2)
    assert_allclose(found.k2[inner], exact.truth.k2[inner], atol=0.2**2)


def test_corrected_measures_converge_with_the_radius():
    exact = analytic.ellipsoid(8_000)
    errors = []
    for radius in (0.1, 0.2):
        found = principal_curvatures(exact.mesh, "corrected-curvature", radius)
        errors.append(np.sqrt(np.mean((found.k1 - exact.truth.k1) ** 2)))
    assert errors[0] < 0.5 * errors[1]  # second order: a quarter, plus what the normals err
