"""Measure principal curvatures and write a picture, or the values at the vertices.

.png is a picture; .vtp, .ply, .csv and .npz hold k1, k2, d1, d2, mean_curvature,
gauss_curvature, shape_index, curvedness and curvature_error, in 1/mesh unit: convex is positive,
k1 >= k2, the error is one sigma.
"""

import argparse

import numpy as np

from app.cli import options
from app.cli.console import note, table
from app.cli.work import PERCENTILES, Run, percentiles
from lutcore.diagnostics import Diagnosis, diagnose

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
    if work.session.scale is not None and not np.any(curvatures.scale):
        note(arguments, f"{work.session.estimator.name} works on the one-ring: no scale is used")
    judged = diagnose(work.pipeline.subject(work.session).mesh, curvatures)
    groups = {"interior": judged.interior, "border": judged.border, "debris": judged.debris}
    statistics = {
        group: {name: percentiles(getattr(curvatures, name)[mask]) for name in _REPORTED}
        for group, mask in groups.items()
        if mask.any()
    }
    result = work.summary(warnings) | {
        "method": work.session.estimator.name,
        "scale": float(np.median(curvatures.scale)),
        "unit": "1/mesh unit",
        "not_estimated": int(np.count_nonzero(~curvatures.estimated)),
        "share_below_error": judged.below_error,
        "gauss_bonnet": {
            "integral": judged.total_curvature,
            "angle_defects": judged.angle_defect,
            "residual": judged.gauss_bonnet_residual,
        },
        "counts": {group: int(np.count_nonzero(mask)) for group, mask in groups.items()},
        "percentiles": statistics,
    }
    work.finish(result, _report(result, judged, statistics))
    return 0


def _report(
    result: dict[str, object],
    judged: Diagnosis,
    statistics: dict[str, dict[str, dict[str, float | None]]],
) -> str:
    lines = []
    for group, found in statistics.items():
        count = int(np.count_nonzero(getattr(judged, group)))
        heading = [f"{group} ({count:,})", *(f"{share} %" for share in PERCENTILES)]
        rows = [
            [name, *("-" if value is None else f"{value:.4g}" for value in shares.values())]
            for name, shares in found.items()
        ]
        lines += [table([heading, *rows]), ""]
    return "\n".join(
        [
            *lines,
            f"in 1/mesh unit, convex positive; {result['method']} at scale "
            f"{result['scale']:.4g} mesh units; {result['not_estimated']} vertices without an "
            "estimate",
            f"|k| is below its error at {judged.below_error:.1%} of the vertices; Gauss-Bonnet "
            f"residual {judged.gauss_bonnet_residual:.2%}",
            f"wrote {result['output']}",
        ]
    )
