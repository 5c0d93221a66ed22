"""The paper's Figure 1: left, the mesh as a translucent material; right, its curvature.

Without MESH, the scanned marble face. The right side shows sqrt((k1^2 + k2^2)/2) from green
(small) to red (big), in 1/mm.
"""

import argparse

from app.cli import options
from app.cli.work import Run
from app.quantities import QUANTITIES

_SIZE = (1700, 1000)


def add_arguments(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Declare the command's flags.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments.
    """
    options.add_mesh(parser, optional=True)
    options.add_curvature(parser, words)
    options.add_shading(parser, words)
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
    fixed = {} if arguments.size or arguments.session else {"size": _SIZE}
    work = Run(arguments, options.session_from(arguments, view="figure", **fixed))
    work.require(".png")
    warnings = work.warn()
    made = work.draw()
    result = work.summary(warnings) | {
        "quantity": work.session.quantity,
        "exposure": made.exposure,
        "range": made.range,
        "range_unit": QUANTITIES[work.session.quantity].unit,
    }
    work.finish(result, f"wrote {arguments.output}")
    return 0
