"""List the materials with their coefficients: reduced scattering, absorption, refractive index."""

import argparse
from collections.abc import Iterable

from app.cli.console import answer, table


def add_arguments(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Declare the command's flags.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments.
    """
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
    from lutcore.baking import bake
    from lutcore.materials import material, materials

    result: dict[str, object] = {}
    rows = [["material", "sigma_s' 1/mm", "sigma_a 1/mm", "eta", "R_d", "glow mm"]]
    for name in materials():
        found, baked = material(name), bake(name)
        glow = baked.mean_free_path * baked.psi[:, 0]
        result[name] = {
            "scattering_per_mm": list(found.scattering),
            "absorption_per_mm": list(found.absorption),
            "eta": list(found.eta),
            "diffuse_reflectance": baked.total.tolist(),
            "glow_mm": glow.tolist(),
            "glow_floored": baked.floored.tolist(),
        }
        cells: list[Iterable[float]] = [found.scattering, found.absorption, found.eta]
        cells += [baked.total, glow]
        mark = "*" if baked.floored.any() else ""
        rows.append([name + mark, *(" ".join(f"{value:.3g}" for value in cell) for cell in cells)])
    text = (
        f"{table(rows)}\n"
        "red green blue; glow is l_u psi(0), how far light carries a shadow's edge\n"
        "* without absorption the glow has no end: it is that of the least absorption that has one"
    )
    answer(arguments, result, text)
    return 0
