"""List the sample meshes: sample:NAME stands wherever a mesh file does."""

import argparse

from app import samples
from app.cli.console import answer, table
from lutcore.errors import CurvelightError


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
    from app.loading import load_mesh

    result: dict[str, object] = {}
    rows = [["sample", "vertices", "faces", "mm per unit", "size mm", "what it is"]]
    for name in samples.names():
        try:
            found = samples.sample(name)
            mesh = load_mesh(found.path).mesh
        except CurvelightError as error:
            rows.append([name, "-", "-", "-", "-", f"not available: {error}"])
            result[name] = {"error": str(error)}
            continue
        size = mesh.diagonal * found.mm_per_unit
        result[name] = {
            "summary": found.summary,
            "vertices": len(mesh.vertices),
            "faces": len(mesh.faces),
            "mm_per_unit": found.mm_per_unit,
            "diagonal_mm": size,
            "exact": found.exact is not None,
            "remark": found.remark,
        }
        counts = [f"{len(mesh.vertices)}", f"{len(mesh.faces)}"]
        rows.append([name, *counts, f"{found.mm_per_unit:g}", f"{size:.0f}", found.summary])
    answer(arguments, result, table(rows))
    return 0
