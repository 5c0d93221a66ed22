"""Long work off the window's thread: the newest request counts. Knows no Qt."""

import threading
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from app.gui.memory import give_back
from lutcore.errors import CancelledError
from lutcore.progress import Progress

T = TypeVar("T")
Post = Callable[[Callable[[], None]], None]
"""Runs a function on the window's thread, soon, in order."""


@dataclass(frozen=True)
class Standing:
    """Where the work stands.

    Parameters
    ----------
    share : float
        Done, 0 to 1.
    step : str
        What is being done.
    seconds : float
        Since it began.
    """

    share: float
    step: str
    seconds: float


@dataclass(eq=False)
class _Task(Generic[T]):
    key: str
    job: Callable[[Progress], T]
    done: Callable[[T], None]
    failed: Callable[[Exception], None]
    stop: threading.Event = field(default_factory=threading.Event)


class Worker:
    """One thread that does jobs one after another; of each kind only the newest.

    Parameters
    ----------
    post : callable
        Runs a function on the thread that results belong to.
    standing : callable
        Told there, a few times a second, where the work stands; None when nothing is left to do.
    at_rest : iterable of callable
        Done one by one while nothing is asked for, after the first job. Each is short, as a job
        waits for its end; nobody hears of one that fails, as what needs it will fail too.
    """

    _TELL = 0.1
    # Freed memory is given back after so many s without a job, and after so many s of jobs.
    _REST, _LONG = 0.3, 1.0
    _BREATH = 0.05  # s between what is done while nothing is asked for

    def __init__(
        self,
        post: Post,
        standing: Callable[[Standing | None], None],
        at_rest: Iterable[Callable[[], object]] = (),
    ) -> None:
        self.post, self._standing, self._at_rest = post, standing, iter(at_rest)
        self._waiting: dict[str, _Task[object]] = {}
        self._running: _Task[object] | None = None
        self._ended = False
        self._wake = threading.Condition()
        self._thread = threading.Thread(target=self._work, name="curvelight-worker", daemon=True)
        self._thread.start()

    @property
    def busy(self) -> bool:
        """Whether something is being done or waits."""
        with self._wake:
            return bool(self._waiting) or self._running is not None

    def submit(
        self,
        key: str,
        job: Callable[[Progress], T],
        done: Callable[[T], None],
        failed: Callable[[Exception], None],
        supersede: bool = False,
    ) -> None:
        """Ask for a job; one of the same kind that has not begun is dropped.

        Parameters
        ----------
        key : str
            Its kind.
        job : callable
            Runs in the worker's thread with a function to report to; see `lutcore.progress`.
        done : callable
            Gets the result, on the other thread.
        failed : callable
            Gets what the job raised, `CancelledError` apart, on the other thread.
        supersede : bool
            Whether one of the same kind that is running is cancelled too, as its result would be
            of no use; otherwise it ends, so that a stream of requests still shows results.
        """
        task = _Task(key, job, done, failed)
        with self._wake:
            self._waiting.pop(key, None)
            self._waiting[key] = task  # type: ignore[assignment]
            if supersede and self._running is not None and self._running.key == key:
                self._running.stop.set()
            self._wake.notify()

    def cancel(self) -> None:
        """Drop what waits, and stop what runs as soon as it looks."""
        with self._wake:
            self._waiting.clear()
            if self._running is not None:
                self._running.stop.set()

    def close(self, patience: float = 2.0) -> None:
        """End the thread.

        Parameters
        ----------
        patience : float
            Seconds to wait for a job that does not look whether it shall stop.
        """
        self.cancel()
        with self._wake:
            self._ended = True
            self._wake.notify()
        self._thread.join(patience)

    def _work(self) -> None:
        patience: float | None = None
        worked = 0.0
        while True:
            with self._wake:
                asked = self._wake.wait_for(self._asked, patience)
                if self._ended:
                    return
                if asked:
                    task = self._running = self._waiting.pop(next(iter(self._waiting)))
            if not asked:
                patience = self._rest()
                continue
            patience, start = self._REST, time.monotonic()
            self._do(task)
            worked += time.monotonic() - start
            if worked > self._LONG:
                give_back()
                worked = 0.0
            with self._wake:
                self._running = None
                idle = not self._waiting
            if idle:
                self._say(None)

    def _rest(self) -> float | None:
        """Do something that was left for now; return how long to wait for a job then."""
        step = next(self._at_rest, None)
        if step is None:
            give_back()
            return None
        with suppress(Exception):
            step()
        return self._BREATH

    def _asked(self) -> bool:
        return bool(self._waiting) or self._ended

    def _do(self, task: _Task[object]) -> None:
        self._say(Standing(0.0, "computing", 0.0))  # before the job says anything
        try:
            result = task.job(self._reporter(task))
        except CancelledError:
            return
        except Exception as problem:
            error = problem  # the name of an except clause ends with it
            self._deliver(task, lambda: task.failed(error))
        else:
            self._deliver(task, lambda: task.done(result))

    def _deliver(self, task: _Task[object], call: Callable[[], None]) -> None:
        def unless_stopped() -> None:
            if not task.stop.is_set():
                call()

        self._hand_over(unless_stopped)

    def _reporter(self, task: _Task[object]) -> Progress:
        start = told = time.monotonic()

        def report(share: float, step: str) -> bool:
            nonlocal told
            now = time.monotonic()
            if now - told >= self._TELL:
                told = now
                self._say(Standing(share, step, now - start))
            return not task.stop.is_set()

        return report

    def _say(self, standing: Standing | None) -> None:
        self._hand_over(lambda: self._standing(standing))

    def _hand_over(self, call: Callable[[], None]) -> None:
        with self._wake:
            ended = self._ended
        if not ended:
            self.post(call)
