"""Shading models, estimators or materials side by side, with one camera and the same lights.

--difference adds on the surface how far the others are from the first, --wipe shows two on one
surface. What is shaded has one exposure.
"""

import argparse
from typing import get_args

from msgspec.structs import replace

from app.cli import options
from app.cli.performing import add_performing, perform
from app.cli.work import Run
from app.contestants import check, has_bar, size
from app.differences import sentence
from app.quantities import QUANTITIES
from app.session import ComparedBy, Method, Session
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
    output = options.add_mesh(parser)
    parser.add_argument(
        "--models",
        metavar="A,B[,...]",
        help="what is compared, two or more: shading models, or what --by says",
    )
    parser.add_argument(
        "--by",
        choices=get_args(ComparedBy),
        dest="compared_by",
        help="whether --models names shading models, estimators (by the quantity that --quantity "
        "says) or materials (model)",
    )
    parser.add_argument(
        "--wipe",
        type=float,
        metavar="SHARE",
        help="show two on one surface, the first left of this share of its width, 0 to 1",
    )
    parser.add_argument(
        "--difference",
        action="store_const",
        const=True,
        help="add how far the others are from the first: CIEDE2000, or of estimators the quantity",
    )
    options.add_shading(parser, words, with_model=False)
    options.add_curvature(parser, words)
    options.add_colors(parser)
    options.add_picture(parser)
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
    fixed: dict[str, object] = {"view": "compare"}
    if arguments.models:
        names = [name.strip() for name in arguments.models.split(",")]
        fixed["compared"] = tuple(Method(name) for name in names)
    elif not arguments.session:
        raise ParameterError("say which models: --models lambert,curvature-lut")
    for name in ("compared_by", "wipe", "difference"):
        fixed[name] = getattr(arguments, name)
    made = options.session_from(arguments, **fixed)
    check(made)
    if arguments.size is None and arguments.models and not arguments.session:
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
