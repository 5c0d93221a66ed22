"""Chart speed against accuracy, and recommend one way to take.

Without --curvature: the shading models, with several values of their parameters, on a mesh with its
material and lights. The error is the distance from light gathered from all of the mesh. Without
MESH, the scanned marble face.

--curvature charts the curvature estimators: each at the length it chooses itself and at several
others. Without MESH on a surface whose curvature is known exactly, with noise; the error is the
distance from the truth. With MESH nobody knows the truth: the error is how much an estimate
changes when every vertex moves a little, and how far it is from what the other estimators see at
the finest setting that this hardly changes; for little change alone is had by smoothing all away.

The recommended one is the fastest that meets --tolerance; of curvature, without it, the fastest
whose error is at most twice the least. .png and .svg are pictures, .csv and .json hold the
figures, .html holds all.
"""

import argparse
from types import ModuleType

_FLAG = "--curvature"


def add_arguments(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Declare the command's flags.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments.
    """
    _kind(_FLAG in words).add_arguments(parser, words)
    parser.add_argument(_FLAG, action="store_true", help="chart curvature estimators")


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
    code: int = _kind(arguments.curvature).run(arguments)
    return code


def _kind(curvature: bool) -> ModuleType:
    # Each has its own flags: --help shows those of the one that is asked for.
    if curvature:
        from app.cli import chart_of_curvature

        return chart_of_curvature
    from app.cli import chart_of_shading

    return chart_of_shading
