"""Chart speed against accuracy, and recommend one way to take.

--curvature charts the curvature estimators: each at the length it chooses itself and at several
others. Without MESH on a surface whose curvature is known exactly, with noise; the error is the
distance from the truth. With MESH nobody knows the truth: the error is how much an estimate
changes when every vertex moves a little, and how far it is from what the other estimators see at
the finest setting that this hardly changes; for little change alone is had by smoothing all away.

The recommended one is the fastest that meets --tolerance; without it, the fastest whose error is
at most twice the least. .png and .svg are pictures, .csv and .json hold the figures, .html holds
all.
"""

import argparse
import time
from dataclasses import fields
from pathlib import Path

from app.chart.points import Chart
from app.cli.console import answer, note, progress, table
from app.writing import check_writable, write_bytes
from lutcore.errors import ParameterError
from lutcore.parameters import Number, declared

_VERTICES = Number(100, 2e7, "", "Vertices of the surface, nearly.", True)
_TOLERANCE = Number(1e-9, 1e3, "", "Error that is good enough, as a share: 0.01 is 1 %.", False)
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
    parser.add_argument("--curvature", action="store_true", help="chart curvature estimators")
    known = parser.add_argument_group("known surface")
    known.add_argument("--surface", metavar="NAME", help=f"{', '.join(SURFACES)} ({_SURFACE})")
    known.add_argument("--vertices", metavar="N", help=f"{_VERTICES.doc} ({_COUNT})")
    known.add_argument("--irregular", action="store_true", help="random vertices instead of a grid")
    who = parser.add_argument_group("who takes part")
    who.add_argument("--methods", metavar="A,B", help="estimators (all); see curvelight models")
    scales = ",".join(f"{value:g}" for value in SPACINGS)
    who.add_argument("--scales", metavar="A,B", help=f"{_SPACINGS.doc} ({scales})")
    how = parser.add_argument_group("measuring")
    for field in fields(Measuring):
        doc = declared(Measuring)[field.name].doc
        how.add_argument(f"--{field.name}", metavar="N", help=f"{doc} ({field.default})")
    how.add_argument("--tolerance", metavar="T", help=_TOLERANCE.doc.replace("%", "%%"))
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
    from app.chart import data
    from app.chart.writing import SUFFIXES, content

    start = time.perf_counter()
    output: Path = arguments.output
    if not arguments.curvature:
        raise ParameterError("say what to chart: --curvature is the only choice so far")
    if output.suffix.lower() not in SUFFIXES:
        raise ParameterError.unknown("output format", output.suffix or output.name, SUFFIXES)
    mesh = Path(arguments.mesh or "")
    if mesh.is_file() and output.exists() and output.samefile(mesh):
        raise ParameterError(f"{output} is the mesh itself; choose another name")
    check_writable(output)

    chart = _measured(arguments)
    write_bytes(output, content(chart, output.suffix.lower()))
    absent = [f"{who}: {reason}" for who, reason in data.gathered(chart.missing)]
    for line in absent:
        note(arguments, f"without figures: {line}")
    seconds = round(time.perf_counter() - start, 3)
    result = data.plain(chart) | {"output": str(output), "seconds": seconds}
    text = [chart.subject, "", table(data.rows(chart)), "", *chart.meaning, ""]
    answer(arguments, result, "\n".join([*text, chart.advice.sentence, f"wrote {output}"]))
    return 0


def _measured(arguments: argparse.Namespace) -> Chart:
    from app.chart.contestants import SPACINGS, chosen
    from app.chart.known import surface_chart
    from app.chart.measuring import Measuring
    from app.chart.unknown import mesh_chart

    given = {field.name: getattr(arguments, field.name) for field in fields(Measuring)}
    measuring = Measuring(**{name: value for name, value in given.items() if value is not None})
    names = chosen(arguments.methods)
    spacings: tuple[float, ...] = SPACINGS
    if arguments.scales is not None:
        texts = dict.fromkeys(arguments.scales.split(","))
        spacings = tuple(float(_SPACINGS.check("scales", text)) for text in texts)
    tolerance = arguments.tolerance
    if tolerance is not None:
        tolerance = float(_TOLERANCE.check("tolerance", tolerance))
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
