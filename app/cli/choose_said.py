"""What `curvelight choose` says in words."""

from typing import TYPE_CHECKING

from app.cli.console import table

if TYPE_CHECKING:
    from app.choosing import Needs
    from app.pipeline import Pipeline
    from app.session import Session
    from lutcore.choice import Choice
    from lutcore.judging import Rung


def text(session: "Session", pipeline: "Pipeline", found: "Needs") -> str:
    """Return the answer as lines of text.

    Parameters
    ----------
    session : Session
        What was asked about.
    pipeline : Pipeline
        Where its arrays came from.
    found : Needs
        The answer.

    Returns
    -------
    str
        The ladder, the choice and its reason, and what else the scene needs.
    """
    choice = found.choice
    metric = choice.tolerance.metric
    size = pipeline.mm_per_unit(session)
    lines = [
        f"{pipeline.material(session).name}, {size:g} mm per unit, {_lights(session)}, "
        f"tolerance {choice.tolerance.value:g} ({metric}); errors in R_d and the largest "
        "irradiance, ns per vertex and light",
        "",
        table([_head(metric), *(_row(rung, metric) for rung in choice.rungs)]),
        "",
        f"choice: {choice.sentence}.",
        f"costs {spent(choice.milliseconds)} for this mesh and its lights",
        _check(choice),
        *_elsewhere(choice),
        f"table: {choice.samples} samples of psi are enough, and are taken",
    ]
    if found.shadows is not None:
        need = "needed" if found.shadows.needed else "not needed"
        change = f"{100.0 * found.shadows.change:.1f} % of the light (root mean square)"
        ask = ""
        if found.lacks_shadows:
            ask = "; the choice is made without them, --shadows auto makes it with them"
        lines.append(f"shadows: {need}; they change {change}{_unshadowed(choice)}{ask}")
    if found.scale is not None:
        finer = f"light carries an edge by {found.glow:.3g}"
        lines.append(f"scale of curvature: {found.scale:.3g} mesh units; {finer}")
    return "\n".join([*lines, *_physics(found)])


def _lights(session: "Session") -> str:
    count = len(session.lights)
    return "1 light" if count == 1 else f"{count} lights"


def spent(milliseconds: float) -> str:
    """Return a time in the unit that people read it in.

    Parameters
    ----------
    milliseconds : float
        The time.

    Returns
    -------
    str
        Three digits with their unit, or whole seconds.
    """
    seconds = milliseconds / 1e3
    if seconds < 0.9995:
        return f"{milliseconds:.3g} ms"
    return f"{seconds:.3g} s" if seconds < 999.5 else f"{seconds:,.0f} s"


def _head(metric: str) -> list[str]:
    score = [] if metric == "relative" else [metric]
    predicted = ["predicted: median", "99th perc.", *score]
    return ["model", *predicted, "found", "at most", "suffices on", "ns", "ms", ""]


def _row(rung: "Rung", metric: str) -> list[str]:
    known, checked = rung.median == rung.median, rung.checked
    cells = [rung.candidate.label]
    scores = [rung.median, rung.p99] + ([] if metric == "relative" else [rung.score])
    cells += [f"{score:.2g}" if known else "-" for score in scores]
    cells += [f"{checked.score:.2g}", f"{checked.high:.2g}"] if checked else ["-", "-"]
    cells.append(f"{100.0 * rung.best_share:.1f} %" if known else "-")
    cells += [f"{rung.nanoseconds:.0f}", f"{rung.milliseconds:.2f}"]
    cells.append("enough" if rung.adequate else ("" if known else "error not predicted"))
    return cells


def _check(choice: "Choice") -> str:
    from lutcore.checking import CONFIDENCE

    if choice.coverage.reason:
        return f"not checked: {choice.coverage.reason}; the prediction decides"
    vertices = [rung.checked.vertices for rung in choice.rungs if rung.checked]
    least, most = min(vertices, default=0), max(vertices, default=0)
    many = f"{most:,}" if least == most else f"{least:,} to {most:,}"
    near = ""
    if choice.coverage.share < 1.0:
        near = (
            f", drawn where borders take little of the light "
            f"({100.0 * choice.coverage.share:.0f} % of the vertices)"
        )
    cast = "with cast shadows on both sides" if choice.shadowed else "without cast shadows"
    return (
        f"checked at {many} vertices{near}, at {100.0 * CONFIDENCE:g} % confidence, {cast}; that "
        f"took {spent(choice.check_milliseconds)}, once and not for each picture"
    )


def _unshadowed(choice: "Choice") -> str:
    found = choice.unshadowed
    if found is None:
        return ""
    enough = "within the tolerance" if found.high <= choice.tolerance.value else "too much"
    return f"; without them what is chosen would be off by {found.score:.2g}, {enough}"


def _elsewhere(choice: "Choice") -> list[str]:
    return [
        f"{rung.candidate.label} is never chosen: it comes near to {rung.candidate.model.aim}, not "
        "to the gathered profile that errors are measured from"
        for rung in choice.rungs
        if rung.candidate.model.aim
    ]


def _physics(found: "Needs") -> list[str]:
    """Say where the truth itself, the profile over the surface, is no longer light transport."""
    ten = found.tight["below_10_l_d"]
    if ten < 0.01:
        return []
    return [
        f"against a random walk: {100.0 * ten:.0f} % of the vertices have a radius of curvature "
        f"below 10 diffusion lengths ({100.0 * found.tight['below_5_l_d']:.0f} % below 5), where "
        "the profile itself is off by 10 % and more, gathered or not; curvature-lut-physical is "
        "made for them"
    ]
