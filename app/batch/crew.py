"""Child processes that draw: warm ones are kept, and replaced when they die."""

import json
import os
import signal
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import msgspec

from app.batch.memory import resident
from app.batch.nursery import Nursery
from app.batch.task import COMPILING, Task
from app.batch.worker import WARM
from lutcore.errors import CancelledError
from lutcore.isolated import Child, IsolatedError

_GIB = 1 << 30
# Importing takes a second or two, compiling a minute; a machine under load, many times as long.
_PATIENCE = 300.0
_FIRST = 2  # calls of a child that has drawn one mesh: warming up, and that mesh


class OversteppedError(IsolatedError):
    """A mesh took more than it may.

    Parameters
    ----------
    reason : str
        ``timeout`` or ``memory``.
    message : str
        What it took.
    """

    def __init__(self, reason: str, message: str) -> None:
        super().__init__(message)
        self.reason = reason


class _Watch:
    """Looks at a child now and then, and ends it when it goes beyond its limits."""

    def __init__(self, child: Child, task: Task, seconds: float, memory_gib: float) -> None:
        self._child = child
        self._compiling = Path(task.pending, COMPILING)
        self._seconds, self._memory = seconds, memory_gib
        self._end = time.monotonic() + seconds

    def __call__(self, share: float, step: str) -> bool:
        late = time.monotonic() - self._end
        # Machine code is made once on a machine: that is not the mesh's fault.
        if late > (_PATIENCE if self._compiling.exists() else 0.0):
            self._overstepped("timeout", f"took more than {self._seconds:g} s")
        held = resident(self._child.pid)
        if held is not None and held > self._memory * _GIB:
            self._overstepped("memory", f"took more than {self._memory:g} GiB of memory")
        return True

    def _overstepped(self, reason: str, message: str) -> None:
        end(self._child)
        raise OversteppedError(reason, message)


class Crew:
    """One warm child process for each thread that asks for work to be done.

    Parameters
    ----------
    environment : dict of str to str
        Variables that the children get.
    """

    def __init__(self, environment: dict[str, str]) -> None:
        self._nursery = Nursery(environment)
        self._mine = threading.local()
        self._all: set[Child] = set()
        self._lock = threading.Lock()
        self._stopped = False

    def do(self, task: Task, seconds: float, memory_gib: float) -> dict[str, Any]:
        """Have a mesh drawn in a child process.

        A child that drew other meshes before and then fails is no proof against this one: it is
        tried again in a new child.

        Parameters
        ----------
        task : Task
            See `app.batch.drawing.drawn`.
        seconds, memory_gib : float
            What it may take.

        Returns
        -------
        dict
            The child's answer, and ``worker``: its process and how many it was the last of.

        Raises
        ------
        OversteppedError
            If it took more than it may.
        IsolatedError
            If it ended the child.
        CancelledError
            If the crew was stopped.
        """
        payload = memoryview(msgspec.json.encode(task))
        while True:
            child = self._child()
            fresh = child.calls < _FIRST
            before = resident(child.pid) or 0
            try:
                answer = child.call(
                    payload, "it", float("inf"), _Watch(child, task, seconds, memory_gib)
                )
            except OversteppedError as error:
                self._lose(child)
                # What earlier meshes left behind may have been too much for this one.
                if fresh or error.reason == "timeout" or before < memory_gib * _GIB / 2.0:
                    raise
                continue
            if answer is not None:
                worker = {"process": child.pid, "meshes": child.calls - 1}
                return json.loads(answer) | {"worker": worker}
            words = child.last_words()
            self._lose(child)
            self._go_on()
            if fresh:
                raise IsolatedError(words)

    def stop(self) -> None:
        """End all children, whatever they do."""
        with self._lock:
            self._stopped = True
            children = list(self._all)
        for child in children:
            end(child)
            child.stop()
        self._nursery.stop()

    def _go_on(self) -> None:
        if self._stopped:
            raise CancelledError("the batch was stopped")

    def _child(self) -> Child:
        """Return this thread's child, warm."""
        child: Child | None = getattr(self._mine, "child", None)
        if child is not None:
            return child
        child = Child(self._nursery.worker())
        with self._lock:
            self._all.add(child)
        self._go_on()
        if (
            child.call(memoryview(WARM), "a new worker", _PATIENCE, lambda share, step: True)
            is None
        ):
            words = child.last_words()
            self._lose(child)
            self._go_on()
            raise IsolatedError(f"a new worker {words.replace(' on it', '')} before it had a mesh")
        self._mine.child = child
        return child

    def _lose(self, child: Child) -> None:
        self._mine.child = None
        end(child)
        child.stop()
        with self._lock:
            self._all.discard(child)


def end(child: Child) -> None:
    """End a child with the processes that it started.

    Parameters
    ----------
    child : Child
        Of `app.batch.worker`, which is a group of its own.
    """
    if hasattr(os, "killpg"):
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(child.pid, signal.SIGKILL)


def environment(parallel: int, whole: bool) -> dict[str, str]:
    """Return the variables for children of which several work at once.

    Parameters
    ----------
    parallel : int
        How many.
    whole : bool
        Whether each shall see all cores: `auto` chooses models by what they cost with as many
        threads as a single command has.

    Returns
    -------
    dict of str to str
        So that together they run about as many threads as there are cores.
    """
    each = max(1, (os.cpu_count() or 1) // parallel)
    if parallel == 1:
        return {}
    # llvmpipe draws in the calling thread where it is given none of its own.
    drawing = {"LP_NUM_THREADS": str(each if each > 1 else 0)}
    return drawing if whole else drawing | {"NUMBA_NUM_THREADS": str(each)}
