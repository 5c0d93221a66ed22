"""Shading models, estimators or materials side by side, with one camera and the same lights.

--difference adds on the surface how far the others are from the first, --wipe shows two on one
surface. What is shaded has one exposure.
"""

import argparse

from msgspec.structs import replace

from app.cli.options.comparison import add_comparison
from app.cli.options.mesh import add_mesh
from app.cli.options.methods import add_curvature
from app.cli.options.picture import add_colors, add_picture
from app.cli.options.session import session_from
from app.cli.options.shading import add_shading
from app.cli.performing import add_performing, perform
from app.cli.work import Run
from app.contestants import check, has_bar, size
from app.differences import sentence
from app.quantities import QUANTITIES
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
    add_comparison(parser)
    add_shading(parser, words, with_model=False)
    add_curvature(parser, words)
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
    return perform(arguments, session_of, _compare)


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
    if not arguments.compared and not arguments.session:
        raise ParameterError("say which models: --models lambert,curvature-lut")
    made = session_from(arguments, view="compare")
    check(made)
    if arguments.size is None and arguments.compared and not arguments.session:
        return replace(made, size=size(made))
    return made


def _compare(work: Run) -> int:
    work.require(".png")
    warnings = work.warn()
    made = work.draw()
    result = work.summary(warnings) | {
        "by": work.session.compared_by,
        f"{work.session.compared_by}s": [one.name for one in work.session.compared],
        "exposure": made.exposure,
    }
    measured = has_bar(work.session)
    unit = QUANTITIES[work.session.quantity].unit if measured else ""
    if measured:
        result |= {"quantity": work.session.quantity, "unit": unit, "difference": made.difference}
    else:
        result["ciede2000"] = made.difference
    what = f"difference in {work.session.quantity}" if measured else "CIEDE2000"
    lines = [
        f"{what} of {label}: {sentence(found, unit)}"
        for label, found in (made.difference or {}).items()
    ]
    return work.finish(result, "\n".join([*lines, f"wrote {work.output}"]))
