"""Run a function on arrays in a child process, with limits of time and memory.

For foreign code that may crash, hang or eat the memory. The child is a fresh interpreter, not a
fork: threads of this process do not matter to it. Arrays travel through its pipes.
"""

import atexit
import io
import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Mapping
from pathlib import Path
from typing import IO, Protocol

import numpy as np

from lutcore.arrays import AnyArray
from lutcore.errors import CurvelightError
from lutcore.isolated_child import JOB, PROBLEM, SHORTAGE, pack, receive, send, short, unpack
from lutcore.progress import Progress, silent, tell

_ROOT = Path(__file__).parents[1]
_CHUNK = 1 << 16
_LISTEN = 2.0  # seconds
_POLL = 0.1  # seconds between looks at the clock and at the caller's wish to stop


class IsolatedError(CurvelightError):
    """Foreign code failed, crashed, or went beyond its time or memory."""


class ShortageError(IsolatedError):
    """Foreign code asked for more memory than it was given.

    Parameters
    ----------
    label : str
        Who did the work.
    memory : int
        Bytes that it was given.
    """

    def __init__(self, label: str, memory: int) -> None:
        super().__init__(f"{label} takes more than {memory >> 30} GiB of memory")
        self.memory = memory


def run_isolated(
    function: str,
    arrays: Mapping[str, AnyArray],
    *,
    label: str,
    seconds: float,
    memory: int,
    keep: bool = False,
    progress: Progress = silent,
) -> dict[str, AnyArray]:
    """Call ``function(**arrays)`` in a child process.

    Parameters
    ----------
    function : str
        Module and name, ``"package.module:name"``. It takes and returns arrays by name.
    arrays : mapping of str to ndarray
        Its arguments; of numbers, truth values or text, not of objects.
    label : str
        Who does the work, in words, for messages: ``"MeshLab"``.
    seconds : float
        Time it may take.
    memory : int
        Bytes of address space it may use, where the system can limit that.
    keep : bool
        Whether the child waits for the next such call instead of starting anew each time. A call
        that crashes a child with a past is tried again in a new one.
    progress : callable
        Told now and then that the work goes on; see `lutcore.progress`.

    Returns
    -------
    dict of str to ndarray
        What the function returned.

    Raises
    ------
    IsolatedError
        If it raised anything, crashed, or went beyond its time; `ShortageError` beyond its memory.
    CancelledError
        If `progress` asked to stop.
    """
    job = json.dumps({"function": function, "memory": memory})
    payload = pack({**arrays, JOB: np.array(job)})
    child = _idle_or_new() if keep else Child(started())
    answer = child.call(payload, label, seconds, progress)
    if answer is None and child.calls > 1:
        child.stop()
        child = Child(started())
        answer = child.call(payload, label, seconds, progress)
    if answer is None:
        words = child.last_words()
        raise ShortageError(label, memory) if child.was_short else IsolatedError(f"{label} {words}")
    if keep and not _idle:
        _idle.append(child)
    else:
        child.stop()
    found = unpack(answer)
    if SHORTAGE in found:
        raise ShortageError(label, memory)
    if PROBLEM in found:
        raise IsolatedError(f"{label} {found[PROBLEM]}")
    return found


class Process(Protocol):
    """A process with pipes, as `subprocess.Popen` is one."""

    pid: int
    stdin: IO[bytes] | None
    stdout: IO[bytes] | None
    stderr: IO[bytes] | None

    def wait(self) -> int:
        """Wait for its end; return its exit code, or the negative number of a signal."""

    def kill(self) -> None:
        """End it, if it has not ended."""


def started(
    module: str = "lutcore.isolated_child",
    environment: Mapping[str, str] | None = None,
    stdin: int = subprocess.PIPE,
) -> "subprocess.Popen[bytes]":
    """Start a module of ours in a fresh interpreter.

    Parameters
    ----------
    module : str
        What it runs: for `Child`, a loop over `lutcore.isolated_child.receive` and ``send``.
    environment : mapping of str to str, optional
        Variables that it gets beside those of this process.
    stdin : int
        What it reads from: a pipe to this process, or an open file's number.

    Returns
    -------
    Popen
        The process.
    """
    # -P, so that a folder of our packages' names where the user stands is not taken for them.
    command = [sys.executable, "-P", "-m", module]
    paths = [str(_ROOT), *(entry for entry in sys.path if entry)]
    # Each thread and each arena of the allocator reserves address space, which is limited.
    few = {"OPENBLAS_NUM_THREADS": "1", "MALLOC_ARENA_MAX": "2"}
    return subprocess.Popen(  # noqa: S603  # our own interpreter and module
        command,
        env=os.environ | few | dict(environment or {}) | {"PYTHONPATH": os.pathsep.join(paths)},
        stdin=stdin,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )


class Child:
    """One child process; its pipes carry a job to it and the answer back.

    Parameters
    ----------
    process : Process
        See `started`.
    """

    def __init__(self, process: Process) -> None:
        self.calls = 0
        self._process = process
        self._said = b""
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._listener.start()

    @property
    def pid(self) -> int:
        """Number of the process."""
        return self._process.pid

    def call(
        self, payload: memoryview, label: str, seconds: float, progress: Progress
    ) -> bytes | None:
        """Hand a job over and wait for its answer.

        Parameters
        ----------
        payload : memoryview
            The job.
        label : str
            Who does the work, in words, for messages.
        seconds : float
            Time it may take.
        progress : callable
            Told now and then that the work goes on; if it raises, the process is ended.

        Returns
        -------
        bytes or None
            The answer; None if the process ended without one.

        Raises
        ------
        IsolatedError
            If it takes longer.
        CancelledError
            If `progress` asked to stop.
        """
        self.calls += 1
        answers: list[bytes | None] = []
        worker = threading.Thread(target=self._exchange, args=(payload, answers), daemon=True)
        worker.start()
        end = time.monotonic() + seconds
        try:
            while worker.is_alive():
                worker.join(_POLL)
                if worker.is_alive():
                    tell(progress, 0.1, f"waiting for {label}")
                    if time.monotonic() > end:
                        raise IsolatedError(f"{label} took more than {seconds:.0f} s")
        except BaseException:
            self.stop()
            raise
        return answers[0] if answers else None

    def _exchange(self, payload: memoryview, answers: list[bytes | None]) -> None:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        try:
            send(self._process.stdin, payload)
            answers.append(receive(self._process.stdout))
        except (OSError, ValueError):  # the pipe broke, or was closed by `stop`
            return

    def _listen(self) -> None:
        """Keep the end of what it says, which tells why it crashed."""
        pipe = self._process.stderr
        assert pipe is not None
        with pipe:
            while chunk := os.read(pipe.fileno(), _CHUNK):
                self._said = (self._said + chunk)[-_CHUNK:]

    @property
    def was_short(self) -> bool:
        """Whether a process that ended without an answer had asked for memory in vain."""
        self._process.wait()
        self._listener.join(_LISTEN)  # for ever only if it has children that live on
        return short(self._said.decode(errors="replace"))

    def last_words(self) -> str:
        """Say what became of a process that ended without an answer.

        Returns
        -------
        str
            How it ended, to follow the name of who did the work.
        """
        code = self._process.wait()
        self.stop()
        if code < 0:
            return f"crashed on it ({signal.Signals(-code).name})"
        if code > 255:  # Windows tells an exception of the processor by its number
            return f"crashed on it (0x{code:08X})"
        return "failed on it (no reason given)"

    def stop(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None and not pipe.closed:
                _close(pipe)


def _close(pipe: io.BufferedIOBase | object) -> None:
    try:
        pipe.close()  # type: ignore[union-attr]
    except OSError:  # what was still to be written has no reader any more
        return


_idle: list[Child] = []


def _idle_or_new() -> Child:
    try:
        return _idle.pop()  # asking first whether there is one would race with other threads
    except IndexError:
        return Child(started())


@atexit.register
def _stop_idle() -> None:
    while _idle:
        _idle.pop().stop()
