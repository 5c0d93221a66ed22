"""Compiled functions, their cache in a place that can be written and never goes stale.

Numba keys a cached function by its own file alone, so a change in a helper of another file would
leave old machine code in use. The cache folder is therefore named by a digest of every source
that compiles anything.
"""

import os
import threading
from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

# OpenMP's threads wait for the next loop by spinning, unless they are told to sleep before they
# start. Where another program has a core, spinning costs a call of .04 s more than a second.
os.environ.setdefault("OMP_WAIT_POLICY", "passive")

import numba
from numba.core.runtime import rtsys

from lutcore import cache, compiling, kept_code
from lutcore.cache import sources

if TYPE_CHECKING:
    from lutcore.compiler import Compiler

F = TypeVar("F", bound=Callable[..., Any])


def cache_folder() -> Path:
    """Return the folder for compiled code, made if it is missing.

    Returns
    -------
    Path
        See `lutcore.cache.folder`.
    """
    return cache.folder("compiled", sources().compiled, numba.__version__)


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
        found = load(signature, context)
        if found is None:
            compiling.tell()
            if compiling.elsewhere():
                _compiler().compile(dispatcher.py_func, signature)
                found = load(signature, context)
        if found is None:
            getting_ready()  # and the compiler does the rest itself
        return found

    def load(signature: Any, context: Any) -> Any:
        rtsys.initialize(context)
        context.codegen()._library_class = kept_code.Library
        with cache._guard_against_spurious_io_errors():
            return cache._load_overload(signature, context)

    file = cache._cache_file
    file._load_data = lambda name: kept_code.read(file._data_path(name))
    cache.load_overload = attempt
    dispatcher._compilation_chain_init_hook = _nothing


@lru_cache(maxsize=1)
def _compiler() -> "Compiler":
    from lutcore.compiler import Compiler

    return Compiler()


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
