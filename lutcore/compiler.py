"""Compile in a child process; see `lutcore.compiling.compile_elsewhere`."""

import threading
from collections.abc import Callable
from typing import Any

from numba.core.serialize import dumps

from lutcore.isolated import Child, started
from lutcore.progress import silent

_LONGEST = 1200.0  # seconds for one function and all that it calls, on a machine under load
_LINGER = 10.0  # seconds that a child waits for another function: its start takes one


class Compiler:
    """A child process that is there while there is something to compile."""

    def __init__(self) -> None:
        self._using = threading.Lock()
        self._child: Child | None = None
        self._end: threading.Timer | None = None

    def compile(self, function: Callable[..., Any], signature: Any) -> None:
        """Have a function compiled and kept on the disk.

        What is not there afterwards could not be: the disk is full, or the function does not
        compile. The caller will find out which.

        Parameters
        ----------
        function : callable
            What was decorated with `lutcore.compiled.compiled`, in a module.
        signature : tuple or numba.core.typing.Signature
            Types of its arguments.

        Raises
        ------
        IsolatedError
            If it takes much too long.
        """
        job = memoryview(dumps((function.__module__, function.__qualname__, signature)))
        with self._using:
            if self._end is not None:
                self._end.cancel()
            child, self._child = self._child or Child(started("lutcore.compiler_child")), None
            if child.call(job, "the compiler", _LONGEST, silent) is None:
                child.stop()
                return
            self._child = child
            self._end = threading.Timer(_LINGER, self._stop)
            self._end.daemon = True
            self._end.start()

    def _stop(self) -> None:
        with self._using:
            if self._child is not None:
                self._child.stop()
                self._child = None
