"""Where workers come from: forked from one process that is ready, or each started by itself."""

import os
import select
import signal
import socket
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, suppress
from typing import IO

from app.batch.cradle import NUMBER
from lutcore.errors import CancelledError
from lutcore.isolated import Child, IsolatedError, Process, started

# Elsewhere a fork is not safe, or there is none.
_FORKS = sys.platform.startswith("linux")
# Importing takes a second or two; a machine under load, many times as long.
_PATIENCE = 300.0
_TRIES = 2
_CRADLE = "app.batch.cradle"


class Nursery:
    """Gives workers: from a second on, in hundredths of a second where they are forked.

    Parameters
    ----------
    environment : dict of str to str
        Variables that they get.
    """

    def __init__(self, environment: dict[str, str]) -> None:
        self._environment = environment
        self._lock = threading.Lock()
        self._cradle: _Cradle | None = None
        self._stopped = False

    def worker(self) -> Process:
        """Return a new worker.

        Returns
        -------
        Process
            It runs `app.batch.worker`.

        Raises
        ------
        IsolatedError
            If none can be had.
        CancelledError
            After `stop`.
        """
        if not _FORKS:
            return started("app.batch.worker", self._environment)
        with self._lock:
            for _ in range(_TRIES):
                if self._stopped:
                    raise CancelledError("no worker is wanted any more")
                self._cradle = self._cradle or _Cradle(self._environment)
                try:
                    return Forked(self._cradle.line)
                except OSError:
                    words = self._cradle.stop()
                    self._cradle = None
            raise IsolatedError(f"no worker can be started: importing {words}")

    def stop(self) -> None:
        """Give no more, and end those that are left."""
        self._stopped = True
        if self._cradle is not None:
            self._cradle.stop()  # whoever waits for a worker holds the lock
        with self._lock:
            if self._cradle is not None:
                self._cradle.stop()


class _Cradle:
    """The process of `app.batch.cradle`."""

    def __init__(self, environment: dict[str, str]) -> None:
        # It ends with the thread that starts it, and those that ask for workers come and go.
        self._keeper = ThreadPoolExecutor(1, thread_name_prefix="cradle")
        self.line, theirs = socket.socketpair()
        with theirs:
            process = self._keeper.submit(started, _CRADLE, environment, theirs.fileno()).result()
        self._child = Child(process)

    def stop(self) -> str:
        """End it; return what became of it."""
        self._child.stop()
        self.line.close()
        self._keeper.shutdown()
        return self._child.last_words().replace(" on it", "")


class Forked:
    """A worker that `app.batch.cradle` has forked; for `lutcore.isolated.Child`.

    Parameters
    ----------
    cradle : socket
        Where that is asked.

    Raises
    ------
    OSError
        If it has gone, or does not answer.
    """

    def __init__(self, cradle: socket.socket) -> None:
        with ExitStack() as theirs, ExitStack() as ours:
            ends = [_pipe(theirs, ours, told=told) for told in (False, True, True, True)]
            socket.send_fds(cradle, [b"+"], [end for end, _ in ends])
            theirs.close()
            stdin, stdout, stderr, line = (end for _, end in ends)
            if not select.select([line], [], [], _PATIENCE)[0]:
                raise TimeoutError("no answer")
            process = _number(line)
            if process is None:
                raise ConnectionResetError("it has gone")
            ours.pop_all()
        self.pid = process
        self.stdin: IO[bytes] | None = os.fdopen(stdin, "wb")
        self.stdout: IO[bytes] | None = os.fdopen(stdout, "rb")
        self.stderr: IO[bytes] | None = os.fdopen(stderr, "rb")
        self._line = line
        self._lock = threading.Lock()
        self._code: int | None = None

    def wait(self) -> int:
        """Wait for its end; see `lutcore.isolated.Process`."""
        with self._lock:
            if self._code is None:
                status = _number(self._line)
                os.close(self._line)
                # Where the cradle has gone without a word, the worker went with it.
                ended = int(signal.SIGKILL) if status is None else status
                self._code = os.waitstatus_to_exitcode(ended)
            return self._code

    def kill(self) -> None:
        """End it, if it has not ended; see `lutcore.isolated.Process`."""
        with self._lock:
            if self._code is None and not select.select([self._line], [], [], 0.0)[0]:
                with suppress(ProcessLookupError):
                    os.kill(self.pid, signal.SIGKILL)


def _pipe(theirs: ExitStack, ours: ExitStack, told: bool) -> tuple[int, int]:
    """Return their end of a new pipe and ours, which tells or is told."""
    reading, writing = os.pipe()
    their, our = (writing, reading) if told else (reading, writing)
    theirs.callback(os.close, their)
    ours.callback(os.close, our)
    return their, our


def _number(line: int) -> int | None:
    """Return the next number that the cradle tells of a worker; None if it has gone."""
    told = os.read(line, NUMBER)
    return int.from_bytes(told, "little") if told else None
