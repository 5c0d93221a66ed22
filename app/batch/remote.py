"""Meshes and results behind addresses that fsspec knows."""

import glob
import shutil
import tempfile
from pathlib import Path
from typing import Any

from app.writing import WriteError
from lutcore.errors import ParameterError


class Remote:
    """A folder behind an address that fsspec knows.

    Parameters
    ----------
    address : str
        Such as ``s3://bucket/folder``.
    """

    def __init__(self, address: str) -> None:
        self._system, root = _filesystem(address)
        self._root = root.rstrip("/")
        self._system.makedirs(self._root, exist_ok=True)

    def pending(self, key: str) -> Path:
        """Return an empty folder; see `app.batch.store.Store`."""
        return Path(tempfile.mkdtemp(prefix="curvelight-"))

    def origin(self, pending: Path) -> Path:
        """Return the pending folder, where the mesh is fetched to; see `app.batch.store.Store`."""
        return pending

    def settle(self, pending: Path, name: str) -> None:
        """Send a file; see `app.batch.store.Store`."""
        self.write(name, (pending / name).read_bytes())

    def leave(self, pending: Path) -> None:
        """Remove a pending folder; see `app.batch.store.Store`."""
        shutil.rmtree(pending, ignore_errors=True)

    def read(self, name: str) -> bytes | None:
        """Return what a file holds; see `app.batch.store.Store`."""
        try:
            content: bytes = self._system.cat_file(f"{self._root}/{name}")
        except FileNotFoundError:
            return None
        return content

    def write(self, name: str, content: bytes) -> None:
        """Send a file; see `app.batch.store.Store`."""
        place = f"{self._root}/{name}"
        try:
            self._system.makedirs(place.rpartition("/")[0], exist_ok=True)
            self._system.pipe_file(place, content)
        except OSError as error:
            raise WriteError(f"{place}: cannot be written ({error})") from error


def found(pattern: str) -> list[str]:
    """Return the addresses that a pattern matches.

    Parameters
    ----------
    pattern : str
        An address; its file may be a pattern as in a shell.

    Returns
    -------
    list of str
        Sorted; the address itself where it is no pattern.
    """
    system, path = _filesystem(pattern)
    if not glob.has_magic(path):
        return [pattern]
    return sorted(system.unstrip_protocol(one) for one in system.glob(path))


def fetched(address: str, folder: Path) -> Path:
    """Copy a file from an address.

    Parameters
    ----------
    address : str
        What fsspec knows.
    folder : Path
        Where to.

    Returns
    -------
    Path
        The copy, under its own name.

    Raises
    ------
    OSError
        If it cannot be had.
    """
    system, path = _filesystem(address)
    place = folder / path.rpartition("/")[2]
    system.get_file(path, str(place))
    return place


def _filesystem(address: str) -> tuple[Any, str]:
    try:
        from fsspec.core import url_to_fs
    except ImportError:
        raise ParameterError(
            f"{address}: addresses need fsspec; install it with pip install 'curvelight[cluster]'"
        ) from None
    try:
        system, path = url_to_fs(address)
    except (ValueError, ImportError) as error:
        raise ParameterError(f"{address}: {error}") from None
    return system, str(path)
