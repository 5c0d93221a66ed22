import gzip
import hashlib
import re

import numpy as np
import pytest

from app.loading import UnreadableFileError, load_mesh, packed
from app.loading.errors import BadContentError
from app.loading.packed import unpacked
from tests import mesh_files, more_files

VERTICES, FACES = mesh_files.grid()
FILES = mesh_files.one_of_each()


@pytest.mark.parametrize("name", FILES)
def test_every_format_may_be_packed_with_gzip(tmp_path, name):
    content = more_files.packed(FILES[name])
    (tmp_path / f"{name}.gz").write_bytes(content)
    (tmp_path / name).write_bytes(FILES[name])
    loaded, plain = load_mesh(tmp_path / f"{name}.gz"), load_mesh(tmp_path / name)
    assert np.array_equal(loaded.mesh.vertices, plain.mesh.vertices)
    assert np.array_equal(loaded.mesh.faces, plain.mesh.faces)
    assert loaded.warnings == ()
    assert loaded.digest == hashlib.sha256(content).hexdigest()


def test_it_is_unpacked_whatever_its_name(tmp_path):
    (tmp_path / "a.ply").write_bytes(more_files.packed(FILES["plain.off"]))
    assert "is called .ply but holds OFF" in load_mesh(tmp_path / "a.ply").warnings[0]


def test_members_follow_one_another_and_zeros_fill_the_end():
    content = gzip.compress(b"solid ") + gzip.compress(b"x") + b"\0" * 512
    assert unpacked(content) == b"solid x"


def refused(tmp_path, content):
    (tmp_path / "a.ply.gz").write_bytes(content)
    with pytest.raises(UnreadableFileError) as caught:
        load_mesh(tmp_path / "a.ply.gz")
    return str(caught.value)


def test_a_bomb_is_refused_before_it_has_unfolded(tmp_path):
    message = refused(tmp_path, gzip.compress(b"\0" * 80_000_000, 1))
    assert "more than 67108864, as no mesh does; unpack it yourself" in message


def test_the_bound_grows_with_the_file(monkeypatch):
    monkeypatch.setattr(packed, "_GRANTED", 1000)
    random = np.random.default_rng(0).bytes(20)
    with pytest.raises(BadContentError, match="unfolds"):
        unpacked(gzip.compress(b"a" * 100_000))
    assert len(unpacked(gzip.compress(random * 200))) == 4000  # 60 times its size
    monkeypatch.setattr(packed, "_MOST", 3000)
    with pytest.raises(BadContentError, match="more than 3000"):
        unpacked(gzip.compress(random * 200))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda c: c[:100], "end too early, after"),
        (lambda c: c[:-9] + b"\0" + c[-8:], "damaged"),
        (lambda c: c[:-8] + b"\0" * 8, "damaged"),
        (lambda c: c + b"more", "damaged at byte"),
        (gzip.compress, "it is a gzip archive; unpack it first"),
        (lambda c: gzip.compress(b""), "not a mesh|PLY|header"),
    ],
)
def test_damage_is_named(tmp_path, change, words):
    assert re.search(words, refused(tmp_path, change(more_files.packed(FILES["little.ply"]))))
