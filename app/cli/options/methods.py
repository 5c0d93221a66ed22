"""Flags of the curvature estimator and the diffusion profile."""

import argparse

from app.cli.options.plugins import add_plugin, method_from
from app.cli.options.typed import names
from app.session import Method, Session


def add_curvature(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Add the flags of the curvature estimator, its own parameters included.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments: they say which estimator.
    """
    from lutcore.estimation import estimator_registry

    group = parser.add_argument_group("curvature")
    doc = "estimator; see curvelight models"
    add_plugin(parser, group, estimator_registry, words, "--method", "estimator", doc)
    group.add_argument(
        "--scale", metavar="auto|LENGTH", help="averaging length: 3 in mesh units, or 3mm"
    )
    group.add_argument("--mm-per-unit", type=float, metavar="N", help="size of a mesh unit")


def add_peers(parser: argparse.ArgumentParser) -> None:
    """Add the flag that names estimators to compare.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    """
    parser.add_argument(
        "--disagree",
        type=names,
        metavar="A,B,C[,...]",
        dest="peers",
        help="three estimators or more: map how far they are apart at each vertex (their median "
        "absolute deviation as one sigma); those that cannot estimate this mesh are left out",
    )


def add_profile(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Add the flags of the diffusion profile, its own parameters included.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments: they say which profile.
    """
    from lutcore.diffusion import profile_registry

    doc = "how light spreads in the material; see curvelight models"
    add_plugin(parser, parser, profile_registry, words, "--profile", "profile", doc)


def profile_from(arguments: argparse.Namespace, start: Session) -> Method:
    """Return the diffusion profile that the arguments name.

    Parameters
    ----------
    arguments : Namespace
        Of a command that used `add_profile`.
    start : Session
        Its profile is taken where they name none.

    Returns
    -------
    Method
        The profile.
    """
    said = method_from(start.profile, vars(arguments), "diffusion profile", "profile")
    return said or start.profile
