"""Measure principal curvatures and write a picture, a report, or the values at the vertices.

.png is a picture; --quantity all draws every quantity in a panel of its own. .html is a report on
one page to send to somebody: pictures, histograms, percentiles, error bars. .vtp, .ply, .csv and
.npz hold k1, k2, d1, d2, mean_curvature, gauss_curvature, shape_index, curvedness,
curvature_error (of k1 and k2 together), k1_error, k2_error, curvature_scale and, with --disagree,
curvature_disagreement, in mesh units: convex is positive, k1 >= k2, errors are one sigma.
"""

import argparse
import shlex

import numpy as np

from app.cli.console import note, table
from app.cli.options.mesh import add_mesh
from app.cli.options.methods import add_curvature, add_peers
from app.cli.options.picture import add_colors, add_picture
from app.cli.options.session import session_from
from app.cli.performing import add_performing, perform
from app.cli.work import Run
from app.findings import Findings, findings
from app.quantities import QUANTITIES
from app.session import Session
from lutcore.diagnostics import vertex_scales
from lutcore.errors import ParameterError
from lutcore.statistics import PERCENTILES, Histogram

# Two rows of four panels; three of three with the disagreement; the report's two rows.
_GRID_SIZE, _NINE_SIZE, _REPORT_SIZE = (2200, 1100), (1800, 1650), (1800, 900)
_BARS = 12
_BAR_LETTERS = 40


def add_arguments(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Declare the command's flags.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments.
    """
    output = add_mesh(parser)
    add_curvature(parser, words)
    add_peers(parser)
    add_colors(parser, several=True)
    add_picture(parser)
    add_performing(parser, output, lights=False)
    parser.set_defaults(command=shlex.join(["curvelight", "curvature", *words]))


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
    return perform(arguments, session_of, _measure)


def session_of(arguments: argparse.Namespace) -> Session:
    """Return the session that the arguments describe.

    Parameters
    ----------
    arguments : Namespace
        Of the command.

    Returns
    -------
    Session
        Of this command's view.

    Raises
    ------
    SessionError, ParameterError
        If a file or a value is not right.
    """
    return session_from(arguments, view="curvature", **_fixed(arguments))


def _measure(work: Run) -> int:
    from app import export

    arguments = work.arguments
    work.require(".png", ".html", *export.DATA_SUFFIXES)
    warnings = work.warn()
    curvatures = work.pipeline.curvatures(work.session)
    if work.session.scale is not None and not np.any(vertex_scales(curvatures)):
        note(arguments, f"{work.session.estimator.name} works on the one-ring: no scale is used")
    found = findings(work.session, work.pipeline)
    for name, reason in found.refused.items():
        warnings.append(f"left out of the disagreement: {name}: {reason}")
        note(arguments, warnings[-1])
    match work.output.suffix.lower():
        case ".png":
            work.draw()
        case ".html":
            from app.report import write

            write(work.output, work.session, work.pipeline, found, arguments.command)
        case _:
            mesh = work.pipeline.subject(work.session).mesh
            export.save(work.output, mesh, export.curvature_arrays(curvatures, found.spread))
    result = work.summary(warnings) | found.as_json()
    return work.finish(
        result, _text(found, str(work.output), work.pipeline.mm_per_unit(work.session))
    )


def _fixed(arguments: argparse.Namespace) -> dict[str, object]:
    """Return what follows from the output and the flags, where they do not say it."""
    fixed: dict[str, object] = {}
    if arguments.output is not None and arguments.output.suffix.lower() == ".html":
        if arguments.quantity not in (None, "all"):
            raise ParameterError("a report shows all quantities; leave --quantity out")
        fixed["quantity"] = "all"
        if arguments.size is None:
            fixed["size"] = _REPORT_SIZE
    elif arguments.quantity is None and arguments.peers:
        fixed["quantity"] = "disagreement"
    elif arguments.quantity == "all" and arguments.size is None:
        fixed["size"] = _NINE_SIZE if arguments.peers else _GRID_SIZE
    return fixed


def _text(found: Findings, output: str, mm_per_unit: float) -> str:
    judged = found.judged
    lines = []
    for group, statistics in found.statistics.items():
        count = int(np.count_nonzero(getattr(judged, group)))
        heading = [f"{group} ({count:,})", *(f"{share} %" for share in PERCENTILES)]
        rows = [
            [name, *("-" if value is None else f"{value:.4g}" for value in shares.values())]
            for name, shares in statistics.items()
        ]
        lines += [table([heading, *rows]), ""]
    if len(found.histograms) == 1:
        ((name, counted),) = found.histograms.items()
        lines += [*_bars(name, counted), ""]
    scale = f"at scale {found.scale:.4g} mesh units (median)" if found.scale else "on the one-ring"
    # The histogram is in mm, as the picture is.
    size = "" if mm_per_unit == 1.0 else f" (1 mesh unit is {mm_per_unit:g} mm)"
    lines += [
        f"in 1/mesh unit{size}, convex positive; {found.method} {scale}; "
        f"{found.not_estimated} vertices without an estimate",
        f"|k| is below its error at {judged.below_error:.1%} of the vertices; Gauss-Bonnet "
        f"residual {judged.gauss_bonnet_residual:.2%}",
    ]
    if found.beyond_error is not None:
        apart = ", ".join(f"{name} {value:.3g}" for name, value in found.distances.items())
        lines += [
            f"the estimators are apart by more than twice the error bar of {found.method} at "
            f"{found.beyond_error:.1%} of the vertices; median distance from their median, "
            f"1/mesh unit: {apart}",
        ]
    return "\n".join([*lines, f"wrote {output}"])


def _bars(name: str, counted: Histogram) -> list[str]:
    """Return a histogram in lines of text that every terminal can show."""
    counts = counted.counts.reshape(_BARS, -1).sum(axis=1)
    edges = counted.edges[:: len(counted.counts) // _BARS]
    whole = max(1, int(counts.sum()) + counted.below + counted.above)
    rows = [
        [f"{low:.3g}", f"{high:.3g}", f"{count / whole:.1%}", "#" * round(length)]
        for low, high, count, length in zip(
            edges[:-1], edges[1:], counts, _BAR_LETTERS * counts / max(1, counts.max()), strict=True
        )
    ]
    quantity = QUANTITIES[name]
    beyond = f"{counted.below / whole:.1%} below, {counted.above / whole:.1%} above"
    heading = f"{quantity.name}, {quantity.unit}" if quantity.power else quantity.name
    return [table([["from", "to", "share", f"of {heading} ({beyond})"], *rows])]
