"""Measure principal curvatures and write a picture, or the values at the vertices.

.png is a picture; .vtp, .ply, .csv and .npz hold k1, k2, d1, d2, mean_curvature,
gauss_curvature, shape_index, curvedness and curvature_error, in 1/mesh unit: convex is positive,
k1 >= k2, the error is one sigma.
"""

import argparse

import numpy as np

from app.cli import options
from app.cli.console import answer, table
from app.cli.work import PERCENTILES, Run, percentiles
from lutcore.curvature import PrincipalCurvatures

_REPORTED = ("k1", "k2", "mean", "gauss", "curvedness", "shape_index", "error")


def add_arguments(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Declare the command's flags.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments.
    """
    options.add_mesh(parser)
    options.add_curvature(parser, words)
    options.add_colors(parser)
    options.add_picture(parser)


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
    from app import export

    work = Run(arguments, options.session_from(arguments, view="curvature"))
    work.require(".png", *export.DATA_SUFFIXES)
    warnings = work.warn()
    curvatures = work.pipeline.curvatures(work.session)
    if work.output.suffix.lower() == ".png":
        work.draw()
    else:
        mesh = work.pipeline.subject(work.session).mesh
        export.save(work.output, mesh, export.curvature_arrays(curvatures))
    statistics = {name: percentiles(getattr(curvatures, name)) for name in _REPORTED}
    result = work.summary(warnings) | {
        "method": work.session.estimator.name,
        "scale": float(np.median(curvatures.scale)),
        "unit": "1/mesh unit",
        "not_estimated": int(np.count_nonzero(~curvatures.estimated)),
        "share_below_error": _below_error(curvatures),
        "percentiles": statistics,
    }
    answer(arguments, result, _report(result, statistics))
    return 0


def _below_error(curvatures: PrincipalCurvatures) -> float:
    """Share of vertices where even the larger |k| does not stand out from its error."""
    largest = np.maximum(np.abs(curvatures.k1), np.abs(curvatures.k2))
    return float(np.mean(largest < curvatures.error))


def _report(result: dict[str, object], statistics: dict[str, dict[str, float | None]]) -> str:
    heading = ["", *(f"{share} %" for share in PERCENTILES)]
    rows = [
        [name, *("-" if value is None else f"{value:.4g}" for value in found.values())]
        for name, found in statistics.items()
    ]
    return "\n".join(
        [
            table([heading, *rows]),
            f"in 1/mesh unit, convex positive; {result['method']} at scale "
            f"{result['scale']:.4g} mesh units; {result['not_estimated']} vertices without an "
            "estimate",
            f"wrote {result['output']}",
        ]
    )
