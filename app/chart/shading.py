"""Speed against accuracy of the shading models on a user's own mesh."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from app.chart.front import advise, pareto_front
from app.chart.gathering import (
    HIGH,
    MEAN,
    RELATIVE,
    SQUARES,
    compared,
    reference,
    sampled,
    uncertainty,
)
from app.chart.machine import machine
from app.chart.measure import PERCENT, Measure
from app.chart.points import Chart, Point, Spread
from app.chart.race import Finished, race
from app.chart.shaders import Shading, Trial, contestants, scene_of, warm_up
from app.lighting import world_lights
from app.pipeline import Pipeline
from app.session import Session
from lutcore.arrays import FloatArray
from lutcore.color import auto_exposure
from lutcore.parameters import Parameters, choice, param
from lutcore.prediction import Scene as Surface
from lutcore.progress import Progress, part
from lutcore.tolerance import DEFAULTS

_MEASURES = {
    SQUARES: Measure("L2 error", 100.0, "%"),
    RELATIVE: Measure("error (99 %)", 100.0, "% R_d"),
    MEAN: Measure("mean CIEDE2000"),
    HIGH: Measure("CIEDE2000 (99 %)"),
}
_MEANING = {
    SQUARES: "Error is the root of the sum of squares of what is missed over that of the "
    "reference, each channel in units of its R_d, over the whole surface.",
    RELATIVE: "Error is what 99 % of the surface stay below, in R_d and the largest irradiance.",
    MEAN: "Error is the mean CIEDE2000 over the surface, the brightest parts near white.",
    HIGH: "Error is the CIEDE2000 that 99 % of the surface stay below, the brightest parts near "
    "white.",
}
TOLERANCES = {SQUARES: DEFAULTS[RELATIVE], **DEFAULTS}
"""Errors that are good enough where nothing is said."""
_TIME = (
    "Time is that of a warm call with its tables made, curvature and cast shadows known; all "
    "channels and lights together."
)


@dataclass(frozen=True)
class Trying(Parameters):
    """How shading models are charted; each parameter says what it is."""

    repeats: int = param(3, 1, 100, "", "Measurements of each, every one at other vertices.")
    sample: int = param(
        300, 10, 1_000_000, "", "Vertices of a measurement where the reference is gathered."
    )
    limit: float = param(10.0, 0.01, 1e5, "s", "Who takes longer for a call is stopped.")
    seed: int = param(0, 0, 2**31 - 1, "", "Seed of the choice of vertices.")
    metric: str = choice(
        SQUARES, tuple(_MEASURES), "Error that is drawn, and that the tolerance is of."
    )


def shading_chart(
    session: Session,
    pipeline: Pipeline,
    axes: FloatArray,
    names: Sequence[str],
    trying: Trying,
    tolerance: float | None,
    progress: Progress,
) -> Chart:
    """Measure shading models against light gathered from all of the mesh.

    Parameters
    ----------
    session : Session
        Its mesh, material, profile, lights, shadows and curvature are used.
    pipeline : Pipeline
        Where arrays come from.
    axes : ndarray, shape=(3, 3)
        The camera's axes, for lights that move with it.
    names : sequence of str
        Models.
    trying : Trying
        How.
    tolerance : float or None
        Error that is accepted, in the metric that `trying` names; None takes its `TOLERANCES`.
    progress : callable
        Told where the work stands; see `lutcore.progress`.

    Returns
    -------
    Chart
        What was found.

    Raises
    ------
    MeshError
        If there is no surface.
    ParameterError
        If no light reaches it.
    CancelledError
        If `progress` asked to stop.
    """
    scene = scene_of(session, pipeline, axes)
    mesh = pipeline.subject(session).mesh
    count = len(mesh.vertices)
    small = warm_up(session, pipeline, world_lights(session, axes))
    taking, missing, first = contestants(names, small, part(progress, 0.0, 0.1))
    trials = []
    for turn in range(trying.repeats):
        at = sampled(mesh, scene.gathering.normals, trying.sample, trying.seed + turn)
        share = 0.3 / trying.repeats
        gathering = part(progress, 0.1 + share * turn, 0.1 + share * (turn + 1))
        trials.append(Trial(scene, at, reference(scene, at, gathering)))
    own = uncertainty(scene, trials[0].vertices, trials[0].truth)
    every = np.concatenate([trial.truth for trial in trials])
    exposure = session.exposure or auto_exposure(every)

    irradiance = Surface.of(scene.gathering, pipeline.curvatures(session)).irradiance

    def judge(_: Shading, trial: Trial, found: FloatArray) -> dict[str, float]:
        return compared(scene, found[trial.vertices], trial.truth, irradiance, exposure)

    finished, late = race(taking, trials, small, judge, trying.limit, part(progress, 0.4, 1.0))
    measure = _MEASURES[trying.metric]
    bound = TOLERANCES[trying.metric] if tolerance is None else tolerance
    points = tuple(_point(one, count, trying.metric, first) for one in finished)
    front = pareto_front(points)
    return Chart(
        subject=_subject(session, pipeline, count),
        meaning=_meaning(session, trying, own),
        points=points,
        front=front,
        missing=tuple(missing + late),
        advice=advise(front, bound, measure),
        tolerance=bound,
        machine=machine(),
        facts=_facts(session, pipeline, count, exposure)
        | {"reference_error": own, "first_call_seconds": first, **asdict(trying)},
        measure=measure,
        columns={key: shown for key, shown in _MEASURES.items() if key != trying.metric},
        frame=count,
    )


def _point(
    one: Finished[Trial, FloatArray, dict[str, float]],
    count: int,
    metric: str,
    first: dict[str, float],
) -> Point:
    errors = {name: Spread.of([verdict[name] for verdict in one.verdicts]) for name in _MEASURES}
    return Point(
        name=one.contestant.name,
        setting=one.contestant.setting,
        time=Spread.of([seconds / count for seconds in one.seconds]),
        error=errors[metric],
        series=one.contestant.series,
        order=one.contestant.order,
        details={name: spread.middle for name, spread in errors.items()}
        | {"first_call_seconds": first[one.contestant.name]},
    )


def _subject(session: Session, pipeline: Pipeline, count: int) -> str:
    lights = "1 light" if len(session.lights) == 1 else f"{len(session.lights)} lights"
    return (
        f"{session.mesh}, {count:,} vertices, {pipeline.mm_per_unit(session):g} mm per unit, "
        f"{pipeline.material(session).name}, {lights}"
    )


def _meaning(session: Session, trying: Trying, own: float) -> tuple[str, ...]:
    shadows = {
        "off": "no cast shadows on either side",
        "on": "cast shadows on both sides",
        "auto": "cast shadows, if they change much, on both sides",
    }[session.casts]
    return (
        f"{_MEANING[trying.metric]} Reference: the profile {session.profile.name} gathered from "
        f"every triangle at {trying.sample} vertices, {shadows}; itself within "
        f"{PERCENT.said(own)}. Models that aim at more than the profile are judged by it too.",
        _TIME,
        f"Measurements: {trying.repeats}, each at other vertices; points at the median error and "
        "the least time, bars from least to greatest.",
    )


def _facts(session: Session, pipeline: Pipeline, count: int, exposure: float) -> dict[str, object]:
    return {
        "mesh": session.mesh,
        "vertices": count,
        "mm_per_unit": pipeline.mm_per_unit(session),
        "material": pipeline.material(session).name,
        "profile": session.profile.name,
        "lights": len(session.lights),
        "shadows": session.casts,
        "exposure": exposure,
    }
