import errno
import os

import pytest

from app.writing import WriteError, check_writable, replacing, write_bytes
from lutcore.errors import CurvelightError


def leftovers(folder):
    return sorted(path.name for path in folder.iterdir())


def test_a_file_is_written_whole(tmp_path):
    write_bytes(tmp_path / "a.bin", b"new")
    assert (tmp_path / "a.bin").read_bytes() == b"new"
    assert leftovers(tmp_path) == ["a.bin"]


def test_a_file_is_replaced_and_keeps_its_mode(tmp_path):
    path = tmp_path / "a.bin"
    path.write_bytes(b"old and longer")
    path.chmod(0o640)
    write_bytes(path, b"new")
    assert path.read_bytes() == b"new"
    assert path.stat().st_mode & 0o777 == 0o640


def test_a_new_file_has_the_mode_of_any_new_file(tmp_path):
    (tmp_path / "usual").touch()
    write_bytes(tmp_path / "ours", b"")
    assert (tmp_path / "ours").stat().st_mode == (tmp_path / "usual").stat().st_mode


def test_the_temporary_name_keeps_the_suffix_that_writers_go_by(tmp_path):
    with replacing(tmp_path / "picture.png") as beside:
        assert beside.suffix == ".png"
        assert beside.parent == tmp_path


def test_a_link_keeps_pointing_at_the_file(tmp_path):
    (tmp_path / "there").write_bytes(b"old")
    (tmp_path / "link").symlink_to(tmp_path / "there")
    write_bytes(tmp_path / "link", b"new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "there").read_bytes() == b"new"


@pytest.mark.parametrize("stop", [KeyboardInterrupt, SystemExit, RuntimeError, MemoryError])
def test_an_interrupted_write_leaves_the_old_file_and_nothing_else(tmp_path, stop):
    (tmp_path / "a.bin").write_bytes(b"old")
    with pytest.raises(stop), replacing(tmp_path / "a.bin") as beside:
        beside.write_bytes(b"hal")
        raise stop
    assert (tmp_path / "a.bin").read_bytes() == b"old"
    assert leftovers(tmp_path) == ["a.bin"]


def test_a_full_disk_leaves_the_old_file_and_says_so(tmp_path, monkeypatch):
    def full(handle):
        raise OSError(errno.ENOSPC, "No space left on device")

    (tmp_path / "a.bin").write_bytes(b"old")
    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(WriteError, match=r"a\.bin: cannot be written \(No space.*free some space"):
        write_bytes(tmp_path / "a.bin", b"new")
    assert (tmp_path / "a.bin").read_bytes() == b"old"
    assert leftovers(tmp_path) == ["a.bin"]


def test_a_full_disk_while_the_caller_writes(tmp_path):
    with pytest.raises(WriteError, match="free some space"), replacing(tmp_path / "a"):
        raise OSError(errno.ENOSPC, "No space left on device")
    assert leftovers(tmp_path) == []


def test_trouble_with_another_file_is_not_blamed_on_this_one(tmp_path):
    with pytest.raises(FileNotFoundError, match="other"), replacing(tmp_path / "a"):
        (tmp_path / "other").read_bytes()
    assert leftovers(tmp_path) == []


def test_a_missing_folder(tmp_path):
    with pytest.raises(WriteError, match="make the folder first"):
        write_bytes(tmp_path / "none" / "a.bin", b"")


def test_a_folder_in_the_files_place(tmp_path):
    with pytest.raises(WriteError, match=r"it is a folder\); add a file name"):
        write_bytes(tmp_path, b"")


def test_a_file_in_the_folders_place(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(WriteError, match="cannot be written"):
        write_bytes(tmp_path / "file" / "a.bin", b"")


def test_a_pipe_is_not_replaced(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(WriteError, match="not a regular file"):
        write_bytes(tmp_path / "pipe", b"")
    assert leftovers(tmp_path) == ["pipe"]
    assert not (tmp_path / "pipe").is_file()


def test_no_permission(tmp_path, monkeypatch):
    def forbidden(*args, **kwargs):
        raise PermissionError(errno.EACCES, "Permission denied")

    # Permissions do not bind the superuser, as whom tests may run.
    monkeypatch.setattr("tempfile.mkstemp", forbidden)
    with pytest.raises(WriteError, match="that you may write to"):
        write_bytes(tmp_path / "a.bin", b"")


def test_a_write_error_is_one_of_ours():
    assert issubclass(WriteError, CurvelightError)


def test_checking_leaves_no_trace(tmp_path):
    check_writable(tmp_path / "new")
    assert leftovers(tmp_path) == []
    (tmp_path / "old").write_bytes(b"old")
    check_writable(tmp_path / "old")
    assert (tmp_path / "old").read_bytes() == b"old"
    with pytest.raises(WriteError, match="make the folder first"):
        check_writable(tmp_path / "none" / "a.bin")
