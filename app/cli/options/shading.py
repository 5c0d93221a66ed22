"""Flags of material, light and shading model."""

import argparse
from typing import get_args

from app.cli.options.methods import add_profile
from app.cli.options.plugins import add_plugin
from app.cli.options.typed import camera_directional, cone, directional, point
from app.session import Shadows


def add_shading(parser: argparse.ArgumentParser, words: list[str], with_model: bool = True) -> None:
    """Add the flags of shading, the parameters of the model and the profile included.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments: they say which model and which profile.
    with_model : bool
        Whether the command takes one model.
    """
    group = parser.add_argument_group("shading")
    if with_model:
        from lutcore.shading import model_registry

        doc = "shading model; see curvelight models"
        add_plugin(parser, group, model_registry, words, "--model", "model", doc)
    group.add_argument("--material", metavar="NAME", help="see curvelight materials")
    add_profile(parser, words)
    group.add_argument(
        "--shadows",
        choices=get_args(Shadows),
        help="whether the surface casts shadows on itself; auto: where they change more than 1 %%, "
        "which the model auto does by itself",
    )
    lights = {
        "--light": (directional, "X,Y,Z[,E]", "directional light TO x,y,z"),
        "--camera-light": (camera_directional, "X,Y,Z[,E]", "the same in the camera's axes"),
        "--point-light": (point, "X,Y,Z[,I]", "point light at x,y,z"),
        "--cone-light": (cone, "X,Y,Z,DX,DY,DZ,ANGLE[,I]", "cone light, half angle in degrees"),
    }
    for flag, (kind, metavar, doc) in lights.items():
        group.add_argument(
            flag,
            type=kind,
            action="append",
            dest="lights",
            metavar=metavar,
            help=f"{doc}; strength as one number or R,G,B; may be repeated",
        )
    group.add_argument("--exposure", type=float, metavar="X", help="factor before encoding")
    group.add_argument(
        "--no-albedo",
        action="store_const",
        const=False,
        dest="albedo",
        help="ignore the file's vertex colours",
    )
