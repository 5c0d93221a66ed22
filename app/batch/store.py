"""The folder that a batch writes to."""

import hashlib
import os
import shutil
from contextlib import suppress
from pathlib import Path
from typing import Protocol

from app.writing import WriteError, write_bytes

HIDDEN = ".batch"
"""Folder for what is not yet a result, and for the records."""


class Store(Protocol):
    """Where results and records lie; names have slashes."""

    def pending(self, key: str) -> Path:
        """Return an empty folder on this machine to draw into; see `settle`."""

    def origin(self, pending: Path) -> Path:
        """Return the folder from which pictures see their meshes, once they are settled."""

    def settle(self, pending: Path, name: str) -> None:
        """Make a file of the pending folder a result, whole or not at all."""

    def leave(self, pending: Path) -> None:
        """Remove a pending folder."""

    def read(self, name: str) -> bytes | None:
        """Return what a file holds; None if there is none."""

    def write(self, name: str, content: bytes) -> None:
        """Write a file, whole or not at all."""


class Folder:
    """A folder on a disk.

    Parameters
    ----------
    root : Path
        The folder; made if it is missing.
    """

    def __init__(self, root: Path) -> None:
        self.root = root
        _made(root)

    def pending(self, key: str) -> Path:
        """Return an empty folder; see `Store`."""
        folder = self.unsettled(key)
        shutil.rmtree(folder, ignore_errors=True)
        return _made(folder)

    def unsettled(self, key: str) -> Path:
        """Return where `pending` is, whether it exists or not.

        Parameters
        ----------
        key : str
            Of the mesh.

        Returns
        -------
        Path
            A run that was killed may have left whole results there.
        """
        return self.root / HIDDEN / "pending" / key

    def origin(self, pending: Path) -> Path:
        """Return the folder itself; see `Store`."""
        return self.root

    def settle(self, pending: Path, name: str) -> None:
        """Move a file to its place; see `Store`."""
        place = self.root / name
        _made(place.parent)
        try:
            os.replace(pending / name, place)
        except OSError as error:
            raise WriteError(f"{place}: cannot be written ({error.strerror})") from error

    def leave(self, pending: Path) -> None:
        """Remove a pending folder; see `Store`."""
        shutil.rmtree(pending, ignore_errors=True)

    def read(self, name: str) -> bytes | None:
        """Return what a file holds; see `Store`."""
        with suppress(OSError):
            return (self.root / name).read_bytes()
        return None

    def write(self, name: str, content: bytes) -> None:
        """Write a file; see `Store`."""
        place = self.root / name
        _made(place.parent)
        write_bytes(place, content)


def opened(target: str) -> Store:
    """Return the folder of a name.

    Parameters
    ----------
    target : str
        A path, or an address such as ``s3://bucket/folder``.

    Returns
    -------
    Store
        The folder, made if it was missing.

    Raises
    ------
    WriteError, ParameterError
        If it cannot be made, or fsspec is not installed or does not know the address.
    """
    if "://" not in target:
        return Folder(Path(os.path.abspath(target)))
    from app.batch.remote import Remote

    return Remote(target)


def digest(content: bytes) -> str:
    """Return a digest.

    Parameters
    ----------
    content : bytes
        Anything.

    Returns
    -------
    str
        SHA-256, hexadecimal.
    """
    return hashlib.sha256(content).hexdigest()


def _made(folder: Path) -> Path:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise WriteError(
            f"{folder}: cannot be made ({error.strerror}); choose another folder with -o"
        ) from error
    return folder
