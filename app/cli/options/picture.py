"""Flags of a picture's frame and colours."""

import argparse
from typing import get_args

from app.cli.options.typed import pair, size
from app.session import Quantity

_SEVERAL = ("disagreement", "all")


def add_picture(parser: argparse.ArgumentParser) -> None:
    """Add the flags of a picture's frame.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    """
    group = parser.add_argument_group("picture")
    group.add_argument("--size", type=size, metavar="WxH", help="pixels, such as 1600x1000")
    group.add_argument(
        "--camera",
        metavar="VIEW",
        help="auto, front, back, left, right, top, bottom, oblique, or 9 numbers with commas: "
        "position, target, up; a 10th is the angle of view in degrees",
    )
    group.add_argument("--background", metavar="COLOR", help="name, #rrggbb, or transparent")


def add_colors(parser: argparse.ArgumentParser, several: bool = False) -> None:
    """Add the flags of a colour map.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    several : bool
        Whether the command shows all quantities at once, and the disagreement of estimators.
    """
    group = parser.add_argument_group("colours")
    group.add_argument(
        "--quantity",
        choices=[name for name in get_args(Quantity) if several or name not in _SEVERAL],
        help="what is shown",
    )
    group.add_argument(
        "--colormap",
        metavar="NAME",
        help="green-red as in the paper (cividis is its twin "
        "for the colour-blind), or any of matplotlib's",
    )
    group.add_argument(
        "--range",
        type=pair,
        metavar="LOW,HIGH",
        help="ends of the colour bar; else percentiles of what the error bars trust",
    )
    group.add_argument(
        "--symmetric",
        action="store_const",
        const=True,
        help="without --range: as wide below 0 as above",
    )
    group.add_argument("--flip", action="store_const", const=True, help="turn the map round")
    group.add_argument(
        "--percentiles",
        type=pair,
        metavar="LOW,HIGH",
        help="percentiles at the ends of a colour bar that has no --range (5,95)",
    )
    group.add_argument("--flat", action="store_const", const=True, help="colours without light")
    group.add_argument(
        "--fade",
        action="store_const",
        const=True,
        help="grey where the curvature is below its error",
    )
    group.add_argument(
        "--strokes",
        action="store_const",
        const=True,
        help="draw the principal directions: k1's in black, k2's in white",
    )
