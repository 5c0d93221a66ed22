"""Run what is to be tested through everything that breaks it: who survives, and by how much.

--curvature: a gallery of broken meshes over every curvature estimator. Each case has one defect, an
exact truth, and a twin without the defect.

--shading: every local shading model on balls of many curvatures and substances, under light from
all heights; their failing regions are outlined and named. And noise in curvature, seams at clamps,
absorption that goes to 0, curvature that goes to 0 or leaves the tables.

.png is a picture, .html the same with all that is known of each cell, .csv one row for each cell,
.json everything.
"""

import argparse
from types import ModuleType

from lutcore.errors import ParameterError

_KINDS = ("--curvature", "--shading")


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
        "--curvature", action="store_true", help="test the curvature estimators (or --shading)"
    )
    parser.add_argument("--shading", action="store_true", help="test the shading models")
    _kind("--shading" in words).add_arguments(parser)


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
    if arguments.curvature == arguments.shading:
        raise ParameterError(f"say what is tested: {' or '.join(_KINDS)}")
    code: int = _kind(arguments.shading).run(arguments)
    return code


def _kind(shading: bool) -> ModuleType:
    # Each has its own flags: --help shows those of the one that is asked for.
    if shading:
        from app.cli import stability_of_shading

        return stability_of_shading
    from app.cli import stability_of_curvature

    return stability_of_curvature
