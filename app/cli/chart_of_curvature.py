"""`curvelight chart --curvature`: flags and work."""

import argparse
import time
from pathlib import Path

from app.chart.points import Chart
from app.cli import charting
from app.cli.console import answer, note, progress
from lutcore.errors import ParameterError
from lutcore.parameters import Number

_VERTICES = Number(100, 2e7, "", "Vertices of the surface, nearly.", True)
_SPACINGS = Number(0.1, 1000.0, "spacings", "Lengths to average over, in spacings.", False)
_SURFACE, _COUNT = "torus", 10_000


def add_arguments(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Declare the command's flags.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments.
    """
    from app.chart.contestants import SPACINGS
    from app.chart.known import SURFACES
    from app.chart.measuring import Measuring

    parser.add_argument(
        "mesh", nargs="?", metavar="MESH", help="mesh file, or sample:NAME; else a known surface"
    )
    parser.add_argument("-o", "--output", required=True, type=Path, metavar="OUT", help="result")
    known = parser.add_argument_group("known surface")
    known.add_argument("--surface", metavar="NAME", help=f"{', '.join(SURFACES)} ({_SURFACE})")
    known.add_argument("--vertices", metavar="N", help=f"{_VERTICES.doc} ({_COUNT})")
    known.add_argument("--irregular", action="store_true", help="random vertices instead of a grid")
    who = parser.add_argument_group("who takes part")
    who.add_argument("--methods", metavar="A,B", help="estimators (all); see curvelight models")
    scales = ",".join(f"{value:g}" for value in SPACINGS)
    who.add_argument("--scales", metavar="A,B", help=f"{_SPACINGS.doc} ({scales})")
    charting.add_measuring(parser, Measuring)
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
    from app.chart.writing import content

    start = time.perf_counter()
    charting.require(arguments.output, arguments.mesh)
    chart = _measured(arguments)
    made = content(chart, arguments.output.suffix.lower())
    answer(arguments, *charting.written(arguments, chart, made, start))
    return 0


def _measured(arguments: argparse.Namespace) -> Chart:
    from app.chart.contestants import SPACINGS
    from app.chart.known import surface_chart
    from app.chart.measuring import Measuring
    from app.chart.naming import named
    from app.chart.unknown import mesh_chart
    from lutcore.estimation import estimators

    measuring = charting.measuring_from(arguments, Measuring)
    names = named(arguments.methods, "curvature estimator", estimators())
    spacings: tuple[float, ...] = SPACINGS
    if arguments.scales is not None:
        texts = dict.fromkeys(arguments.scales.split(","))
        spacings = tuple(float(_SPACINGS.check("scales", text)) for text in texts)
    tolerance = charting.tolerance_from(arguments)
    common = (names, spacings, measuring, tolerance, progress(arguments))
    if arguments.mesh is None:
        count = _COUNT if arguments.vertices is None else arguments.vertices
        vertices = int(_VERTICES.check("vertices", count))
        surface = arguments.surface or _SURFACE
        return surface_chart(surface, vertices, arguments.irregular, *common)
    for flag in ("surface", "vertices", "irregular"):
        if getattr(arguments, flag):
            raise ParameterError(f"--{flag} is for a known surface; leave it or MESH out")
    from app.pipeline import Pipeline
    from app.session import Session

    subject = Pipeline().subject(Session(mesh=arguments.mesh))
    for warning in (*subject.warnings, *subject.loaded.health.remarks()):
        note(arguments, f"{arguments.mesh}: {warning}")
    return mesh_chart(subject.mesh, arguments.mesh, *common)
