"""Flags of a comparison."""

import argparse
from typing import get_args

from app.cli.options.typed import names
from app.session import ComparedBy


def add_comparison(parser: argparse.ArgumentParser) -> None:
    """Add the flags of what is compared, and how it is shown.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    """
    group = parser.add_argument_group("comparison")
    group.add_argument(
        "--models",
        type=names,
        metavar="A,B[,...]",
        dest="compared",
        help="what is compared, two or more: shading models, or what --by says",
    )
    group.add_argument(
        "--by",
        choices=get_args(ComparedBy),
        dest="compared_by",
        help="whether --models names shading models, estimators (by the quantity that --quantity "
        "says) or materials (model)",
    )
    group.add_argument(
        "--wipe",
        type=float,
        metavar="SHARE",
        help="show two on one surface, the first left of this share of its width, 0 to 1",
    )
    group.add_argument(
        "--difference",
        action="store_const",
        const=True,
        help="add how far the others are from the first: CIEDE2000, or of estimators the quantity",
    )
