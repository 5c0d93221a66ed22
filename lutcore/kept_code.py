"""Machine code that was kept, loaded without what only compiling more of it needs.

Numba reads the LLVM code of each function beside its machine code, so that others can be linked
with it, and imports the modules of all that was inlined into it: its arrays, text, hashes and
random numbers. Machine code looks at neither. That is half of the time that loading takes.
"""

import pickle
import sys
from pathlib import Path
from typing import Any

from llvmlite import binding as llvm
from numba.core.codegen import JITCodeLibrary
from numba.core.environment import Environment, lookup_environment

# How names begin by which Python calls machine code.
_WRAPPER = "_ZN7cpython"
# What numba rebuilds environments with.
_ENVIRONMENT = ("numba.core.environment", "_rebuild_env")


def read(place: str) -> Any:
    """Read what numba has kept of a function.

    Parameters
    ----------
    place : str
        Its file.

    Returns
    -------
    object
        As numba's own reader gives it, but for names in `Environment` that compiled code never
        looks up.
    """
    with Path(place).open("rb") as stream:
        return _Reader(stream).load()


class _Reader(pickle.Unpickler):
    def find_class(self, module: str, name: str) -> Any:
        if (module, name) == _ENVIRONMENT:
            return _environment
        return super().find_class(module, name)


def _environment(module: str, constants: list[Any], name: str) -> Any:
    """Return the constants of a function, with the names of its module if that is there already.

    The module's own name goes along: by it numba keeps the environment again.
    """
    found = lookup_environment(name)
    if found is not None:
        return found
    known = sys.modules.get(module)
    made = Environment({"__name__": module} if known is None else vars(known))
    made.consts[:] = constants
    made.env_name = name
    Environment._memo[name] = made
    return made


class Library(JITCodeLibrary):  # type: ignore[misc]  # numba has no types
    """Machine code whose LLVM code is read when other code is to be linked with it."""

    _unread: bytes | None = None

    @classmethod
    def _unserialize(cls, codegen: Any, state: Any) -> Any:
        name, kind, data = state
        if kind != "object":
            return super()._unserialize(codegen, state)
        library = codegen.create_library(name)
        library.enable_object_caching()
        machine_code, library._unread = data
        library._set_compiled_object(machine_code)
        library._finalize_final_module()
        return library

    def _get_module_for_linking(self) -> Any:
        self._read()
        return super()._get_module_for_linking()

    def get_pointer_to_function(self, name: str) -> int:
        """Return where a function lies in memory; 0 if there is none of that name.

        Parameters
        ----------
        name : str
            Its symbol.

        Returns
        -------
        int
            The address.
        """
        if self._unread is not None and name.startswith(_WRAPPER):
            return self._codegen._engine.get_function_address(name)
        self._read()
        return super().get_pointer_to_function(name)

    def _read(self) -> None:
        if self._unread is not None:
            self._shared_module = llvm.parse_bitcode(self._unread)
            self._unread = None
            self._codegen._engine._load_defined_symbols(self._shared_module)
