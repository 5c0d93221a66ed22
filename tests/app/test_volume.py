import json

import numpy as np
import pytest

from app.cli.main import main
from app.loading import load_mesh
from app.pipeline import Pipeline
from app.session import Session, Volume, from_json, replaced, to_json
from app.volume import load_surface, source_of
from lutcore.connectivity import connectivity
from lutcore.errors import ParameterError
from lutcore.estimation import principal_curvatures
from lutcore.mesh import TriangleMesh
from lutcore.weld import weld
from tests import volume_files
from tests.volume_files import MIDDLE, RADIUS, SPACING, affine_of, ball, ring, rotation

SHAPE = (34, 24, 18)
# Marching cubes takes the values to be linear along an edge of length h. Those of the ball are its
# distance r, whose second derivative along any line is at most 1/r: off by h^2 / 8r at most, and
# always inwards. The longest edge is 1 mm.
LONGEST = max(SPACING)
DEPTH = LONGEST**2 / (8.0 * (RADIUS - LONGEST))
AT_ZERO = Volume(level=0.0)
TURNED = affine_of(rotation(), SHAPE)
MIRRORED = affine_of(rotation() * [-1.0, 1.0, 1.0], SHAPE)
STRAIGHT = affine_of(np.eye(3), SHAPE)


def surface(path, volume=AT_ZERO):
    return load_surface(source_of(path), volume)


def enclosed(mesh):
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces] - mesh.vertices.mean(axis=0), 1, 0)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0


WRITERS = {
    "a.nii": lambda path, affine: volume_files.nifti(path, ball(affine), affine),
    "b.nii.gz": lambda path, affine: volume_files.nifti(path, ball(affine), affine, second=True),
    "a.mha": lambda path, affine: volume_files.metaimage(path, ball(affine), affine, packed=True),
    "a.mhd": lambda path, affine: volume_files.metaimage(path, ball(affine), affine),
    "a.vti": lambda path, affine: volume_files.vti(path, ball(affine), affine),
    "cells.vti": lambda path, affine: volume_files.vti(path, ball(affine), affine, cells=True),
    "text.vti": lambda path, affine: volume_files.vti(path, ball(affine), affine, binary=False),
}


@pytest.mark.parametrize("affine", [TURNED, MIRRORED], ids=["turned", "mirrored"])
@pytest.mark.parametrize("name", WRITERS)
def test_a_ball_lies_where_its_file_puts_it(tmp_path, name, affine):
    WRITERS[name](tmp_path / name, affine)
    loaded = surface(tmp_path / name)
    radii = np.linalg.norm(loaded.mesh.vertices - MIDDLE, axis=1)
    rounding = 1e-5  # of float32 in the header and the vertices
    assert radii.max() <= RADIUS + rounding
    assert radii.min() >= RADIUS - DEPTH - rounding
    # Outward normals enclose a positive volume: that of the ball, less a chord's sagitta.
    assert enclosed(loaded.mesh) == pytest.approx(4.0 / 3.0 * np.pi * RADIUS**3, rel=0.02)
    # VTI states no unit of length.
    assert loaded.mm_per_unit == (None if name.endswith("vti") else 1.0)
    assert "34 x 24 x 18 voxels, 0.5 x 0.75 x 1 m" in loaded.warnings[0]


@pytest.mark.parametrize("kind", ["imagej", "ome", "plain", "deflate", "folder"])
def test_a_stack_of_pages_has_the_spacing_that_it_states(tmp_path, kind):
    stated = kind in ("imagej", "ome")
    values, path = ball(STRAIGHT), tmp_path / "a.tif"
    if kind == "folder":
        path = tmp_path / "scan"
        path.mkdir()
        for number, layer in enumerate(np.moveaxis(values, 2, 0)):
            # Without leading zeros: 10 comes after 9.
            volume_files.tiff(path / f"slice {number}.tif", layer, "plain")
        (path / "notes.txt").write_text("not a slice")
    elif kind == "deflate":
        volume_files.tiff(path, values, kind, compression="zlib")
    else:
        volume_files.tiff(path, values, kind)
    loaded = surface(path)
    spacing = np.array(SPACING if stated else (1.0, 1.0, 1.0))
    middle = (np.array(SHAPE) - 1.0) / 2.0 * spacing
    radii = np.linalg.norm((loaded.mesh.vertices - middle) / spacing * SPACING, axis=1)
    assert np.all(np.abs(radii - RADIUS) <= DEPTH + 1e-5)
    assert enclosed(loaded.mesh) > 0.0
    assert loaded.mm_per_unit == (1.0 if stated else None)
    assert any("states no spacing" in line for line in loaded.warnings) is not stated


def test_curvature_of_a_ball_is_one_over_its_radius(tmp_path):
    WRITERS["a.nii"](tmp_path / "a.nii", MIRRORED)
    found = principal_curvatures(surface(tmp_path / "a.nii").mesh)
    mean = 0.5 * (found.k1 + found.k2)
    # The vertices are of balls between RADIUS - DEPTH and RADIUS: so is the median's.
    assert 1.0 - DEPTH / RADIUS < np.median(mean) * RADIUS < 1.0 + 2.0 * DEPTH / RADIUS
    assert np.mean(np.abs(mean - 1.0 / RADIUS) <= 3.0 * found.error) > 0.99
    assert np.all(found.k2 > 0.0)


def test_a_torus_is_a_saddle_inside_and_convex_outside(tmp_path):
    major, minor, shape = 5.0, 2.0, (33, 23, 9)
    affine = affine_of(np.eye(3), shape)
    volume_files.metaimage(tmp_path / "a.mha", ring(affine, major, minor, shape), affine)
    mesh = surface(tmp_path / "a.mha").mesh
    assert len(mesh.vertices) - len(mesh.faces) // 2 == 0  # Euler's number of a torus
    found = principal_curvatures(mesh)
    out = np.hypot(*(mesh.vertices - MIDDLE)[:, :2].T) - major
    truth = out / minor / (major + out)  # of the parallels; of the meridians 1 / minor
    off = np.maximum(np.abs(found.k1 - 1.0 / minor), np.abs(found.k2 - truth))
    assert np.mean(off <= 3.0 * found.error) > 0.95
    assert np.all(found.k2[out < -0.7 * minor] < 0.0)
    assert np.all(found.k2[out > 0.7 * minor] > 0.0)


def stored(path, kind=np.int16):
    values = np.clip(np.rint(100.0 * ball(STRAIGHT)), -300, 300).astype(kind)
    volume_files.nifti(path, values, STRAIGHT)
    return values


def test_otsu_finds_the_level_between_two_kinds_of_voxel(tmp_path):
    inside = ball(STRAIGHT) > 0.0
    noise = np.random.default_rng(0).normal(0.0, 20.0, SHAPE)
    values = (np.where(inside, 400.0, -100.0) + noise).astype(np.int16)
    volume_files.nifti(tmp_path / "a.nii", values, STRAIGHT)
    loaded = surface(tmp_path / "a.nii", Volume())
    assert "Otsu" in loaded.warnings[0]
    # Any level from -100 + 5 sigma to 400 - 5 sigma parts them.
    level = float(loaded.warnings[0].split("level ")[1].split()[0])
    assert 0.0 < level < 300.0


def test_a_mask_is_cut_half_way_and_said_to_be_a_staircase(tmp_path):
    mask = (ball(STRAIGHT) > 0.0).astype(np.uint8)
    volume_files.nifti(tmp_path / "a.nii", mask, STRAIGHT)
    stairs = surface(tmp_path / "a.nii", Volume())
    assert "level 0.5 (Otsu" in stairs.warnings[0]
    assert "staircase" in stairs.warnings[1]
    smooth = surface(tmp_path / "a.nii", Volume(smoothing=1.0))
    assert "smoothing by 1 voxels" in smooth.warnings[0]
    assert len(smooth.warnings) == 1

    def roughness(mesh):
        radii = np.linalg.norm(mesh.vertices - MIDDLE, axis=1)
        return radii.std()

    assert roughness(smooth.mesh) < 0.5 * roughness(stairs.mesh)


def test_a_level_that_meets_voxels_leaves_a_closed_surface(tmp_path):
    values = stored(tmp_path / "a.nii")
    level = float(values[17, 12, 3])
    assert -300 < level < 300
    mesh = surface(tmp_path / "a.nii", Volume(level=level)).mesh
    ready = weld(mesh).mesh
    assert connectivity(ready).boundary_edges == 0
    assert len(ready.faces) == len(mesh.faces)
    assert np.all(np.isfinite(principal_curvatures(mesh).k1))


def test_voxels_without_a_value_leave_a_hole(tmp_path):
    values = ball(STRAIGHT)
    values[:, :, 12:] = np.nan
    values[0, 0, 0] = np.inf
    volume_files.nifti(tmp_path / "a.nii", values, STRAIGHT)
    for smoothing in (0.0, 0.6):
        loaded = surface(tmp_path / "a.nii", Volume(0.0, smoothing))
        assert f"{34 * 24 * 6 + 1} of {values.size} voxels have no finite" in loaded.warnings[1]
        highest = (STRAIGHT @ [0.0, 0.0, 11.0, 1.0])[2]
        assert loaded.mesh.vertices[:, 2].max() == pytest.approx(highest)
        radii = np.linalg.norm(loaded.mesh.vertices - MIDDLE, axis=1)
        # Smoothing by s shrinks a ball by about s^2 / R; near the hole it sees one side only.
        slack = (smoothing * LONGEST) ** 2
        assert np.all(np.abs(radii - RADIUS) <= DEPTH + slack + 1e-5)


def test_a_header_may_scale_values_and_lengths(tmp_path):
    import nibabel

    image = nibabel.Nifti1Image(np.rint(100.0 * ball(STRAIGHT)).astype(np.int16), STRAIGHT)
    image.header.set_slope_inter(0.01, 5.0)
    image.header.set_xyzt_units("micron")
    nibabel.save(image, tmp_path / "a.nii")
    loaded = surface(tmp_path / "a.nii", Volume(level=5.0))
    radii = np.linalg.norm(loaded.mesh.vertices - 1e-3 * MIDDLE, axis=1)
    assert np.allclose(radii, 1e-3 * RADIUS, rtol=0, atol=1e-3 * (DEPTH + 0.006))
    assert loaded.mm_per_unit == 1.0
    volume_files.metaimage(
        tmp_path / "a.mhd", ball(STRAIGHT), STRAIGHT, DistanceUnits="cm", HeaderSize="-1"
    )
    raw = tmp_path / "a.raw"
    raw.write_bytes(b"some other header" + raw.read_bytes())
    mesh = surface(tmp_path / "a.mhd").mesh
    assert np.allclose(
        np.linalg.norm(mesh.vertices - 10 * MIDDLE, axis=1), 10 * RADIUS, rtol=0, atol=10 * DEPTH
    )


def test_both_byte_orders_are_read(tmp_path):
    values = np.rint(100.0 * ball(TURNED)).astype(np.int16)
    meshes = []
    for order in ("False", "True"):
        volume_files.metaimage(
            tmp_path / "a.mha", values, TURNED, BinaryDataByteOrderMSB=order, packed=True
        )
        meshes.append(surface(tmp_path / "a.mha", Volume(level=0.5)).mesh)
    assert np.array_equal(meshes[0].vertices, meshes[1].vertices)


def test_more_than_one_volume_is_said_and_the_first_taken(tmp_path):
    import nibabel

    values = np.stack([ball(STRAIGHT), np.zeros(SHAPE, np.float32)], -1)
    nibabel.save(nibabel.Nifti1Image(values, STRAIGHT), tmp_path / "a.nii")
    loaded = surface(tmp_path / "a.nii")
    assert any("holds 2 volumes" in line for line in loaded.warnings)
    assert enclosed(loaded.mesh) > 0.0


def test_a_name_does_not_make_a_volume(tmp_path):
    WRITERS["a.nii"](tmp_path / "scan.nii", TURNED)
    (tmp_path / "scan.nii").rename(tmp_path / "scan.ply")
    assert source_of(tmp_path / "scan.ply").format == "nifti"
    mesh = surface(tmp_path / "scan.ply").mesh
    assert len(mesh.faces) > 2000


def test_the_session_says_the_level_and_the_pipeline_keeps_both(tmp_path):
    WRITERS["a.nii"](tmp_path / "a.nii", TURNED)
    session = Session(mesh=str(tmp_path / "a.nii"), volume=Volume(1.0, 0.5))
    assert from_json(to_json(session)) == session
    pipeline = Pipeline()
    other = replaced(session, volume=Volume(2.0))
    first, second = pipeline.subject(session), pipeline.subject(other)
    assert first.key != second.key
    assert enclosed(first.mesh) > 1.3 * enclosed(second.mesh)
    assert pipeline.subject(session) is first
    assert pipeline.mm_per_unit(session) == 1.0
    assert np.median(pipeline.curvatures(other).k1) > 1.1 * np.median(
        pipeline.curvatures(session).k1
    )
    with pytest.raises(ParameterError):
        replaced(session, volume=Volume(1.0, -1.0))


def test_data_that_change_beside_their_header_are_read_again(tmp_path):
    WRITERS["a.mhd"](tmp_path / "a.mhd", TURNED)
    pipeline, session = Pipeline(), Session(mesh=str(tmp_path / "a.mhd"), volume=AT_ZERO)
    first = pipeline.subject(session)
    raw = tmp_path / "a.raw"
    raw.write_bytes((np.frombuffer(raw.read_bytes(), np.float32) - 1.0).tobytes())
    second = pipeline.subject(session)
    assert second.loaded.digest != first.loaded.digest
    assert enclosed(second.mesh) < enclosed(first.mesh)


def test_every_command_takes_a_volume(tmp_path, capsys):
    WRITERS["b.nii.gz"](tmp_path / "a.nii.gz", TURNED)
    saved, out = tmp_path / "s.json", tmp_path / "o.npz"
    arguments = ["curvature", str(tmp_path / "a.nii.gz"), "-o", str(out), "--json"]
    flags = ["--level", "1", "--smoothing", "0.5", "--method", "rusinkiewicz2004"]
    assert main([*arguments, *flags, "--save-session", str(saved)]) == 0
    result = json.loads(capsys.readouterr().out)
    assert any("level 1 (given), after smoothing by 0.5" in line for line in result["warnings"])
    assert not any("taken as 1 mm" in line for line in result["warnings"])
    again = ["curvature", "--session", str(saved), "-o", str(out), "--json"]
    assert main([*again, "--level", "otsu"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert any("Otsu's; --level takes another), after" in line for line in result["warnings"])
    picture = tmp_path / "o.png"
    figure = ["figure", str(tmp_path / "a.nii.gz"), "-o", str(picture), "--size", "400x200"]
    assert main([*figure, "--quiet", "--method", "rusinkiewicz2004"]) == 0
    assert picture.stat().st_size > 1000


def test_a_mesh_says_that_level_is_not_for_it(tmp_path):
    triangle = TriangleMesh(np.eye(3), [[0, 1, 2]])
    lines = [f"v {x} {y} {z}" for x, y, z in triangle.vertices]
    (tmp_path / "a.obj").write_text("\n".join([*lines, "f 1 2 3", ""]))
    assert surface(tmp_path / "a.obj", Volume()).warnings == load_mesh(tmp_path / "a.obj").warnings
    assert "not used" in surface(tmp_path / "a.obj").warnings[-1]
