"""Files that a mesh file names: only those beside it, or below its folder."""

import stat
from pathlib import Path

from app.loading.errors import BadContentError

_BESIDE = "put the file that it names beside it"
_MOST_BYTES = 1 << 30


def beside(folder: Path, name: str) -> bytes:
    """Return the content of a file that a mesh file names.

    Parameters
    ----------
    folder : Path
        Where the mesh file lies.
    name : str
        As it is named there, with slashes.

    Returns
    -------
    bytes
        The whole file.

    Raises
    ------
    BadContentError
        If it is not there, lies elsewhere, is no file or too large.
    """
    shown = name[:80].encode("ascii", "backslashreplace").decode()
    try:
        inside = folder.resolve()
        path = (inside / name).resolve()
        if not path.is_relative_to(inside):
            raise BadContentError(f"{shown!r} lies outside its folder", _BESIDE)
        found = path.stat()
        if not stat.S_ISREG(found.st_mode):
            raise BadContentError(f"{shown!r} is no file", _BESIDE)
        if found.st_size > _MOST_BYTES:
            raise BadContentError(f"{shown!r} is larger than {_MOST_BYTES >> 20} MiB", _BESIDE)
        return path.read_bytes()
    except (OSError, RuntimeError, ValueError):
        raise BadContentError(f"{shown!r} is not there, or cannot be read", _BESIDE) from None
