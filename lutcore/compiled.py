"""Compiled functions, their cache in a place that can be written and never goes stale.

Numba keys a cached function by its own file alone, so a change in a helper of another file would
leave old machine code in use. The cache folder is therefore named by a digest of every source
that compiles anything.
"""

import hashlib
import os
import shutil
import stat
import tempfile
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar

# OpenMP's threads wait for the next loop by spinning, unless they are told to sleep before they
# start. Where another program has a core, spinning costs a call of .04 s more than a second.
os.environ.setdefault("OMP_WAIT_POLICY", "passive")

import numba
from numba.core.runtime import rtsys
from platformdirs import user_cache_path

from lutcore import compiling

F = TypeVar("F", bound=Callable[..., Any])
_STALE_AFTER = 30 * 24 * 3600.0


def _digest() -> str:
    root = Path(__file__).parent.parent
    hasher = hashlib.sha256(numba.__version__.encode())
    for package in ("lutcore", "plugins"):
        for path in sorted((root / package).rglob("*.py")):
            source = path.read_bytes()
            if b"lutcore.compiled" in source:
                hasher.update(source)
    return hasher.hexdigest()[:16]


def _writable(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False


def _remove_stale(folder: Path) -> None:
    for old in folder.parent.iterdir():
        with suppress(OSError):  # another process may have removed it first
            if old != folder and time.time() - old.stat().st_mtime > _STALE_AFTER:
                shutil.rmtree(old, ignore_errors=True)


def cache_folder() -> Path:
    """Return the folder for compiled code, made if it is missing.

    Returns
    -------
    Path
        Inside ``CURVELIGHT_CACHE_DIR`` or the user's cache folder where that can be written,
        else inside the folder for temporary files.
    """
    chosen = os.environ.get("CURVELIGHT_CACHE_DIR")
    base = Path(chosen) if chosen else user_cache_path("curvelight")
    folder = base / "compiled" / _digest()
    if not folder.is_dir() and _writable(folder):
        _remove_stale(folder)
    if not _writable(folder):
        folder = _private_folder() / _digest()
        folder.mkdir(exist_ok=True)
    return folder


def _private_folder() -> Path:
    """Return a folder among the temporary files that nobody else can write to.

    Compiled code is loaded from it, so one that another user made or may change is not taken.
    """
    if not hasattr(os, "getuid"):
        return Path(tempfile.mkdtemp(prefix="curvelight-"))  # Windows: already the user's own
    folder = Path(tempfile.gettempdir()) / f"curvelight-{os.getuid()}"
    with suppress(FileExistsError):
        folder.mkdir(mode=0o700)
    found = folder.lstat()
    if found.st_uid != os.getuid() or found.st_mode & 0o022 or not stat.S_ISDIR(found.st_mode):
        return Path(tempfile.mkdtemp(prefix="curvelight-"))
    return folder


_FOLDER = str(cache_folder())
_SETTING = threading.Lock()


def _keep_going(cache: Any) -> None:
    """Let a result be computed although the disk is full and its code cannot be kept."""
    save = cache.save_overload

    def attempt(signature: Any, code: Any) -> None:
        with suppress(OSError):
            save(signature, code)

    cache.save_overload = attempt


def _load_lightly(dispatcher: Any) -> None:
    """Take kept machine code without getting ready to compile; say when it has to be made.

    Numba gets ready first: it imports all that it knows how to compile, SciPy's linear algebra and
    other packages' extensions too, a quarter of a second in each process. Code that is there needs
    nothing of it but the memory manager.
    """
    cache, getting_ready = dispatcher._cache, dispatcher._compilation_chain_init_hook

    def attempt(signature: Any, context: Any) -> Any:
        rtsys.initialize(context)
        with cache._guard_against_spurious_io_errors():
            found = cache._load_overload(signature, context)
        if found is None:
            compiling.tell()
            getting_ready()  # and the compiler does the rest itself
        return found

    cache.load_overload = attempt
    dispatcher._compilation_chain_init_hook = _nothing


def _nothing() -> None:
    """Be called."""


def _pack(dispatcher: Any) -> None:
    """Let LLVM join neighbouring operations into vector instructions; numba leaves that off."""
    compile_ = dispatcher.compile

    def packed(signature: Any) -> Any:
        before = numba.config.SLP_VECTORIZE
        numba.config.SLP_VECTORIZE = 1
        try:
            return compile_(signature)
        finally:
            numba.config.SLP_VECTORIZE = before

    dispatcher.compile = packed


def compiled(*, parallel: bool = False, packed: bool = False) -> Callable[[F], F]:
    """Return the decorator that compiles a function to machine code at its first call.

    Parameters
    ----------
    parallel : bool
        Whether `numba.prange` loops run on all cores. Each iteration must write its own elements
        only, so that results do not depend on the number of threads.
    packed : bool
        Whether runs of like operations become vector instructions: worth it where a loop's body
        does the same to several fields. Compiling takes longer.

    Returns
    -------
    callable
        The decorator.
    """

    def decorate(function: F) -> F:
        # Two threads may import plug-ins at the same time; the folder is one setting for all.
        with _SETTING:
            before = numba.config.CACHE_DIR
            numba.config.CACHE_DIR = _FOLDER
            try:
                # error_model="numpy": no branch for division by zero, so that loops vectorise.
                jit = numba.njit(cache=True, parallel=parallel, error_model="numpy", nogil=True)
                dispatcher = jit(function)
                _keep_going(dispatcher._cache)
                _load_lightly(dispatcher)
                if packed:
                    _pack(dispatcher)
                return dispatcher
            finally:
                numba.config.CACHE_DIR = before

    return decorate
