"""The gallery of failures, run over curvature estimators: who survives, and by how much."""

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import CancelledError, CurvelightError
from lutcore.estimation import principal_curvatures
from lutcore.gallery.case import Case, Subject
from lutcore.gallery.judgement import Score, Verdict, score, verdict_of
from lutcore.gallery.surfaces import egg
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress, silent, tell

_WARM_UP = 200  # vertices
# Seconds for that: on a machine's first run some estimators compile for half a minute.
_START = 90.0


@dataclass(frozen=True)
class Outcome:
    """What became of one estimator on one case.

    Parameters
    ----------
    case, method : str
        Names.
    verdict : Verdict
        The class.
    message : str
        What the estimator said, or did that none may do; empty if nothing.
    score : Score or None
        Errors; None if it gave no values.
    without : float or None
        Its error without the defect; None if it gave no values there.
    seconds : float
        Time of the call.
    """

    case: str
    method: str
    verdict: Verdict
    message: str
    score: Score | None
    without: float | None
    seconds: float

    @property
    def ratio(self) -> float | None:
        """How many times larger the defect makes the error; None if that cannot be said."""
        if self.score is None or not self.without or not np.isfinite(self.without):
            return None
        return self.score.error / self.without


@dataclass(frozen=True)
class Report:
    """All outcomes of a run.

    Parameters
    ----------
    cases : sequence of Case
        What was tried.
    methods : sequence of str
        On whom; those that survive most come first.
    outcomes : dict
        Outcome by the names of case and estimator.
    seed : int
        Of everything random in the cases.
    limit : float
        Seconds that one call might take.
    """

    cases: Sequence[Case]
    methods: Sequence[str]
    outcomes: dict[tuple[str, str], Outcome]
    seed: int
    limit: float

    def count(self, method: str) -> dict[Verdict, int]:
        """Count an estimator's verdicts.

        Parameters
        ----------
        method : str
            Its name.

        Returns
        -------
        dict of Verdict to int
            Number of cases, for every verdict.
        """
        return _count(self.outcomes, method)


def examine(
    cases: Sequence[Case],
    methods: Sequence[str],
    *,
    seed: int,
    limit: float,
    progress: Progress = silent,
) -> Report:
    """Run every estimator on every case, with and without its defect.

    Parameters
    ----------
    cases : sequence of Case
        From `lutcore.gallery.catalogue.build`.
    methods : sequence of str
        Names of estimators.
    seed : int
        That the cases were built with.
    limit : float
        Seconds after which an estimator is stopped and has died.
    progress : callable
        Told where the work stands; see `lutcore.progress`.

    Returns
    -------
    Report
        One outcome for each estimator and case.

    Raises
    ------
    CancelledError
        If `progress` asked to stop.
    """
    outcomes: dict[tuple[str, str], Outcome] = {}
    steps = len(methods) * (len(cases) + 1)
    for row, method in enumerate(methods):
        bench = _Bench(method, limit, progress)
        bench.at(row * (len(cases) + 1) / steps, f"{method}: starting")
        bench.warm_up()
        for column, case in enumerate(cases):
            done = (row * (len(cases) + 1) + column + 1) / steps
            bench.at(done, f"{method}: {case.title}")
            outcomes[case.name, method] = bench.outcome(case)
    ranked = sorted(methods, key=lambda method: _rank(_count(outcomes, method)), reverse=True)
    return Report(cases, ranked, outcomes, seed, limit)


@dataclass(frozen=True)
class _Attempt:
    """One call: values, or the verdict and the message of who gave none."""

    found: PrincipalCurvatures | None
    verdict: Verdict
    message: str
    seconds: float


class _Bench:
    """One estimator at work under a time limit."""

    def __init__(self, method: str, limit: float, progress: Progress) -> None:
        self._method, self._limit, self._progress = method, limit, progress
        self._where = 0.0, ""
        # Many cases share their sound mesh: it is measured once.
        self._sound: dict[TriangleMesh, _Attempt] = {}

    def at(self, share: float, step: str) -> None:
        """Say where the whole run stands."""
        self._where = share, step
        tell(self._progress, share, step)

    def warm_up(self) -> None:
        """Let compiling and starting happen before anything is timed."""
        closed = egg(_WARM_UP).mesh
        for mesh in (closed, TriangleMesh(closed.vertices, closed.faces[:_WARM_UP])):
            if self._attempt(mesh, max(_START, self._limit)).found is None:
                return

    def outcome(self, case: Case) -> Outcome:
        """Run the estimator on a case."""
        if case.sound.mesh not in self._sound:
            self._sound[case.sound.mesh] = self._attempt(case.sound.mesh, self._limit)
        without = _score(self._sound[case.sound.mesh], case.sound)
        attempt = self._attempt(case.broken.mesh, self._limit)
        judged = _score(attempt, case.broken)
        return Outcome(
            case=case.name,
            method=self._method,
            verdict=attempt.verdict if judged is None else judged.verdict,
            message=attempt.message if judged is None else judged.fault,
            score=judged,
            without=None if without is None else without.error,
            seconds=attempt.seconds,
        )

    def _attempt(self, mesh: TriangleMesh, limit: float) -> _Attempt:
        start = time.monotonic()
        late = False

        def watch(share: float, step: str) -> bool:
            nonlocal late
            late = time.monotonic() - start > limit
            return self._progress(*self._where) and not late

        found, verdict, message = None, Verdict.DIED, ""
        try:
            # What an estimator computes on the way to a wrong value is part of the verdict.
            with np.errstate(all="ignore"):
                found = principal_curvatures(mesh, self._method, progress=watch)
        except CancelledError:
            if not late:
                raise
            message = f"took more than {limit:g} s"
        except CurvelightError as error:
            verdict, message = verdict_of(error), " ".join(str(error).split())
        except Exception as error:  # an estimator's fault is what the gallery is there to find
            message = f"fault in the estimator: {type(error).__name__}: {error}"
        return _Attempt(found, verdict, message, time.monotonic() - start)


def _score(attempt: _Attempt, subject: Subject) -> Score | None:
    return None if attempt.found is None else score(attempt.found, subject)


def _count(outcomes: dict[tuple[str, str], Outcome], method: str) -> dict[Verdict, int]:
    found = [one.verdict for (_, name), one in outcomes.items() if name == method]
    return {verdict: found.count(verdict) for verdict in Verdict}


def _rank(count: dict[Verdict, int]) -> tuple[int, int, int]:
    """Order by survivors, then by the degraded; a refusal is better than a wrong value."""
    return count[Verdict.SURVIVES], count[Verdict.DEGRADED], count[Verdict.REFUSED]
