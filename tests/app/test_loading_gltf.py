import hashlib
import json

import numpy as np
import pytest

from app.loading import UnreadableFileError, load_mesh
from tests import mesh_files
from tests.more_files import gltf

VERTICES, FACES = mesh_files.grid()
GLB = mesh_files.simple_glb(VERTICES, FACES)
DATA = GLB[28 + int.from_bytes(GLB[12:16], "little") :]


def load(tmp_path, content, name="a.gltf"):
    (tmp_path / name).write_bytes(content)
    return load_mesh(tmp_path / name)


def refused(tmp_path, content):
    with pytest.raises(UnreadableFileError) as caught:
        load(tmp_path, content)
    return str(caught.value)


def test_embedded_data_are_read(tmp_path):
    loaded = load(tmp_path, gltf(GLB))
    assert np.array_equal(loaded.mesh.vertices, VERTICES)
    assert np.array_equal(loaded.mesh.faces, FACES)
    assert loaded.warnings == ()


def test_it_is_told_by_its_content(tmp_path):
    assert "holds GLTF" in load(tmp_path, gltf(GLB), "a.json").warnings[0]


def test_data_that_are_not_base64_are_read(tmp_path):
    escaped = "".join(f"%{byte:02x}" for byte in DATA)
    loaded = load(tmp_path, gltf(GLB, f"data:application/octet-stream,{escaped}"))
    assert np.array_equal(loaded.mesh.vertices, VERTICES)


@pytest.mark.parametrize("uri", ["my%20data.bin", "./parts/../my data.bin", "my data.bin"])
def test_a_file_beside_it_is_read_and_counts_for_the_digest(tmp_path, uri):
    (tmp_path / "parts").mkdir()
    (tmp_path / "my data.bin").write_bytes(DATA)
    content = gltf(GLB, uri)
    loaded = load(tmp_path, content)
    assert np.array_equal(loaded.mesh.faces, FACES)
    assert loaded.digest == hashlib.sha256(content + DATA).hexdigest()


def test_a_glb_may_keep_its_data_beside_it_too(tmp_path):
    (tmp_path / "a.bin").write_bytes(DATA)
    document = json.loads(gltf(GLB, "a.bin"))
    assert len(load(tmp_path, mesh_files.glb(document, b""), "a.glb").mesh.faces) == len(FACES)


@pytest.mark.parametrize(
    ("uri", "words"),
    [
        ("none.bin", "in another file, 'none.bin', which is not there; put the file"),
        ("../outside.bin", "outside its folder"),
        ("%2e%2e/outside.bin", "outside its folder"),
        ("link.bin", "outside its folder"),
        ("/etc/hostname", "outside its folder"),
        ("file:///etc/hostname", "another place"),
        ("http://example.org/a.bin", "another place"),
        ("C:\\a.bin", "another place"),
        ("a%00b", "another place"),
        ("folder", "which is no file"),
        ("data:;base64,AAAA", "the file has 3 bytes of data"),
        ("data:;base64,A", "is no base64"),
        ("data:nothing", "has no comma"),
    ],
)
def test_data_that_are_not_there_or_not_its_own_are_refused(tmp_path, uri, words):
    inside = tmp_path / "inside"
    inside.mkdir()
    (inside / "folder").mkdir()
    (tmp_path / "outside.bin").write_bytes(DATA)
    (inside / "link.bin").symlink_to(tmp_path / "outside.bin")
    assert words in refused(inside, gltf(GLB, uri))


def changed(change):
    document = json.loads(gltf(GLB))
    change(document)
    return json.dumps(document).encode()


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (gltf(GLB)[:-30], "its JSON cannot be read"),
        (b'{"asset": ' + b"[" * 100_000, "its JSON cannot be read"),
        (b'{"asset": 1, "nodes": ' + b"9" * 5000 + b"}", "its JSON cannot be read"),
        (changed(lambda d: d["buffers"][0].pop("uri")), "buffer 0 has no data"),
        (changed(lambda d: d["buffers"][0].update(uri=5)), "a 'uri' that is no text"),
        (changed(lambda d: d.update(buffers=[])), "number 0 of its 0 buffers"),
        (changed(lambda d: d.update(buffers=[7])), "not valid glTF"),
        # Each node is the child of every other, and a list of children is as long as the file.
        (
            changed(lambda d: d.update(nodes=[{"mesh": 0, "children": [0] * 5000}] + [{}] * 5000)),
            "do not form a tree",
        ),
        (changed(lambda d: d["scenes"][0].update(nodes=[0] * 200_000)), "do not form a tree"),
    ],
)
def test_damage_is_named(tmp_path, content, words):
    assert words in refused(tmp_path, content)
