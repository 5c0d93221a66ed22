import numpy as np
import pytest

from app.loading import guard, load_mesh
from app.loading.errors import BadContentError
from app.loading.guard import read_guarded
from lutcore.errors import MeshError
from tests.mesh_files import one_of_each


def reader(tmp_path, monkeypatch, body):
    """Make a reader module whose `read` runs `body`, and return its name."""
    folder = tmp_path / "readers"
    folder.mkdir()
    lines = "\n".join("    " + line for line in body.splitlines())
    (folder / "rude_reader.py").write_text(f"def read(content):\n{lines}\n")
    monkeypatch.syspath_prepend(folder)
    return "rude_reader"


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("import os, signal\nos.kill(os.getpid(), signal.SIGSEGV)", "crashed on it .SIGSEGV"),
        ("import os\nos.abort()", "crashed on it .SIGABRT"),
        ("raise RuntimeError('odd')", "its reader failed on it .RuntimeError: odd"),
        ("import os\nos._exit(0)", "its reader failed on it .no reason given"),
        ("from app.loading import errors\nraise errors.BadContentError('line 3')", "line 3"),
    ],
)
def test_whatever_a_reader_does_becomes_one_error(tmp_path, monkeypatch, body, words):
    with pytest.raises(BadContentError, match=words):
        read_guarded(reader(tmp_path, monkeypatch, body), b"content")


@pytest.mark.parametrize(
    "body",
    [
        "return bytearray(1 << 40)",
        "import numpy as np\nreturn np.ones(1 << 40)",
        "raise RuntimeError('std::bad_alloc')",
        # As the C++ library ends a process, and as VTK does.
        'import os\nos.write(2, b"what():  std::bad_alloc")\nos.abort()',
        "import os\nos.write(2, b'x' * 9_000_000 + b'Unable to allocate 7 elements')\nos.abort()",
        # Truly: VTK's own array, of more than there is.
        "from vtkmodules.vtkCommonCore import vtkDoubleArray\n"
        "vtkDoubleArray().SetNumberOfValues(1 << 40)\nraise RuntimeError('VTK went on')",
    ],
)
def test_a_reader_that_meets_its_memory_limit_is_no_proof_of_damage(tmp_path, monkeypatch, body):
    with pytest.raises(BadContentError, match="needs more than 4 GiB of memory to read") as caught:
        read_guarded(reader(tmp_path, monkeypatch, body), b"content")
    assert "and has 7 bytes" in caught.value.problem
    assert caught.value.advice.startswith("decimate it or convert it to PLY")


def test_a_file_that_needs_more_memory_is_told_with_its_name(tmp_path, monkeypatch):
    path = tmp_path / "large.vtp"
    path.write_bytes(one_of_each()["plain.vtp"])
    assert len(load_mesh(path).mesh.faces) == 32
    # Less than VTK's own libraries take, so that reading really meets it.
    monkeypatch.setattr(guard, "_BYTES", 150 << 20)
    with pytest.raises(MeshError, match=r"large\.vtp: needs more than 0 GiB") as caught:
        load_mesh(path)
    assert "damaged: copy" in str(caught.value)


@pytest.mark.parametrize("body", ["while True:\n    pass", "import time\ntime.sleep(60)"])
def test_a_reader_that_never_ends_is_stopped(tmp_path, monkeypatch, body):
    monkeypatch.setattr(guard, "_SECONDS", 1.0)
    monkeypatch.setattr(guard, "_SLOWNESS", 20 if "while" in body else 1)
    with pytest.raises(BadContentError, match=r"its reader took more than [12] s"):
        read_guarded(reader(tmp_path, monkeypatch, body), b"content")


def test_everything_a_surface_holds_comes_back(tmp_path, monkeypatch):
    name = reader(
        tmp_path,
        monkeypatch,
        "import numpy as np\n"
        "from app.loading.surface import RawSurface\n"
        "print('noise on standard output')\n"
        "points = np.arange(9.0).reshape(3, 3)\n"
        "return RawSurface(points, np.arange(3), np.array([3]), points / 9, [content.decode()])",
    )
    surface = read_guarded(name, b"content")
    assert np.array_equal(surface.vertices, np.arange(9.0).reshape(3, 3))
    assert surface.corners.tolist() == [0, 1, 2]
    assert surface.counts.tolist() == [3]
    assert np.array_equal(surface.colors, surface.vertices / 9)
    assert surface.warnings == ["content"]


def test_a_folder_named_app_where_the_user_stands_is_not_taken_for_ours(tmp_path, monkeypatch):
    (tmp_path / "app").mkdir()
    (tmp_path / "app" / "__init__.py").write_text("raise RuntimeError('not this one')")
    (tmp_path / "a.vtp").write_bytes(one_of_each()["plain.vtp"])
    monkeypatch.chdir(tmp_path)
    assert len(load_mesh("a.vtp").mesh.faces) == 32
