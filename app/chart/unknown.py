"""Speed against accuracy of the curvature estimators on a mesh whose curvature nobody knows."""

from collections.abc import Sequence

import numpy as np

from app.chart.contestants import Estimating, Subject, spacing_of
from app.chart.measuring import Measuring, Run, Verdict, values_of, verdict_of
from app.chart.perturbation import perturbation
from app.chart.points import Advice, Chart, Spread
from app.chart.reference import STEADY, Seen, biases, distance, votes
from lutcore.arrays import FloatArray
from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import MeshError, ParameterError
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress

_STEADY = f"{100.0 * STEADY:g} %"
# Where there is nothing to compare with: the error's meaning, and the advice.
_UNSTEADY = (
    f"No error: under this noise every estimate changes by more than {_STEADY}.",
    f"No recommendation: no estimate stays within {_STEADY} under this noise, so nothing can "
    "stand for the truth; lower --noise or add larger --scales.",
)
_FLAT = (
    "No error: the estimates that this noise hardly moves see no curvature.",
    "No recommendation: the estimates that this noise hardly moves see no curvature to compare; "
    "choose a mesh that is curved, or without MESH a known surface.",
)


def mesh_chart(
    mesh: TriangleMesh,
    label: str,
    names: Sequence[str],
    spacings: Sequence[float],
    measuring: Measuring,
    tolerance: float | None,
    progress: Progress,
) -> Chart:
    """Measure estimators on a mesh whose true curvature nobody knows.

    The error is sqrt(change^2 + bias^2) over the median curvedness. The change is the root mean
    square by which k1 and k2 move when noise moves every vertex; the bias their root mean square
    distance, on the mesh as it is, from what the other estimators see at the finest setting that
    this noise hardly moves; see `app.chart.reference`. The change alone would be won by whoever
    smooths most. The noise that the mesh has of itself counts as its shape.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    label : str
        What to call it.
    names, spacings, measuring, tolerance, progress
        As for `app.chart.known.surface_chart`.

    Returns
    -------
    Chart
        What was found.

    Raises
    ------
    MeshError
        If no face has an area.
    ParameterError
        If the noise is 0.
    CancelledError
        If `progress` asked to stop.
    """
    if measuring.noise == 0.0:
        raise ParameterError("noise = 0 moves no vertex; a mesh is judged by moving them")
    spacing = spacing_of(mesh)
    if spacing == 0.0:
        raise MeshError(f"{label}: no face has an area, so there is no surface; choose another")
    moved = perturbation(mesh, measuring.noise)
    seeds = range(measuring.seed, measuring.seed + measuring.repeats)
    base = Subject(mesh, spacing)
    run = Run(names, spacings, measuring, progress)
    still: dict[Estimating, FloatArray] = {}

    def judge(one: Estimating, subject: Subject, found: PrincipalCurvatures) -> Verdict:
        values = values_of(found)
        if subject is base:
            still[one] = values
        return verdict_of(distance(values, still[one]), subject, found)

    finished = run.race([base, *(Subject(moved(seed), spacing) for seed in seeds)], judge)
    changes = [[verdict.error for verdict in one.verdicts[1:]] for one in finished]
    seen = [
        Seen(
            one.contestant.name,
            one.verdicts[0].scale * spacing,
            still[one.contestant],
            Spread.of(change).middle,
        )
        for one, change in zip(finished, changes, strict=True)
    ]
    found = biases(seen)
    steady = votes(seen)
    facts = {"mesh": label, "vertices": len(mesh.vertices), "error": "change and bias"}
    subject = (
        f"{label}, {len(mesh.vertices):,} vertices, moved by {100 * measuring.noise:g} % of "
        "their edges"
    )
    if found is None:
        error, advice = _FLAT if steady else _UNSTEADY
        return run.chart(
            subject=subject,
            error=error,
            points=[],
            tolerance=tolerance,
            facts=facts,
            advice=Advice(None, advice),
        )
    distances, size = found
    points = [
        run.point(
            one,
            [float(np.hypot(value, bias)) / size for value in change],
            change=Spread.of(change).middle / size,
            bias=bias / size,
        )
        for one, change, bias in zip(finished, changes, distances, strict=True)
    ]
    return run.chart(
        subject=subject,
        error=(
            "Error is sqrt(change² + bias²) over the median curvedness: RMS change of k when "
            "noise moves the vertices, and RMS distance from the median of the other "
            f"estimators, each at its finest setting that changes by at most {_STEADY}. "
            "The mesh's own noise counts as shape."
        ),
        points=points,
        tolerance=tolerance,
        facts=facts | {"reference": {name: vote.scale / spacing for name, vote in steady.items()}},
    )
