import os
import struct
import time
from pathlib import Path

import numpy as np
import pytest

from app.loading import UnreadableFileError, load_mesh
from lutcore.errors import MeshError
from tests import mesh_files

VERTICES, FACES = mesh_files.grid()
FILES = mesh_files.one_of_each()
PLY_HEAD = (
    "ply\nformat {0} 1.0\nelement vertex {1}\nproperty float x\nproperty float y\n"
    "property float z\nelement face {2}\nproperty list uchar int vertex_indices\nend_header\n"
)


def error_of(path):
    with pytest.raises(MeshError) as caught:
        load_mesh(path)
    message = str(caught.value)
    # One clear line: the file, what is wrong, and what to do.
    assert message.startswith(f"{path}: ")
    assert "\n" not in message
    assert "; " in message
    return caught.value


def unreadable(tmp_path, name, content):
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    error = error_of(path)
    assert isinstance(error, UnreadableFileError)
    return str(error)


def no_surface(tmp_path, name, content):
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    error = error_of(path)
    assert not isinstance(error, UnreadableFileError)
    return str(error)


def test_a_missing_file(tmp_path):
    error = error_of(tmp_path / "none.ply")
    assert isinstance(error, UnreadableFileError)
    assert "no such file" in str(error)


def test_a_folder(tmp_path):
    assert "it is a folder" in str(error_of(tmp_path))


def test_a_pipe_is_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "pipe.ply")
    assert "regular file" in str(error_of(tmp_path / "pipe.ply"))


def test_a_file_without_permission(tmp_path, monkeypatch):
    def forbidden(path):
        raise PermissionError(13, "Permission denied")

    (tmp_path / "a.ply").write_bytes(b"ply")
    # Permissions do not bind the superuser, as whom tests may run.
    monkeypatch.setattr(Path, "read_bytes", forbidden)
    assert "may not be read" in str(error_of(tmp_path / "a.ply"))


def test_a_name_no_file_can_have():
    with pytest.raises(UnreadableFileError, match="cannot be read"):
        load_mesh("a\0b.ply")


def test_more_than_memory(tmp_path, monkeypatch):
    def greedy(path):
        raise MemoryError

    (tmp_path / "a.ply").write_bytes(b"ply")
    monkeypatch.setattr(Path, "read_bytes", greedy)
    assert "memory" in str(error_of(tmp_path / "a.ply"))


@pytest.mark.parametrize("ending", ["ply", "obj", "stl", "off", "glb", "vtp", "txt"])
def test_an_empty_file(tmp_path, ending):
    assert "it is empty" in unreadable(tmp_path, f"a.{ending}", b"")


@pytest.mark.parametrize("ending", ["ply", "obj", "stl", "off", "glb", "vtp", "txt", ""])
def test_text_that_is_no_mesh(tmp_path, ending):
    unreadable(tmp_path, f"a.{ending}", "Dear reader,\nthis is a letter, v by v, f by f.\n" * 30)


@pytest.mark.parametrize("ending", ["ply", "obj", "stl", "off", "glb", "vtp", "txt"])
def test_noise(tmp_path, ending):
    unreadable(tmp_path, f"a.{ending}", np.random.default_rng(3).bytes(5000))


@pytest.mark.parametrize(
    ("magic", "name"), [(b"PK\3\4", "zip"), (b"BZh9", "bzip2"), (b"\xfd7zXZ\0", "xz")]
)
def test_an_archive_is_named(tmp_path, magic, name):
    message = unreadable(tmp_path, "a.ply", magic + b"rest")
    assert f"{name} archive; unpack it first" in message


@pytest.mark.parametrize("name", ["text.ply", "plain.obj", "text.stl", "plain.off"])
def test_text_in_utf_16_is_named(tmp_path, name):
    content = FILES[name].decode().encode("utf-16")
    assert "its text is UTF-16; save it as UTF-8" in unreadable(tmp_path, name, content)


HUGE = 4_000_000_000


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("v.ply", PLY_HEAD.format("binary_little_endian", HUGE, 1)),
        ("f.ply", PLY_HEAD.format("binary_big_endian", 0, HUGE) + "abc"),
        ("t.ply", PLY_HEAD.format("ascii", HUGE, 1) + "0 0 0\n"),
        ("e.ply", PLY_HEAD.format("ascii", 10**30, 1) + "0 0 0\n"),
        ("l.ply", PLY_HEAD.format("ascii", 3, 1) + "0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n"),
        ("a.off", f"OFF\n{HUGE} 1 0\n0 0 0\n"),
        ("b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n"),
        ("a.stl", b"\0" * 80 + struct.pack("<I", HUGE) + b"\0" * 50),
        ("a.glb", struct.pack("<4sIIII", b"glTF", 2, 28, HUGE, 0x4E4F534A) + b"{}" * 4),
        ("a.vtp", FILES["plain.vtp"].replace(b'Points="25"', b'Points="90000000000"')),
    ],
)
def test_huge_counts_are_refused_before_anything_is_allocated(tmp_path, name, content):
    began = time.perf_counter()
    unreadable(tmp_path, name, content)
    # Touching 4e9 of anything takes many seconds; starting VTK's child process about one.
    assert time.perf_counter() - began < 20


def test_a_list_beyond_a_binary_ply(tmp_path):
    content = mesh_files.ply(VERTICES, [[0, 1, 5], [0, 1, 2, 3]], None, "<", "int")
    content = content.replace(struct.pack("<i", 4), struct.pack("<i", 2_000_000_000))
    assert "ends in row 1 of 2 of 'face'" in unreadable(tmp_path, "a.ply", content)
    content = content.replace(struct.pack("<i", 2_000_000_000), struct.pack("<i", -4))
    assert "has -4 values" in unreadable(tmp_path, "a.ply", content)


@pytest.mark.parametrize(
    "name",
    ["text.ply", "little.ply", "big.ply", "plain.obj", "plain.off", "plain.vtp", "plain.glb"],
)
def test_indices_out_of_range(tmp_path, name):
    beyond = np.array([[0, 1, 5], [1, 25, 6]])
    make = {
        "text.ply": lambda: mesh_files.ply(VERTICES, beyond, None, ""),
        "little.ply": lambda: mesh_files.ply(VERTICES, beyond, None, "<"),
        "big.ply": lambda: mesh_files.ply(VERTICES, beyond, None, ">"),
        "plain.obj": lambda: mesh_files.obj(VERTICES, beyond),
        "plain.off": lambda: mesh_files.off(VERTICES, beyond),
        "plain.vtp": lambda: mesh_files.vtp(VERTICES, beyond),
        "plain.glb": lambda: mesh_files.simple_glb(VERTICES, beyond),
    }
    message = unreadable(tmp_path, name, make[name]())
    assert "vertex 25" in message
    assert "of 25" in message


@pytest.mark.parametrize("index", [-1, -7])
def test_negative_indices(tmp_path, index):
    unreadable(tmp_path, "a.ply", mesh_files.ply(VERTICES, [[0, 1, index]], None, "<"))
    unreadable(tmp_path, "a.off", mesh_files.off(VERTICES, [[0, 1, index]]))


@pytest.mark.parametrize(
    "face", ["0 1 2", "-9 1 2", "1 2 4", "1.5 2 3", "1 2 x", "99999999999 1 2"]
)
def test_obj_faces_that_cannot_be(tmp_path, face):
    unreadable(tmp_path, "a.obj", f"v 0 0 0\nv 1 0 0\nv 0 1 0\nf {face}\n")


@pytest.mark.parametrize(
    ("name", "content", "place"),
    [
        ("a.ply", PLY_HEAD.format("ascii", 2, 0) + "0 0 0\n1 what 0\n", "line 11: 'what'"),
        (
            "b.ply",
            PLY_HEAD.format("ascii", 3, 1) + "0.25 0.25 0.25\n1 0 0\n",
            "row 2 of 3 of 'vertex'",
        ),
        (
            "c.ply",
            "ply\nformat ascii 1.0\nelement vertex lots\nend_header\n",
            "line 3 of its header",
        ),
        ("d.ply", "ply\nformat middle_endian 1.0\nend_header\n", "line 2 of its header"),
        ("e.ply", "ply\nformat ascii 1.0\n", "no line 'end_header'"),
        ("a.obj", "v 0 0 0\nv 0 1\n", "line 2: a vertex with fewer"),
        ("b.obj", "v 0 0 0\nv 0 zero 1\nf 1 1 1\n", "line 2: 'zero'"),
        ("a.stl", "solid\nfacet\nvertex 1 2 3\nvertex 1 2\nvertex 1 2 3\nendsolid", "line 4"),
        ("b.stl", "solid\nfacet\nvertex 1 2 3\nendfacet\nendsolid", "1 facets but 1 vertices"),
        ("c.stl", "solid\nfacet normal 0 0 1\n", "before 'endsolid'"),
        ("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", "ends after 2 of 4 lines"),
        ("b.off", "OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "vertex 1 has 2 numbers"),
        ("c.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4 0 1 2\n", "face 0"),
        ("d.off", "OFF BINARY\n3 1 0\n", "binary OFF"),
        ("e.off", "4OFF\n3 1 0\n", "not three-dimensional"),
    ],
)
def test_the_place_of_the_damage_is_named(tmp_path, name, content, place):
    assert place in unreadable(tmp_path, name, content)


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize(("row", "words"), [("v 0 1", "a vertex with fewer"), ("v 0 x 1", "'x'")])
def test_lines_of_an_obj_are_counted_across_continued_ones(tmp_path, end, row, words):
    text = f"v 0 0 \\\n0\n# a \\\ncomment\nv 1 \\\n0 \\\n0\n{row}\n".replace("\n", end)
    assert f"line 8: {words}" in unreadable(tmp_path, "a.obj", text)


@pytest.mark.parametrize("ending", ["ply", "obj", "stl", "off", "glb", "vtp", "txt"])
def test_a_byte_order_mark_alone(tmp_path, ending):
    unreadable(tmp_path, f"a.{ending}", b"\xef\xbb\xbf")


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.ply", PLY_HEAD.format("ascii", 2, 0) + "0 0 0\n1 0 0\n"),
        ("b.ply", "ply\nformat ascii 1.0\nelement face 0\nend_header\n"),
        ("c.ply", PLY_HEAD.format("ascii", 3, 1) + "0 0 0\n1 0 0\n0 1 0\n2 0 1\n"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\n"),
        ("a.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"),
        ("a.stl", b"\0" * 84),
        ("b.stl", "solid nothing\nendsolid nothing\n"),
        ("a.glb", mesh_files.glb({}, b"")),
        (
            "a.vtp",
            b'<VTKFile type="PolyData"><PolyData><Piece NumberOfPoints="0"/></PolyData></VTKFile>',
        ),
    ],
)
def test_a_file_without_a_surface_was_read_and_says_so(tmp_path, name, content):
    no_surface(tmp_path, name, content)


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e30])
@pytest.mark.parametrize("order", ["", "<"])
def test_a_few_bad_positions_cost_their_faces_and_are_reported(tmp_path, value, order):
    points = VERTICES.copy()
    points[7] = value
    (tmp_path / "a.ply").write_bytes(mesh_files.ply(points, FACES, None, order))
    loaded = load_mesh(tmp_path / "a.ply")
    assert len(loaded.mesh.vertices) == len(points)
    assert len(loaded.mesh.faces) == len(FACES) - 6
    assert not (loaded.mesh.faces == 7).any()
    assert (
        "1 vertices have no finite position (the first is vertex 7): 6 faces"
        in (loaded.warnings[0])
    )
    kept = np.arange(len(points)) != 7
    assert np.array_equal(loaded.mesh.vertices[kept], points[kept])


def test_mostly_bad_positions_are_no_surface(tmp_path):
    points = np.where(np.arange(len(VERTICES))[:, None] % 2, np.nan, VERTICES)
    assert "not finite" in no_surface(tmp_path, "a.ply", mesh_files.ply(points, FACES, None, "<"))


def test_a_large_text_file_is_read_in_linear_time(tmp_path):
    def seconds(size):
        vertices, faces = mesh_files.grid(size)
        (tmp_path / "a.ply").write_bytes(mesh_files.ply(vertices, faces, None, ""))
        return min(_timed(tmp_path / "a.ply") for _ in range(3))

    # 16 times the rows; quadratic work would take 256 times as long. 64 leaves room for a busy
    # machine and for the small file's fixed costs, which only lower the ratio.
    assert seconds(160) < 64 * seconds(40)


@pytest.mark.parametrize("blank", ["\n", " ", "\t", "#", "\\\n", "/", "-"])
@pytest.mark.parametrize(
    ("name", "head"),
    [
        ("a.stl", "solid\nfacet\n"),
        ("a.off", "OFF\n3 1 0\n"),
        ("a.obj", "v 0 0 0\nf "),
        ("a.ply", PLY_HEAD.format("ascii", 3, 1)),
        ("a.txt", ""),
    ],
)
def test_a_million_blanks_are_passed_over_at_once(tmp_path, name, head, blank):
    (tmp_path / name).write_text(head + blank * 1_000_000)
    began = time.perf_counter()
    error_of(tmp_path / name)
    # Searching again from every blank would take 1e12 steps, an hour.
    assert time.perf_counter() - began < 20


def _timed(path):
    began = time.perf_counter()
    load_mesh(path)
    return time.perf_counter() - began
