"""The paper's Figure 1: left, the mesh as a translucent material; right, its curvature.

Without MESH, the scanned marble face. The right side shows sqrt((k1^2 + k2^2)/2) from green
(small) to red (big), in 1/mm.
"""

import argparse

from app.cli.options.mesh import add_mesh
from app.cli.options.methods import add_curvature
from app.cli.options.picture import add_colors, add_picture
from app.cli.options.session import session_from
from app.cli.options.shading import add_shading
from app.cli.performing import add_performing, perform
from app.cli.work import Run
from app.quantities import QUANTITIES
from app.session import Session

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
    output = add_mesh(parser, optional=True)
    add_curvature(parser, words)
    add_shading(parser, words)
    add_colors(parser)
    add_picture(parser)
    add_performing(parser, output)


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
    return perform(arguments, session_of, _draw)


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
    fixed = {} if arguments.size or arguments.session else {"size": _SIZE}
    return session_from(arguments, view="figure", **fixed)


def _draw(work: Run) -> int:
    work.require(".png")
    warnings = work.warn()
    made = work.draw()
    result = work.summary(warnings) | {
        "quantity": work.session.quantity,
        "exposure": made.exposure,
        "range": made.range,
        "range_unit": QUANTITIES[work.session.quantity].unit,
    }
    return work.finish(result, f"wrote {work.output}")
