"""Speed against accuracy of the curvature estimators on a surface whose curvature is known."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from app.chart.contestants import Estimating, Subject, spacing_of
from app.chart.measuring import Measuring, Run, Verdict, values_of, verdict_of
from app.chart.points import Chart
from app.chart.reference import distance
from lutcore import analytic
from lutcore.analytic import Exact
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import ParameterError
from lutcore.progress import Progress

SURFACES: Mapping[str, Callable[..., Exact]] = {
    "torus": analytic.torus,
    "sphere": analytic.sphere,
    "ellipsoid": analytic.ellipsoid,
    "cylinder": analytic.cylinder,
    "saddle": analytic.saddle,
    "monkey-saddle": analytic.monkey_saddle,
}
"""Surfaces by name."""


def surface_chart(
    surface: str,
    vertices: int,
    irregular: bool,
    names: Sequence[str],
    spacings: Sequence[float],
    measuring: Measuring,
    tolerance: float | None,
    progress: Progress,
) -> Chart:
    """Measure estimators on a surface whose curvature is known exactly.

    The error is the root mean square of (k1, k2) less the truth over that of the truth, over all
    vertices; where an estimator has no value it counts as 0.

    Parameters
    ----------
    surface : str
        One of `SURFACES`.
    vertices : int
        Number of its vertices, nearly.
    irregular : bool
        Whether they are random.
    names : sequence of str
        Estimators.
    spacings : sequence of float
        Lengths to average over, in spacings.
    measuring : Measuring
        How.
    tolerance : float or None
        Error that is accepted, as a share.
    progress : callable
        Told where the work stands; see `lutcore.progress`.

    Returns
    -------
    Chart
        What was found.

    Raises
    ------
    ParameterError
        If the surface does not exist.
    CancelledError
        If `progress` asked to stop.
    """
    if surface not in SURFACES:
        raise ParameterError.unknown("surface", surface, SURFACES)
    subjects = []
    for seed in range(measuring.seed, measuring.seed + measuring.repeats):
        exact = SURFACES[surface](vertices, irregular, seed=seed)
        mesh = exact.noisy(measuring.noise, seed) if measuring.noise > 0.0 else exact.mesh
        subjects.append(Subject(mesh, spacing_of(mesh), exact.truth))
    run = Run(names, spacings, measuring, progress)
    finished = run.race(subjects, _against_truth)
    points = [run.point(one, [verdict.error for verdict in one.verdicts]) for one in finished]
    triangulation = "random triangulation" if irregular else "regular triangulation"
    count = len(subjects[0].mesh.vertices)
    noise = f"noise {100 * measuring.noise:g} % of the mean edge" if measuring.noise else "no noise"
    return run.chart(
        subject=f"{surface}, {count:,} vertices, {triangulation}, {noise}",
        error="Error is the RMS of (k1, k2) less the truth, over the RMS of the truth.",
        points=points,
        tolerance=tolerance,
        facts={
            "surface": surface,
            "vertices": count,
            "irregular": irregular,
            "error": "against truth",
        },
    )


def _against_truth(_: Estimating, subject: Subject, found: PrincipalCurvatures) -> Verdict:
    assert subject.truth is not None
    truth = values_of(subject.truth)
    error = distance(values_of(found), truth) / distance(truth, np.zeros_like(truth))
    return verdict_of(error, subject, found)
