"""Contestants run in turns on the same subjects, timed warm, stopped when they take too long."""

import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from app.chart.points import Missing
from lutcore.errors import CancelledError, CurvelightError
from lutcore.progress import Progress, tell

S = TypeVar("S")
R = TypeVar("R")
V = TypeVar("V")
QUICK = 5
"""Calls on each subject of who is quick: one moment of another's work would be most of its time."""
_ENOUGH = 0.2  # seconds after which nobody is called again


@dataclass(frozen=True)
class Contestant(Generic[S, R]):
    """One way to do the work.

    Parameters
    ----------
    name, setting, series : str
        As of a point; see `app.chart.points.Point`.
    run : callable
        Does the work on a subject; asks its progress now and then whether to stop.
    effort : float
        Grows with the time it takes, among those of one series; NaN if that is not known.
    order : float
        Its place along its series, where that is known before it runs.
    """

    name: str
    setting: str
    series: str
    run: Callable[[S, Progress], R]
    effort: float = 0.0
    order: float = 0.0


@dataclass(frozen=True)
class Finished(Generic[S, R, V]):
    """A contestant that ended every time.

    Parameters
    ----------
    contestant : Contestant
        Which.
    seconds : list of float
        What each call took.
    verdicts : list
        What was said of each result.
    """

    contestant: Contestant[S, R]
    seconds: list[float] = field(default_factory=list)
    verdicts: list[V] = field(default_factory=list)


def race(
    contestants: Sequence[Contestant[S, R]],
    subjects: Sequence[S],
    warm_up: S,
    judge: Callable[[Contestant[S, R], S, R], V],
    limit: float,
    progress: Progress,
) -> tuple[list[Finished[S, R, V]], list[Missing]]:
    """Run every contestant on every subject.

    In turns, so that a busy moment of the machine hits all alike; each time after a call on a
    small subject, so that nothing is loaded, started or compiled while the clock runs. Who is
    quick is called several times, the first result counts.

    Parameters
    ----------
    contestants : sequence of Contestant
        Who takes part.
    subjects : sequence
        What they work on, one for each repeat.
    warm_up : object
        A small subject.
    judge : callable
        Says what a result is worth; may raise a CurvelightError for a result that is worth none.
    limit : float
        Seconds for a call. Who takes longer is out, as are those of its series that need more.
    progress : callable
        Told where the work stands; see `lutcore.progress`.

    Returns
    -------
    finished : list of Finished
        Those that ended every time, in the order given.
    missing : list of Missing
        The others, with the reason.

    Raises
    ------
    CancelledError
        If `progress` asked to stop.
    """
    running = [Finished[S, R, V](one) for one in contestants]
    missing: list[Missing] = []
    slow: list[Contestant[S, R]] = []
    for turn, subject in enumerate(subjects):
        still = []
        for at, runner in enumerate(running):
            one = runner.contestant
            share = (turn + at / len(running)) / len(subjects)
            tell(progress, share, _step(one, turn, len(subjects)))
            before = next((other for other in slow if _harder(one, other)), None)
            if before is not None:
                reason = f"not tried: {before.setting or 'default'} took more than {limit:g} s"
                missing.append(Missing(one.name, one.setting, reason))
                continue
            with suppress(Exception):  # if it fails it will fail again, and be heard
                one.run(warm_up, lambda share, step: True)
            watch = _Watch(progress, share, _step(one, turn, len(subjects)), limit)
            try:
                result = one.run(subject, watch)
                took = [watch.stop()]
                while sum(took) < _ENOUGH and len(took) < QUICK:
                    watch.start()
                    one.run(subject, watch)
                    took.append(watch.stop())
                verdict = judge(one, subject, result)
            except CancelledError:
                if not watch.late:
                    raise
                slow.append(one)
                missing.append(Missing(one.name, one.setting, f"took more than {limit:g} s"))
            except Exception as error:  # whatever another's plug-in may raise, the others go on
                missing.append(Missing(one.name, one.setting, reason_of(error)))
            else:
                runner.seconds.extend(took)
                runner.verdicts.append(verdict)
                still.append(runner)
        running = still
    return running, missing


def reason_of(error: Exception) -> str:
    """Return why a contestant is missing.

    Parameters
    ----------
    error : Exception
        What it raised.

    Returns
    -------
    str
        The message of an error that is worded for users, else the error's kind with it.
    """
    if isinstance(error, CurvelightError):
        return str(error)
    first, *_ = str(error).splitlines() or [""]
    return f"fault in it: {type(error).__name__}: {first}"


class _Watch:
    """Stops a call when its time is over, and passes the caller's wish to stop on."""

    def __init__(self, progress: Progress, share: float, step: str, limit: float) -> None:
        self._progress, self._share, self._step, self._limit = progress, share, step, limit
        self.late, self._begin = False, time.perf_counter()

    def __call__(self, share: float, step: str) -> bool:
        self.late = time.perf_counter() - self._begin > self._limit
        return not self.late and self._progress(self._share, self._step)

    def start(self) -> None:
        """Begin to count again."""
        self._begin = time.perf_counter()

    def stop(self) -> float:
        """Return the seconds it took."""
        seconds = time.perf_counter() - self._begin
        self.late = seconds > self._limit
        if self.late:  # it did not look at the clock
            raise CancelledError("too late")
        return seconds


def _step(one: Contestant[S, R], turn: int, turns: int) -> str:
    return f"{one.name} {one.setting}".strip() + f", {turn + 1} of {turns}"


def _harder(one: Contestant[S, R], other: Contestant[S, R]) -> bool:
    alike = (one.name, one.series) == (other.name, other.series)
    return alike and one.effort >= other.effort
