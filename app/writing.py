"""Write a file beside its place, then rename: never half a file, never the old one lost."""

import errno
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from lutcore.errors import CurvelightError


class WriteError(CurvelightError):
    """A result cannot be written."""


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary path in the same folder; it becomes `path` when the block ends well.

    Parameters
    ----------
    path : path-like
        The file to write. What it held before stays until the new content is on the disk; if the
        block raises anything, an interrupt included, it stays for good. A symbolic link is
        followed.

    Yields
    ------
    Path
        An empty file with the suffix of `path`, to be written by name.

    Raises
    ------
    WriteError
        If the folder is missing or cannot be written, the path is a folder or a device, or the
        disk is full.
    """
    target, beside = _beside(path)
    try:
        yield beside
        _settle(beside, target)
    except OSError as error:
        if error.filename not in (None, str(beside), str(target)):
            raise  # of another file that the block works with
        raise _explained(path, error) from error
    finally:
        with suppress(OSError):
            beside.unlink(missing_ok=True)


def write_bytes(path: str | os.PathLike[str], content: bytes) -> None:
    """Write a whole file at once, or leave what is there untouched.

    Parameters
    ----------
    path : path-like
        The file to write.
    content : bytes
        All that it shall hold.

    Raises
    ------
    WriteError
        See `replacing`.
    """
    with replacing(path) as beside:
        beside.write_bytes(content)


def check_writable(path: str | os.PathLike[str]) -> None:
    """Make sure, before long work, that a file can be written at its end.

    Parameters
    ----------
    path : path-like
        The file that shall be written.

    Raises
    ------
    WriteError
        See `replacing`.
    """
    _, beside = _beside(path)
    beside.unlink()


def _beside(path: str | os.PathLike[str]) -> tuple[Path, Path]:
    """Check the target and make an empty file beside it."""
    target = Path(path).resolve()
    try:
        if target.is_dir():
            raise IsADirectoryError(errno.EISDIR, "it is a folder")
        if target.exists() and not target.is_file():
            # Renaming over a device or a pipe would replace it by a plain file.
            raise OSError(errno.EINVAL, "it is not a regular file")
        # Same folder, because a rename across file systems would be a copy.
        handle, name = tempfile.mkstemp(
            suffix=target.suffix, prefix=".curvelight-", dir=target.parent
        )
        os.close(handle)
    except OSError as error:
        raise _explained(path, error) from error
    return target, Path(name)


def _settle(beside: Path, target: Path) -> None:
    # mkstemp makes private files; the result gets the mode that open() would have given it, or
    # that of the file it replaces.
    beside.chmod(target.stat().st_mode & 0o777 if target.exists() else 0o666 & ~_umask())
    with beside.open("rb+") as stream:
        os.fsync(stream.fileno())
    os.replace(beside, target)


def _umask() -> int:
    mask = os.umask(0o077)
    os.umask(mask)
    return mask


def _explained(path: str | os.PathLike[str], error: OSError) -> WriteError:
    advice = "choose another place with -o"
    if isinstance(error, FileNotFoundError):
        advice = "make the folder first, or choose another place"
    elif isinstance(error, PermissionError):
        advice = "choose a folder that you may write to"
    elif isinstance(error, IsADirectoryError):
        advice = "add a file name"
    elif error.errno == errno.ENOSPC:
        advice = "free some space on the disk, or choose another disk"
    return WriteError(f"{path}: cannot be written ({error.strerror or error}); {advice}")
