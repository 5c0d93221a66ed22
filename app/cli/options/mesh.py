"""Flags of what is worked on, and of where results go."""

import argparse
from pathlib import Path

from app.cli.options.typed import repair
from app.repairs import KINDS


def add_mesh(parser: argparse.ArgumentParser, optional: bool = False) -> argparse.Action:
    """Add the MESH argument, the output and the session file.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    optional : bool
        Whether the command has a mesh of its own.

    Returns
    -------
    Action
        The output's.
    """
    parser.add_argument(
        "mesh",
        nargs="?",
        metavar="MESH",
        help="PLY, OBJ, STL, OFF, GLB, glTF, 3MF, VTP, VTU or VTK file, one that meshio or MeshLab "
        "reads (.msh, .inp, .dae, .wrl ...), any of them with .gz; a volume: NIfTI, MetaImage, "
        "VTI, TIFF or a folder of TIFF slices; or sample:NAME; may be left out with --session",
    )
    add_volume(parser)
    add_repairs(parser)
    parser.set_defaults(own_mesh=optional)
    output = parser.add_argument(
        "-o", "--output", required=True, type=Path, metavar="OUT", help="result"
    )
    parser.add_argument(
        "--session",
        type=Path,
        metavar="FILE",
        help="start from a session file, or from a picture that Curvelight wrote",
    )
    parser.add_argument("--save-session", type=Path, metavar="FILE", help="write the session too")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return output


def add_volume(parser: argparse.ArgumentParser) -> None:
    """Add the flags of how a volume becomes a surface.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    """
    parser.add_argument(
        "--level",
        metavar="otsu|VALUE",
        help="value of a volume's voxels that its surface lies at; else Otsu's threshold",
    )
    parser.add_argument(
        "--smoothing", type=float, metavar="VOXELS", help="blur a volume before, sigma (0)"
    )


def add_repairs(parser: argparse.ArgumentParser) -> None:
    """Add the flag that repairs a mesh.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    """
    parser.add_argument(
        "--repair",
        type=repair,
        action="append",
        dest="repairs",
        metavar="KIND[=VALUE]",
        help="repair the mesh before anything else; may be repeated, done in order: "
        f"{'; '.join(_repair_help(name) for name in KINDS)}".replace("%", "%%"),
    )


def _repair_help(name: str) -> str:
    kind = KINDS[name]
    takes = f"=VALUE ({kind.default:g} {kind.value.unit})" if kind.value else ""
    return f"{name}{takes} {kind.words.lower()}"
