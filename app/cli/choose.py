"""Say which shading model is enough for a scene, what it costs, and why.

Predicts the error of each model from the mesh's curvature, the material and the lights, checks
local models against light gathered at some thousand vertices, measures once what each costs on this
machine, and takes the cheapest that is within the tolerance. The truth is the diffusion profile
gathered over the surface itself, with the shadows that the scene casts. --model auto of the other
commands does the same.
"""

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.choose_said import text
from app.cli.console import answer, note, progress
from app.cli.options.mesh import add_repairs, add_volume
from app.cli.options.methods import add_curvature
from app.cli.options.session import session_from
from app.cli.options.shading import add_shading
from app.cli.remarks import remarks
from lutcore.parameters import Number

if TYPE_CHECKING:
    from app.choosing import Needs
    from app.pipeline import Pipeline
    from app.session import Session
    from lutcore.judging import Rung

_TOLERANCE = Number(1e-4, 100.0, "", "Error that is good enough, in the metric's unit.", False)


def add_arguments(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Declare the command's flags.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments.
    """
    from lutcore.tolerance import DEFAULTS, METRICS

    parser.add_argument("mesh", nargs="?", metavar="MESH", help="mesh file, volume, or sample:NAME")
    add_volume(parser)
    add_repairs(parser)
    parser.add_argument("--session", type=Path, metavar="FILE", help="start from a session file")
    parser.set_defaults(own_mesh=False)
    group = parser.add_argument_group("how good")
    values = ", ".join(f"{value:g} for {metric}" for metric, value in DEFAULTS.items())
    group.add_argument("--tolerance", metavar="T", help=f"{_TOLERANCE.doc} ({values})")
    group.add_argument(
        "--metric",
        choices=METRICS,
        default=METRICS[0],
        help="relative: 99 %% of vertices, in R_d and the largest irradiance; CIEDE2000 over the "
        "vertices: mean or 99th percentile (relative)",
    )
    group.add_argument(
        "--predicted-only",
        action="store_true",
        help="do without the check at a sample of the vertices",
    )
    group.add_argument("--again", action="store_true", help="measure the models' costs again")
    add_shading(parser, words, with_model=False)
    add_curvature(parser, words)
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(arguments: argparse.Namespace) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : Namespace
        Of the command.

    Returns
    -------
    int
        Exit code.
    """
    from app.camera import axes, camera_of
    from app.choosing import needs
    from app.pipeline import Pipeline
    from app.session import CHOSEN, Method
    from lutcore.tolerance import DEFAULTS, Tolerance

    start = time.perf_counter()
    given = arguments.tolerance
    value = DEFAULTS[arguments.metric] if given is None else _TOLERANCE.check("tolerance", given)
    session = session_from(arguments, view="shade", model=Method(CHOSEN))
    pipeline = Pipeline(progress(arguments))
    warnings = remarks(session, pipeline)
    for warning in warnings:
        note(arguments, f"{session.mesh}: {warning}")
    tolerance = Tolerance(float(value), arguments.metric)
    camera = camera_of(session.camera, pipeline.subject(session), 1.0)
    checked = not arguments.predicted_only
    found = needs(session, pipeline, axes(camera), tolerance, arguments.again, checked)
    result = _plain(session, pipeline, found) | {
        "warnings": warnings,
        "seconds": round(time.perf_counter() - start, 3),
    }
    answer(arguments, result, text(session, pipeline, found))
    return 0


def _plain(session: "Session", pipeline: "Pipeline", found: "Needs") -> dict[str, object]:
    from app.costs import machine
    from lutcore.checking import CONFIDENCE

    subject, choice = pipeline.subject(session), found.choice
    chosen = choice.chosen.candidate
    return {
        "mesh": session.mesh,
        "sha256": subject.loaded.digest,
        "vertices": len(subject.mesh.vertices),
        "material": pipeline.material(session).name,
        "mm_per_unit": pipeline.mm_per_unit(session),
        "lights": len(session.lights),
        "tolerance": choice.tolerance.value,
        "metric": choice.tolerance.metric,
        "ladder": [_rung(rung) for rung in choice.rungs],
        "choice": {
            "model": chosen.name,
            "parameters": chosen.parameters,
            "blended_with": choice.cheaper.candidate.label if choice.cheaper else None,
            "milliseconds": choice.milliseconds,
            "adequate": choice.chosen.adequate,
            "local": chosen.model.local,
            "by_prediction": choice.by_prediction.candidate.label,
            "overruled": choice.overruled,
            "reason": choice.sentence,
            "local_suffices_at_times_the_size": choice.enough,
        },
        "check": {
            "share_of_vertices": choice.coverage.share,
            "confidence": CONFIDENCE,
            "milliseconds": choice.check_milliseconds,
            "none_because": choice.coverage.reason or None,
            "shadows": choice.shadowed,
        },
        "table_samples": choice.samples,
        "shadows": None
        if found.shadows is None
        else {
            "needed": found.shadows.needed,
            "share": found.shadows.share,
            "change": found.shadows.change,
            "without": choice.unshadowed and choice.unshadowed._asdict(),
        },
        "scale": found.scale,
        "glow": found.glow,
        "radius_of_curvature": found.tight,
        "machine": machine(),
    }


def _rung(rung: "Rung") -> dict[str, object]:
    return {
        "model": rung.candidate.name,
        "parameters": rung.candidate.parameters,
        "predicted_error_median": rung.median,
        "predicted_error_p99": rung.p99,
        "score": rung.score,
        "share": rung.share,
        "ns_per_vertex_and_light": rung.nanoseconds,
        "milliseconds": rung.milliseconds,
        "checked": None if rung.checked is None else rung.checked._asdict(),
        "predicted_adequate": rung.predicted,
        "aims_elsewhere": rung.candidate.model.aim or None,
        "adequate": rung.adequate,
    }
