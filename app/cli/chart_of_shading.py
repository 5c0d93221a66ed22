"""`curvelight chart`: flags and work for shading models."""

import argparse
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

from app.cli import charting
from app.cli.console import progress, table
from app.cli.options.mesh import add_mesh
from app.cli.options.methods import add_curvature
from app.cli.options.picture import add_picture
from app.cli.options.session import session_from
from app.cli.options.shading import add_shading
from app.cli.work import Run
from app.writing import write_bytes
from lutcore.progress import part

if TYPE_CHECKING:
    from app.chart.page import Section
    from app.chart.shading import Trying
    from lutcore.progress import Progress

_CHART, _RANGE, _STRIP = "chart", "range", "strip"
_PICTURES = {_RANGE: (".png", ".svg", ".csv", ".json"), _STRIP: (".png",)}


def add_arguments(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Declare the command's flags.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments.
    """
    from app.chart.shading import TOLERANCES, Trying

    add_mesh(parser, optional=True)
    parser.add_argument(
        "--show",
        choices=(_CHART, *_PICTURES),
        default=_CHART,
        help="speed against accuracy (chart), error over the radius of a ball, or pictures of the "
        "models with their CIEDE2000; .html holds all three",
    )
    who = parser.add_argument_group("who takes part")
    who.add_argument("--models", metavar="A,B", help="shading models (all); see curvelight models")
    usual = ", ".join(f"{value:g} of {metric}" for metric, value in TOLERANCES.items())
    charting.add_measuring(parser, Trying, usual)
    add_shading(parser, words, with_model=False)
    add_curvature(parser, words)
    add_picture(parser)


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
    from app.chart.naming import named
    from app.chart.shading import Trying
    from app.chart.writing import SUFFIXES
    from lutcore.shading import shading_models

    start = time.perf_counter()
    work = Run(arguments, session_from(arguments, view="compare"))
    work.require(*_PICTURES.get(arguments.show, SUFFIXES))
    names = named(arguments.models, "shading model", shading_models())
    trying = charting.measuring_from(arguments, Trying)
    tolerance = charting.tolerance_from(arguments)
    work.warn()
    if arguments.show == _RANGE:
        _range(work, names, trying, start)
    elif arguments.show == _STRIP:
        _strip(work, names, start)
    else:
        _chart(work, names, trying, tolerance, start)
    return 0


def _chart(
    work: Run, names: Sequence[str], trying: "Trying", tolerance: float | None, start: float
) -> None:
    from app.camera import axes, camera_of
    from app.chart.shading import shading_chart
    from app.chart.writing import content

    suffix = work.output.suffix.lower()
    told = progress(work.arguments)
    measuring = part(told, 0.0, 0.8 if suffix == ".html" else 1.0)
    seen = axes(camera_of(work.session.camera, work.pipeline.subject(work.session), 1.0))
    chart = shading_chart(work.session, work.pipeline, seen, names, trying, tolerance, measuring)
    sections = _sections(work, names, trying, part(told, 0.8, 1.0)) if suffix == ".html" else []
    made = content(chart, suffix, sections)
    work.finish(*charting.written(work.arguments, chart, made, start))


def _sections(
    work: Run, names: Sequence[str], trying: "Trying", told: "Progress"
) -> "list[Section]":
    from app.chart.ranges import measured
    from app.chart.sections import range_section, strip_section
    from app.chart.strip import strip

    ranges = measured(work.session, work.pipeline, names, trying.seed, part(told, 0.0, 0.5))
    image = strip(work.session, work.pipeline, names, part(told, 0.5, 1.0))
    return [strip_section(image), range_section(ranges)]


def _range(work: Run, names: Sequence[str], trying: "Trying", start: float) -> None:
    from app.chart import ranges
    from app.chart.sections import range_content

    told = progress(work.arguments)
    found = ranges.measured(work.session, work.pipeline, names, trying.seed, told)
    write_bytes(work.output, range_content(found, work.output.suffix.lower()))
    result = ranges.plain(found) | _summary(work, start)
    text = [found.subject, "", table(ranges.rows(found)), "", found.meaning]
    work.finish(result, "\n".join([*text, f"wrote {work.output}"]))


def _strip(work: Run, names: Sequence[str], start: float) -> None:
    from app.chart.strip import png, strip

    image = strip(work.session, work.pipeline, names, progress(work.arguments))
    write_bytes(work.output, png(image))
    work.finish(_summary(work, start), f"wrote {work.output}")


def _summary(work: Run, start: float) -> dict[str, object]:
    return {"output": str(work.output), "seconds": round(time.perf_counter() - start, 3)}
