"""Write a material's tables: the 1-D psi table, or the paper's 2-D (a, b) table with --plane.

.npz holds all arrays, .exr one float image, .png 16-bit values with their range in its text.
"""

import argparse
from pathlib import Path

from app.cli.console import answer
from app.cli.options.methods import add_profile, profile_from
from app.session import Session


def add_arguments(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Declare the command's flags.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments.
    """
    parser.add_argument("material", metavar="MATERIAL", help="see curvelight materials")
    parser.add_argument("-o", "--output", required=True, type=Path, metavar="OUT", help="result")
    add_profile(parser, words)
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--samples", type=int, metavar="N", help="knots of psi; else 1e-6 exact")
    size.add_argument(
        "--plane", type=int, metavar="N", help="the paper's 2-D table, N x N, instead of psi"
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")


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
    from app.lutfile import save_table
    from lutcore.baking import bake, bake_plane
    from lutcore.diffusion import diffusion_profile

    method = profile_from(arguments, Session())
    profile = diffusion_profile(method.name, **method.parameters)
    baked = bake(arguments.material, arguments.samples, profile)
    if arguments.plane is None:
        save_table(arguments.output, baked)
    else:
        plane = bake_plane(arguments.material, arguments.plane, profile=profile)
        save_table(arguments.output, plane)
    result = {
        "material": arguments.material,
        "output": str(arguments.output),
        "profile": method.name,
        "samples": arguments.plane or baked.samples,
        "diffuse_reflectance": baked.total.tolist(),
        "psi0": baked.psi[:, 0].tolist(),
        "mean_free_path_mm": baked.mean_free_path.tolist(),
        "glow_floored": baked.floored.tolist(),
    }
    answer(arguments, result, f"wrote {arguments.output}")
    return 0
