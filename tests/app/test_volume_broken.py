import gzip
import struct

import numpy as np
import pytest

from app.cli.main import main
from app.loading import UnreadableFileError
from app.session import Volume
from app.volume import child, load_surface, loader, marching, source_of
from lutcore.errors import MeshError
from tests import volume_files
from tests.corpus.mutations import MUTATIONS, truncated
from tests.volume_files import affine_of, ball

SHAPE = (18, 16, 14)
AFFINE = affine_of(np.eye(3), SHAPE)
VALUES = np.rint(100.0 * ball(AFFINE, SHAPE)).astype(np.int16)
WRITERS = {
    "a.nii": lambda path: volume_files.nifti(path, VALUES, AFFINE),
    "a.nii.gz": lambda path: volume_files.nifti(path, VALUES, AFFINE),
    "a.mha": lambda path: volume_files.metaimage(path, VALUES, AFFINE),
    "z.mha": lambda path: volume_files.metaimage(path, VALUES, AFFINE, packed=True),
    "a.mhd": lambda path: volume_files.metaimage(path, VALUES, AFFINE),
    "a.tif": lambda path: volume_files.tiff(path, VALUES),
    "z.tif": lambda path: volume_files.tiff(path, VALUES, "plain", compression="zlib"),
    "o.tif": lambda path: volume_files.tiff(path, VALUES, "ome"),
    "a.vti": lambda path: volume_files.vti(path, VALUES, AFFINE),
}


def surface(path, **volume):
    return load_surface(source_of(path), Volume(**volume))


def refused(path, words, error=UnreadableFileError, **volume):
    with pytest.raises(error, match=words) as caught:
        surface(path, **volume)
    assert type(caught.value) is error
    assert str(caught.value).startswith(f"{path}: ")
    assert "; " in str(caught.value)  # what to do


@pytest.mark.parametrize("name", WRITERS)
def test_a_file_cut_short_is_unreadable(tmp_path, name):
    path = tmp_path / name
    WRITERS[name](path)
    assert len(surface(path, level=0.5).mesh.faces) > 100
    cut = path.with_suffix(".raw") if name == "a.mhd" else path
    content = cut.read_bytes()
    for share in (0.5, 0.98):
        cut.write_bytes(content[: int(share * len(content))])
        refused(path, ".", level=0.5)
    cut.write_bytes(b"")
    with pytest.raises(UnreadableFileError):
        surface(path)


@pytest.mark.parametrize("name", WRITERS)
def test_no_damage_brings_more_than_a_message(tmp_path, name):
    path = tmp_path / name
    WRITERS[name](path)
    guarded = name == "a.vti"  # VTK may crash
    whole, random = path.read_bytes(), np.random.default_rng(0)
    damaged = [*truncated(whole, 4)]
    for mutation in MUTATIONS.values():
        damaged += [mutation(whole, random, whole) for _ in range(1 if guarded else 5)]
    for content in damaged:
        path.write_bytes(content)
        source = source_of(path)
        if guarded or source.format in (None, "vti"):
            try:
                assert len(load_surface(source, Volume(level=0.5)).mesh.faces) > 0
            except MeshError as error:
                assert "failed on it" not in str(error)
            continue
        files = np.array([str(one) for one in source.files])
        found = child.read(
            np.array(f"app.volume.{source.format}"), files, np.array(0.5), np.array(0.0), 1 << 30
        )
        if "vertices" in found:
            assert np.isfinite(found["vertices"]).all()
        else:
            assert "problem" in found or "none" in found


def test_dimensions_that_lie_are_found_before_memory_is_taken(tmp_path):
    WRITERS["a.nii"](tmp_path / "a.nii")
    content = bytearray((tmp_path / "a.nii").read_bytes())
    struct.pack_into("<3h", content, 42, 20000, 20000, 20000)
    (tmp_path / "a.nii").write_bytes(content)
    refused(tmp_path / "a.nii", "promises 20000 x 20000 x 20000 voxels of 2 bytes")
    (tmp_path / "a.nii.gz").write_bytes(gzip.compress(bytes(content)))
    refused(tmp_path / "a.nii.gz", "promises 20000 x 20000 x 20000 .* compressed")
    WRITERS["z.mha"](tmp_path / "z.mha")
    content = (tmp_path / "z.mha").read_bytes()
    (tmp_path / "z.mha").write_bytes(content.replace(b"18 16 14", b"9999 9999 9999"))
    refused(tmp_path / "z.mha", "promises 9999 x 9999 x 9999 .* compressed")
    (tmp_path / "z.mha").write_bytes(content.replace(b"18 16 14", b"18 16 15"))
    refused(tmp_path / "z.mha", "unfold to 8064 bytes, its header promises 8640")
    (tmp_path / "z.mha").write_bytes(content.replace(b"18 16 14", b"18 16 13"))
    refused(tmp_path / "z.mha", "unfold to more, its header promises 7488")
    WRITERS["a.vti"](tmp_path / "a.vti")
    content = (tmp_path / "a.vti").read_bytes()
    (tmp_path / "a.vti").write_bytes(content.replace(b'"3 20 ', b'"3 2000000000 '))
    refused(tmp_path / "a.vti", "promises 1999999998 x")


def test_a_volume_larger_than_memory_is_refused(tmp_path, monkeypatch):
    WRITERS["a.nii"](tmp_path / "a.nii")
    monkeypatch.setattr(loader, "_memory", lambda: 10_000)
    refused(tmp_path / "a.nii", "GiB of memory to work on.*crop")


def test_a_surface_larger_than_can_be_worked_on_is_refused(monkeypatch):
    noise = np.random.default_rng(0).normal(size=(20, 20, 20)).astype(np.float32)
    monkeypatch.setattr(marching, "_MOST_VERTICES", 100)
    with pytest.raises(MeshError, match=r"about 0 million vertices.*--smoothing"):
        marching._check_size(noise, 0.0)


def test_vertices_are_counted_before_they_are_made(monkeypatch):
    from skimage.measure import marching_cubes

    values = ball(AFFINE, SHAPE)
    count = len(marching_cubes(values, 0.01)[0])
    # Beside one on each crossed edge, a few cells get one in their middle.
    monkeypatch.setattr(marching, "_MOST_VERTICES", int(1.02 * count))
    marching._check_size(values, 0.01)
    monkeypatch.setattr(marching, "_MOST_VERTICES", int(0.98 * count))
    with pytest.raises(MeshError, match="would have"):
        marching._check_size(values, 0.01)


@pytest.mark.parametrize(
    ("values", "volume", "words"),
    [
        (VALUES, {"level": 9999.0}, "no surface lies at level 9999.*values from -"),
        (VALUES, {"level": float(VALUES.max())}, "no surface lies at level"),
        (np.full(SHAPE, 7, np.int16), {}, "all of its voxels have the value 7"),
        (np.full(SHAPE, np.nan, np.float32), {}, "none of its voxels has a finite value"),
    ],
)
def test_a_volume_without_a_surface_is_said_to_have_none(tmp_path, values, volume, words):
    volume_files.nifti(tmp_path / "a.nii", values, AFFINE)
    refused(tmp_path / "a.nii", words, MeshError, **volume)


def test_what_is_no_volume_of_numbers_is_refused(tmp_path):
    import nibabel
    import tifffile

    path = tmp_path / "a.nii"
    nibabel.save(nibabel.Nifti1Image(VALUES[:, :, :1], AFFINE), path)
    refused(path, "18 x 16 x 1 voxels, which is no volume")
    nibabel.save(nibabel.Nifti1Image(VALUES.astype(np.complex64), AFFINE), path)
    refused(path, "type complex64, not single numbers")
    image = nibabel.Nifti1Image(VALUES, AFFINE)
    image.header["srow_z"] = image.header["srow_y"]
    path.write_bytes(image.header.binaryblock + bytes(4) + VALUES.tobytes("F"))
    refused(path, "axes do not span a space")
    path = tmp_path / "a.tif"
    tifffile.imwrite(path, np.zeros((5, 6, 7, 3), np.uint8), photometric="rgb")
    refused(path, "pixels are colours")
    tifffile.imwrite(path, np.zeros((6, 7), np.uint8))
    refused(path, "no volume")
    path = tmp_path / "a.mha"
    for field, words in {
        "NDims": ("4", "4 dimensions"),
        "ElementType": ("MET_STRING", "no kind of number"),
        "ElementNumberOfChannels": ("3", "each voxel has 3 numbers"),
        "BinaryData": ("False", "voxels are text"),
        "DimSize": ("18 16.5 14", "expected whole numbers"),
        "ElementSpacing": ("1 1", "expected 3 numbers"),
        "TransformMatrix": ("1 0 0 1 0 0 0 0 1", "span a space"),
        "DistanceUnits": ("parsec", "DistanceUnits are 'parsec'"),
    }.items():
        volume_files.metaimage(path, VALUES, AFFINE, **{field: words[0]})
        refused(path, words[1])


def test_files_that_are_missing_or_do_not_fit_are_named(tmp_path):
    WRITERS["a.mhd"](tmp_path / "a.mhd")
    (tmp_path / "a.raw").unlink()
    refused(tmp_path / "a.mhd", "in 'a.raw', which is not there")
    folder = tmp_path / "scan"
    folder.mkdir()
    refused(folder, "it is a folder")
    for number in range(4):
        size = (9, 8) if number == 3 else (8, 8)
        volume_files.tiff(folder / f"{number}.tif", np.eye(*size, dtype=np.uint8), "plain")
    refused(folder, r"slice 3.tif has .* the first has")


def test_a_reader_that_crashes_or_hangs_is_one_message(tmp_path, monkeypatch):
    WRITERS["a.nii"](tmp_path / "a.nii")
    (tmp_path / "app_rude.py").write_text("import os, signal\nos.kill(os.getpid(), 11)\n")
    monkeypatch.syspath_prepend(tmp_path)

    def crash(function, arrays, **limits):
        from lutcore.isolated import run_isolated

        return run_isolated("app_rude:read", arrays, **limits)

    monkeypatch.setattr(loader, "run_isolated", crash)
    refused(tmp_path / "a.nii", "crashed on it .SIGSEGV.*crop it")


def test_the_command_answers_with_the_right_code(tmp_path, capsys):
    WRITERS["a.nii"](tmp_path / "a.nii")
    out = tmp_path / "o.npz"
    arguments = ["curvature", str(tmp_path / "a.nii"), "-o", str(out)]
    assert main([*arguments, "--level", "1e9"]) == 4
    assert "--level" in capsys.readouterr().err
    assert main([*arguments, "--level", "bone"]) == 2
    assert main([*arguments, "--smoothing", "-1"]) == 2
    (tmp_path / "a.nii").write_bytes((tmp_path / "a.nii").read_bytes()[:700])
    assert main(arguments) == 3
    assert not out.exists()
