"""Folders for what is made once on a machine and kept: named by the code that made it.

A folder is named by a digest of sources, so that nothing in it is ever older than the code.
"""

import hashlib
import os
import shutil
import stat
import tempfile
import time
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from platformdirs import user_cache_path

_STALE_AFTER = 30 * 24 * 3600.0


class Sources(NamedTuple):
    """Digests of the sources of `lutcore` and of the plug-ins, hexadecimal.

    Parameters
    ----------
    compiled : str
        Of those that compile anything.
    every : str
        Of all.
    """

    compiled: str
    every: str


@lru_cache(maxsize=1)
def sources() -> Sources:
    """Return the digests of the sources as they are now.

    Returns
    -------
    Sources
        The digests.
    """
    root = Path(__file__).parent.parent
    compiled, every = hashlib.sha256(), hashlib.sha256()
    for package in ("lutcore", "plugins"):
        for path in sorted((root / package).rglob("*.py")):
            source = path.read_bytes()
            every.update(source)
            if b"lutcore.compiled" in source:
                compiled.update(source)
    return Sources(compiled.hexdigest(), every.hexdigest())


def folder(kind: str, *makers: str) -> Path:
    """Return the folder for what a state of the code made, itself made if it is missing.

    Parameters
    ----------
    kind : str
        What is kept there.
    *makers : str
        Digests and versions that it depends on.

    Returns
    -------
    Path
        Inside ``CURVELIGHT_CACHE_DIR`` or the user's cache folder where that can be written,
        else inside the folder for temporary files.
    """
    chosen = os.environ.get("CURVELIGHT_CACHE_DIR")
    base = Path(chosen) if chosen else user_cache_path("curvelight")
    name = hashlib.sha256("\n".join(makers).encode()).hexdigest()[:16]
    found = base / kind / name
    if not found.is_dir() and _writable(found):
        _remove_stale(found)
    if not _writable(found):
        found = _private_folder() / kind / name
        found.mkdir(parents=True, exist_ok=True)
    return found


def _writable(place: Path) -> bool:
    try:
        place.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=place):
            return True
    except OSError:
        return False


def _remove_stale(place: Path) -> None:
    for old in place.parent.iterdir():
        with suppress(OSError):  # another process may have removed it first
            if old != place and time.time() - old.stat().st_mtime > _STALE_AFTER:
                shutil.rmtree(old, ignore_errors=True)


def _private_folder() -> Path:
    """Return a folder among the temporary files that nobody else can write to.

    Compiled code is loaded from it, so one that another user made or may change is not taken.
    """
    if not hasattr(os, "getuid"):
        return Path(tempfile.mkdtemp(prefix="curvelight-"))  # Windows: already the user's own
    place = Path(tempfile.gettempdir()) / f"curvelight-{os.getuid()}"
    with suppress(FileExistsError):
        place.mkdir(mode=0o700)
    found = place.lstat()
    if found.st_uid != os.getuid() or found.st_mode & 0o022 or not stat.S_ISDIR(found.st_mode):
        return Path(tempfile.mkdtemp(prefix="curvelight-"))
    return place
