"""Open the window: curvature, shading and comparisons of a mesh that can be turned.

Without MESH the scanned marble face is shown. A session that was saved, by the window or with
--save-session, opens as it was.
"""

import argparse


def add_arguments(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Declare the command's flags.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments.
    """
    parser.add_argument(
        "what",
        nargs="?",
        metavar="MESH|SESSION",
        help="a mesh file, sample:NAME, or a session file (.json)",
    )


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
    from app.gui.main import run as run_window

    return run_window(arguments.what)
