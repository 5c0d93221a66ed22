"""One measurement of curvature estimators: how, who takes part, and what becomes of them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass

import numpy as np

from app.chart.contestants import Estimating, Subject, contestants, spacing_of
from app.chart.front import advise, pareto_front
from app.chart.machine import machine
from app.chart.measure import Measure
from app.chart.points import Advice, Chart, Point, Spread
from app.chart.race import Finished, race
from lutcore import analytic
from lutcore.arrays import FloatArray
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import ParameterError
from lutcore.parameters import Parameters, param
from lutcore.progress import Progress, part

_WARM_UP = 400
_PARTS = ("change", "bias")
_TIME = (
    "Time is that of a warm call, joining of vertices included; other packages work in a child "
    "process, the way there and back included. h is the spacing, the root of the median vertex "
    "area."
)


@dataclass(frozen=True)
class Measuring(Parameters):
    """How a chart is measured; each parameter says what it is."""

    noise: float = param(0.02, 0.0, 1.0, "", "Noise along the normal, share of an edge.")
    repeats: int = param(3, 1, 100, "", "Measurements of each, every one with other noise.")
    limit: float = param(10.0, 0.01, 1e5, "s", "Who takes longer for a call is stopped.")
    seed: int = param(0, 0, 2**31 - 1, "", "Seed of the noise and of random triangulations.")


@dataclass(frozen=True)
class Verdict:
    """What one result is worth.

    Parameters
    ----------
    error : float
        Its error, or what will become of it.
    scale : float
        Mean length it averaged over, in spacings of the mesh.
    without : float
        Share of the vertices that have no value.
    """

    error: float
    scale: float
    without: float


Estimated = Finished[Subject, PrincipalCurvatures, Verdict]


class Run:
    """One measurement.

    Parameters
    ----------
    names : sequence of str
        Estimators.
    spacings : sequence of float
        Lengths to average over, in spacings of the mesh.
    measuring : Measuring
        How.
    progress : callable
        Told where the work stands; see `lutcore.progress`.
    """

    def __init__(
        self,
        names: Sequence[str],
        spacings: Sequence[float],
        measuring: Measuring,
        progress: Progress,
    ) -> None:
        self.measuring = measuring
        self._progress = part(progress, 0.05, 1.0)
        small = analytic.torus(_WARM_UP).mesh
        self._warm_up = Subject(small, spacing_of(small))
        self._taking, self._missing, self._first = contestants(
            names, spacings, self._warm_up, part(progress, 0.0, 0.05)
        )

    def race(
        self,
        subjects: Sequence[Subject],
        judge: Callable[[Estimating, Subject, PrincipalCurvatures], Verdict],
    ) -> list[Estimated]:
        """Run every contestant on every subject; see `app.chart.race`.

        Parameters
        ----------
        subjects : sequence of Subject
            Meshes of as many vertices.
        judge : callable
            Says what an estimate is worth.

        Returns
        -------
        list of Finished
            Those that ended every time; of lengths that came to the same one, the first.
        """
        self._count = len(subjects[0].mesh.vertices)
        finished, missing = race(
            self._taking, subjects, self._warm_up, judge, self.measuring.limit, self._progress
        )
        self._missing += missing
        return _different(finished)

    def point(self, one: Estimated, errors: Sequence[float], **details: float) -> Point:
        """Return the point of a contestant.

        Parameters
        ----------
        one : Finished
            From `race`.
        errors : sequence of float
            Its errors, as shares.
        **details : float
            What else was measured.

        Returns
        -------
        Point
            With its times, its scale and its first call.
        """
        last = one.verdicts[-1]
        return Point(
            name=one.contestant.name,
            setting=one.contestant.setting,
            time=Spread.of([seconds / self._count for seconds in one.seconds]),
            error=Spread.of(errors),
            series=one.contestant.series,
            order=last.scale,
            details={
                **details,
                "scale_spacings": last.scale,
                "share_not_estimated": last.without,
                "first_call_seconds": self._first[one.contestant.name],
            },
        )

    def chart(
        self,
        subject: str,
        error: str,
        points: Sequence[Point],
        tolerance: float | None,
        facts: Mapping[str, object],
        advice: Advice | None = None,
    ) -> Chart:
        """Return the chart of some points.

        Parameters
        ----------
        subject, error : str
            What it was measured on, and what the error is.
        points : sequence of Point
            From `point`.
        tolerance : float or None
            Error that is accepted, as a share.
        facts : mapping of str to object
            What a script wants to know.
        advice : Advice, optional
            Where it does not follow from the points.

        Returns
        -------
        Chart
            With the front, the recommendation, those without figures and the machine.
        """
        front = pareto_front(points)
        known = points[0].details if points else {}
        measured = (
            f"Measurements: {self.measuring.repeats}; points at the median error and the least "
            "time, bars from least to greatest."
        )
        return Chart(
            subject=subject,
            meaning=(error, _TIME, measured),
            points=tuple(points),
            front=front,
            missing=tuple(self._missing),
            advice=advice or advise(front, tolerance),
            tolerance=tolerance,
            machine=machine(),
            facts={**facts, **asdict(self.measuring), "first_call_seconds": self._first},
            columns={key: Measure(key, 100.0, "%") for key in _PARTS if key in known},
        )


def _different(finished: Sequence[Estimated]) -> list[Estimated]:
    """Leave out lengths that come to one already there: the default, or as many rings."""
    kept: dict[tuple[str, str, float], Estimated] = {}
    for one in finished:
        scale = one.verdicts[0].scale
        key = one.contestant.name, one.contestant.series, round(scale, 6)
        kept.setdefault(key, one)
    return list(kept.values())


def values_of(found: PrincipalCurvatures) -> FloatArray:
    """Return k1 and k2 as one array.

    Parameters
    ----------
    found : PrincipalCurvatures
        Of n vertices.

    Returns
    -------
    ndarray, shape=(n, 2)
        In 1/mesh unit.
    """
    return np.stack([found.k1, found.k2], axis=1)


def verdict_of(error: float, subject: Subject, found: PrincipalCurvatures) -> Verdict:
    """Return what an estimate is worth.

    Parameters
    ----------
    error : float
        Its error.
    subject : Subject
        What it was made on.
    found : PrincipalCurvatures
        The estimate.

    Returns
    -------
    Verdict
        The error with what else is kept.

    Raises
    ------
    ParameterError
        If the error is not finite.
    """
    if not np.isfinite(error):
        raise ParameterError("it gave values that are not finite, or beyond all bounds")
    return Verdict(
        error,
        float(np.mean(found.scale)) / subject.spacing,
        float(np.mean(~found.estimated)),
    )
