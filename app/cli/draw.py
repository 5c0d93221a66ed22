"""Draw a saved session, or a picture that Curvelight wrote, whatever it shows.

The picture is that of the window which saved the session, bit for bit on one machine. MESH and the
flags stand above what the session says.
"""

import argparse

from app.cli.options.mesh import add_mesh
from app.cli.options.picture import add_picture
from app.cli.options.session import session_from
from app.cli.performing import add_performing, perform
from app.cli.work import Run
from app.session import Session
from lutcore.errors import ParameterError


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
        Of the view that the file says.

    Raises
    ------
    SessionError, ParameterError
        If a file or a value is not right.
    """
    if arguments.session is None:
        raise ParameterError("say which session: --session FILE, as the window saves it")
    return session_from(arguments)


def _draw(work: Run) -> int:
    work.require(".png")
    warnings = work.warn()
    made = work.draw()
    result = work.summary(warnings) | {
        "view": work.session.view,
        "exposure": made.exposure,
        "ranges": made.ranges,
    }
    return work.finish(result, f"wrote {work.output}")
