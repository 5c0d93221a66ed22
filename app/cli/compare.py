"""Shading models side by side, with one camera, one exposure and the same lights.

--difference adds the CIEDE2000 difference of the others from the first on the surface.
"""

import argparse

from app.cli import options
from app.cli.work import Run
from app.session import Method
from lutcore.errors import ParameterError

_PANEL = 800


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
    parser.add_argument("--models", metavar="A,B[,...]", help="shading models, two or more")
    parser.add_argument(
        "--difference", action="store_const", const=True, help="add CIEDE2000 against the first"
    )
    options.add_shading(parser, words, with_model=False)
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
    fixed: dict[str, object] = {"view": "compare"}
    if arguments.models:
        names = [name.strip() for name in arguments.models.split(",")]
        fixed["compared"] = tuple(Method(name) for name in names)
    elif not arguments.session:
        raise ParameterError("say which models: --models lambert,curvature-lut")
    if arguments.size is None and arguments.models and not arguments.session:
        below = bool(arguments.difference) and len(names) > 2
        count = len(names) + (bool(arguments.difference) and not below)
        fixed["size"] = (_PANEL * count, _PANEL * (1 + below))
    session = options.session_from(arguments, difference=arguments.difference, **fixed)
    work = Run(arguments, session)
    work.require(".png")
    warnings = work.warn()
    made = work.draw()
    result = work.summary(warnings) | {
        "models": [model.name for model in session.compared],
        "exposure": made.exposure,
        "ciede2000": made.difference,
    }
    lines = [
        f"CIEDE2000 of {label}: " + ", ".join(f"{key} {value:.3g}" for key, value in found.items())
        for label, found in (made.difference or {}).items()
    ]
    work.finish(result, "\n".join([*lines, f"wrote {arguments.output}"]))
    return 0
