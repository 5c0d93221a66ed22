import dataclasses

import numba
import numpy as np
import pytest

from lutcore import analytic
from lutcore.diffusion import diffusion_profile, optics
from lutcore.errors import CancelledError
from lutcore.fresnel import transmittance
from lutcore.gather.entering import at_vertices, surface
from lutcore.gather.exitance import exact, gathered
from lutcore.gather.kernel import kernel, place, radial
from lutcore.gather.octree import octree
from lutcore.gather.patches import _lift, patches, power_of
from lutcore.geometry import area_normals, face_areas, vertex_areas, vertex_corners
from lutcore.lights import DirectionalLight, PointLight, pack
from lutcore.materials import material
from lutcore.mesh import TriangleMesh
from lutcore.shading import ShadingInputs
from tests.quadrature import dipole, sphere_exitance

ABOVE = DirectionalLight((0.0, 0.0, 1.0))
COLORED = [
    DirectionalLight((1.0, 0.3, 0.5), (1.0, 0.1, 0.1)),
    PointLight((-60.0, 20.0, 40.0), (300.0, 2000.0, 4000.0)),
]
DEFAULT = 0.005


def inputs_of(mesh, normals, lights=(ABOVE,), substance="skin1", profile="jensen2001", **more):
    return ShadingInputs(
        points=mesh.vertices,
        normals=normals,
        shape=np.zeros((len(mesh.vertices), 6)),
        lights=pack(lights),
        material=material(substance),
        profile=diffusion_profile(profile),
        faces=mesh.faces,
        mm_per_unit=more.pop("mm_per_unit", 1.0),
        **more,
    )


def relative(found, truth):
    """Root mean square error over the root mean square, the worst channel's."""
    return (np.linalg.norm(found - truth, axis=0) / np.linalg.norm(truth, axis=0)).max()


def plate(size, height=0.0):
    points = [[-size, -size, height], [size, -size, height], [size, size, height]]
    mesh = TriangleMesh([*points, [-size, size, height]], [[0, 1, 2], [0, 2, 3]])
    return mesh, np.tile([0.0, 0.0, 1.0], (4, 1))


@pytest.mark.parametrize("name", ["skin1", "marble"])
def test_the_table_is_the_profile(name):
    substance = material(name)
    known = radial(diffusion_profile("jensen2001"), substance, 30.0)
    table = kernel(known, np.ones(3))
    r = np.geomspace(1e-4, 30.0, 3001)
    at, share = np.transpose([place(x * x, table.inner, table.first) for x in r])
    rows = table.rows[at.astype(int)]
    powers = share[:, None] ** np.arange(4.0)
    found = np.einsum("npc,np->nc", rows, powers)
    np.testing.assert_array_equal(found[:, 3], 0.0)
    for channel, (length, one) in enumerate(
        zip(substance.mean_free_path, optics(substance), strict=True)
    ):
        truth = dipole(r / length, one) / length**2
        # Cubic with 16 knots to an octave: (1/16)^4/384 = 4e-8 times (r/2 l_d)^4, some thousands
        # at r = 20 l_d.
        near = truth > 1e-9 * truth[0]
        np.testing.assert_allclose(found[near, channel], truth[near], rtol=3e-4)
        np.testing.assert_allclose(found[r < 3.0 * length, channel], truth[r < 3.0 * length], 4e-6)


@pytest.mark.parametrize("name", ["skin1", "marble"])
@pytest.mark.parametrize("profile", ["jensen2001", "burley2015"])
def test_two_triangles_have_the_flat_limit(name, profile):
    # Hundreds of times as large as l_u, and seen in the middle of one of them.
    mesh, normals = plate(300.0)
    inputs = inputs_of(mesh, normals, substance=name, profile=profile)
    found = exact(inputs, [[90.0, -120.0, 0.0], [0.0, 0.0, 0.0]])
    total = [inputs.profile.total(one) for one in optics(inputs.material)]
    expected = np.array(total) * transmittance(1.0, np.array(inputs.material.eta))
    # What lies beyond 180 mm gives less than exp(-180/l_d) of it. A profile that is infinite at 0
    # is cut off at a thousandth of l_u, which holds about a thousandth of it.
    np.testing.assert_allclose(found, np.tile(expected, (2, 1)), rtol=2e-3)


@pytest.mark.parametrize(("name", "radius"), [("skin1", 4.0), ("skin1", 38.0), ("marble", 10.0)])
def test_on_a_fine_sphere_it_is_the_integral_over_the_true_one(name, radius):
    body = analytic.sphere(8_000, radius=radius)
    inputs = inputs_of(body.mesh, body.truth.normals, substance=name)
    some = np.arange(0, 8_000, 250)
    found = exact(inputs, body.mesh.vertices[some])
    lengths = inputs.material.mean_free_path
    truth = np.stack(
        [
            sphere_exitance(body.truth.normals[some, 2], radius / length, one)
            for length, one in zip(lengths, optics(inputs.material), strict=True)
        ],
        axis=1,
    )
    # Flat triangles have an area of 1 - h^2/(4 R^2) = .9995 of the sphere's, light linear to half
    # a percent of the mean is off by a sixth of that.
    assert relative(found, truth) < 1.5e-3
    assert relative(gathered(inputs, DEFAULT)[some], truth) < DEFAULT + 1.5e-3


def noisy():
    mesh = analytic.torus(5_000, major=20.0, minor=8.0).noisy(0.1)
    return mesh, area_normals(mesh, vertex_corners(mesh))


@pytest.mark.parametrize("name", ["skin1", "marble"])
def test_clusters_are_within_the_tolerance_of_brute_force(name):
    torus = analytic.torus(5_000, major=20.0, minor=8.0)
    for mesh, normals in ((torus.mesh, torus.truth.normals), noisy()):
        inputs = inputs_of(mesh, normals, COLORED, name)
        some = np.arange(0, len(mesh.vertices), 40)
        truth = exact(inputs, mesh.vertices[some])
        coarse, fine = gathered(inputs, DEFAULT)[some], gathered(inputs, 0.1 * DEFAULT)[some]
        assert relative(coarse, truth) < DEFAULT
        assert (np.abs(coarse - truth).max(axis=0) < 2.0 * DEFAULT * truth.max(axis=0)).all()
        assert relative(fine, truth) < 0.1 * DEFAULT


def test_brute_force_converges():
    mesh, normals = noisy()
    inputs = inputs_of(mesh, normals, COLORED)
    points = mesh.vertices[::250]
    fine = exact(inputs, points, 1e-3)
    assert relative(exact(inputs, points), fine) < 1e-4
    assert relative(exact(inputs, points, 10.0), fine) > relative(exact(inputs, points), fine)


def test_moments_of_a_cluster_are_those_of_its_patches():
    mesh, normals = noisy()
    of = patches(inputs_of(mesh, normals, COLORED))
    tree = octree(of)
    # Light is linear: products of it with up to two coordinates are exact by degree 3.
    share = np.array([[1, 1, 1], [1.8, 0.6, 0.6], [0.6, 1.8, 0.6], [0.6, 0.6, 1.8]]) / 3.0
    weight = np.array([-27.0, 25.0, 25.0, 25.0]) / 48.0
    crosses = np.cross(of.corners[:, 1] - of.corners[:, 0], of.corners[:, 2] - of.corners[:, 0])
    area = 0.5 * np.linalg.norm(crosses, axis=1)
    points = np.einsum("qj,pjx->pqx", share, of.corners) - tree.ball[0, :3]
    light = np.einsum("q,qj,pjc,p->pqc", weight, share, of.light, area)
    # Moments are kept in single precision, rounded once.
    rounded = 2.0**-24
    found = tree.terms[0, :, :3].T
    np.testing.assert_allclose(found[:, 0], light.sum(axis=(0, 1)), rtol=rounded)
    first = np.einsum("pqc,pqx->cx", light, points)
    second = np.einsum("pqc,pqx,pqy->cxy", light, points, points)
    np.testing.assert_allclose(found[:, 1:4], first, rounded, 1e-9 * np.abs(second).max())
    rows, columns = [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]
    np.testing.assert_allclose(found[:, 4:], second[:, rows, columns], rtol=1e-9 + rounded)
    np.testing.assert_array_equal(tree.terms[:, :, 3], 0.0)
    distance = np.linalg.norm(of.corners - tree.ball[0, :3], axis=2)
    assert tree.ball[0, 3] == pytest.approx(distance.max() ** 2)
    assert tree.skip[0] == len(tree.skip)


def test_lights_add_and_units_do_not_matter():
    mesh, normals = noisy()
    together = gathered(inputs_of(mesh, normals, COLORED), DEFAULT)
    apart = sum(gathered(inputs_of(mesh, normals, [one]), DEFAULT) for one in COLORED)
    assert relative(apart, together) < DEFAULT
    small = TriangleMesh(mesh.vertices / 2.5, mesh.faces)
    again = gathered(inputs_of(small, normals, COLORED[:1], mm_per_unit=2.5), DEFAULT)
    np.testing.assert_allclose(
        again, gathered(inputs_of(mesh, normals, COLORED[:1]), DEFAULT), 1e-9
    )


@pytest.mark.parametrize("name", ["skin1", "marble", "spectralon"])
def test_no_more_light_leaves_than_enters(name):
    for radius in (1.0, 5.0, 40.0):
        body = analytic.sphere(2_000, radius=radius)
        inputs = inputs_of(body.mesh, body.truth.normals, substance=name)
        left = gathered(inputs, DEFAULT)
        assert (left >= 0.0).all()
        areas = vertex_areas(body.mesh, vertex_corners(body.mesh))
        lit = np.maximum(body.truth.normals[:, 2], 0.0)
        entered = areas @ (lit * transmittance(lit, inputs.material.eta[0]))
        # R integrated over a sphere is R integrated over a disk of its diameter: R_d at most.
        total = [inputs.profile.total(one) for one in optics(inputs.material)]
        assert (areas @ left <= entered * np.array(total) * (1.0 + 0.5 * DEFAULT)).all()


def test_shares_of_visibility_multiply_what_enters():
    mesh, normals = noisy()
    count = len(mesh.vertices)
    open_ = gathered(inputs_of(mesh, normals, COLORED), DEFAULT)
    half = np.full((2, count), 0.5)
    found = gathered(inputs_of(mesh, normals, COLORED, visibility=half), DEFAULT)
    np.testing.assert_allclose(found, 0.5 * open_)
    tinted = np.stack([np.ones((count, 3)), np.tile([1.0, 0.5, 0.0], (count, 1))])
    found = gathered(inputs_of(mesh, normals, COLORED, visibility=tinted), DEFAULT)
    first = gathered(inputs_of(mesh, normals, COLORED[:1]), DEFAULT)
    assert relative(found[:, :1], open_[:, :1]) < DEFAULT
    assert relative(found[:, 2:], first[:, 2:]) < DEFAULT


def test_where_nothing_enters_nothing_leaves():
    mesh, normals = plate(5.0)
    below = DirectionalLight((0.0, 0.0, -1.0))
    for inputs in (inputs_of(mesh, normals, [below]), inputs_of(mesh, normals, [])):
        np.testing.assert_array_equal(gathered(inputs, DEFAULT), 0.0)
        np.testing.assert_array_equal(exact(inputs, mesh.vertices), 0.0)
    unknown = inputs_of(mesh, np.zeros((4, 3)))
    np.testing.assert_array_equal(gathered(unknown, DEFAULT), 0.0)


def test_triangles_without_an_area_change_nothing():
    body = analytic.sphere(500, radius=10.0)
    more = np.concatenate([body.mesh.faces, [[7, 7, 8], [9, 9, 9]]])
    inputs = inputs_of(body.mesh, body.truth.normals)
    padded = dataclasses.replace(inputs, faces=TriangleMesh(inputs.points, more).faces)
    assert relative(gathered(padded, DEFAULT), gathered(inputs, DEFAULT)) < DEFAULT
    points = body.mesh.vertices[::100]
    np.testing.assert_allclose(exact(padded, points), exact(inputs, points), rtol=1e-9)


def test_the_number_of_threads_changes_no_bit():
    mesh, normals = noisy()
    inputs = inputs_of(mesh, normals, COLORED)
    before = numba.get_num_threads()
    whole = gathered(inputs, DEFAULT)
    try:
        numba.set_num_threads(1)
        np.testing.assert_array_equal(gathered(inputs, DEFAULT), whole)
    finally:
        numba.set_num_threads(before)


@pytest.mark.parametrize(
    "step", ["sampling the light that enters", "building the octree", "gathering light"]
)
def test_it_can_be_cancelled(step):
    mesh, normals = plate(5.0)
    inputs = inputs_of(mesh, normals, progress=lambda share, now: now != step)
    with pytest.raises(CancelledError, match=step):
        gathered(inputs, DEFAULT)


def test_patches_of_a_rough_surface_keep_its_power():
    mesh = analytic.torus(3_000, major=8.0, minor=3.0).noisy(0.1)
    inputs = inputs_of(mesh, area_normals(mesh, vertex_corners(mesh)), COLORED)
    fine, coarse = patches(inputs), patches(inputs, DEFAULT)
    assert len(coarse.light) < 0.6 * len(fine.light)
    truth, found = (power_of(*one)[0] for one in (fine, coarse))
    light = at_vertices(surface(inputs))
    linear = (face_areas(mesh)[:, None] * light[mesh.faces].mean(axis=1)).sum(axis=0)
    # Exact to the second order, and so far better than what the corners alone tell: of either sign
    # over the triangles, it cancels in part.
    assert np.abs(found / truth - 1.0).max() < 0.25 * np.abs(linear / truth - 1.0).max()


@pytest.mark.parametrize("tolerance", [1e-4, 1e-3])
def test_a_coarse_body_that_light_crosses_keeps_the_tolerance(tolerance):
    # l_u is 13 mesh units, the tube 4 thick, and its triangles 3 long.
    mesh = analytic.torus(200, major=10.0, minor=4.0).mesh
    normals = area_normals(mesh, vertex_corners(mesh))
    inputs = inputs_of(mesh, normals, COLORED, mm_per_unit=0.05)
    assert relative(gathered(inputs, tolerance), exact(inputs, mesh.vertices)) < tolerance


def test_patches_that_are_dark_but_for_a_corner_stay_so():
    part = np.zeros((3, 5))
    part[0, 2], part[:, 3] = 1.0, 0.5
    # In red the middles of the edges are dark: all three lie 1/3 below what the corners tell.
    assert _lift(part, np.array([-1.0 / 3.0, 0.0, 0.0]))
    np.testing.assert_allclose(part[:, 2], 0.0, atol=1e-15)
    np.testing.assert_array_equal(part[:, 3], 0.5)
