"""Redraw a picture from what it says of itself, and compare.

A PNG, GIF or MP4 that Curvelight wrote carries its session, the versions and the driver that drew
it, and the SHA-256 of its mesh and of its pixels. All frames of a GIF are drawn again and compared
as a PNG is. An MP4 loses detail as it is coded: its frames are drawn again, compared bit for bit
with those that were encoded, by their SHA-256, and within --threshold with what the film shows.
Exit code 0: it is reproduced; 6: it differs, or its pixels or its metadata were edited; 3: it
cannot be read or redrawn.
"""

import argparse
from pathlib import Path

from app.animation_motion import SUFFIXES
from app.cli.console import answer, progress
from app.cli.performing import add_threshold
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
    parser.add_argument(
        "picture", type=Path, metavar="PICTURE", help="PNG, GIF or MP4 that Curvelight wrote"
    )
    parser.add_argument("--mesh", metavar="MESH", help="where its mesh is now")
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="DIFF.png",
        help="where to show a difference: both pictures, or frames, and CIEDE2000",
    )
    add_threshold(parser)
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
    from app.cli.referring import DIFFERS
    from app.likeness import write_difference
    from app.pipeline import Pipeline
    from app.verifying import verify
    from app.verifying_films import verify_film
    from app.writing import check_writable

    if arguments.output is not None:
        _refuse(arguments)
        check_writable(arguments.output)
    pipeline = Pipeline(progress(arguments))
    redraw = verify_film if arguments.picture.suffix.lower() in SUFFIXES else verify
    found = redraw(arguments.picture, pipeline, arguments.mesh, arguments.threshold)
    lines, shown = list(found.sentences), None
    if arguments.output is not None and found.likeness.pixels:
        if found.likeness.difference is None:
            lines.append("pictures of different sizes have no difference picture")
        else:
            write_difference(arguments.output, found.expected, found.redrawn, found.likeness)
            lines.append(f"wrote {arguments.output}")
            shown = str(arguments.output)
    result = {"picture": str(arguments.picture), **found.as_json(), "difference": shown}
    answer(arguments, result, f"{arguments.picture}: " + "\n  ".join(lines))
    return 0 if found.same else DIFFERS


def _refuse(arguments: argparse.Namespace) -> None:
    """Keep the difference from replacing what it was made of."""
    if arguments.output.suffix.lower() != ".png":
        raise ParameterError(f"{arguments.output}: a difference is a picture; write -o NAME.png")
    for place in (arguments.picture, Path(arguments.mesh or "")):
        if arguments.output.exists() and place.is_file() and arguments.output.samefile(place):
            raise ParameterError(f"{place} is what is verified; choose another name with -o")
