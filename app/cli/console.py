"""What the commands print: messages, tables, one JSON object, progress."""

import argparse
import json
import sys
import time
from collections.abc import Sequence

from lutcore.progress import Progress, silent

_PATIENCE = 0.7


def out(text: str) -> None:
    """Print a line of the answer on standard output.

    Parameters
    ----------
    text : str
        The line.
    """
    print(text)  # noqa: T201


def note(arguments: argparse.Namespace, text: str) -> None:
    """Print a remark on standard error, unless the user wants quiet.

    Parameters
    ----------
    arguments : Namespace
        Of the command.
    text : str
        The remark.
    """
    if not arguments.quiet:
        print(f"curvelight: {text}", file=sys.stderr)  # noqa: T201


def answer(arguments: argparse.Namespace, result: dict[str, object], text: str) -> None:
    """Print the result: as one JSON object if asked for, else as text unless quiet.

    Parameters
    ----------
    arguments : Namespace
        Of the command.
    result : dict
        What a script reads; infinite numbers become null.
    text : str
        What a person reads.
    """
    if arguments.json:
        out(json.dumps(result, indent=2, allow_nan=False))
    elif not arguments.quiet:
        out(text)


def table(rows: Sequence[Sequence[str]]) -> str:
    """Return rows as aligned columns; numbers to the right.

    Parameters
    ----------
    rows : sequence of sequence of str
        The first is the heading.

    Returns
    -------
    str
        One line for each row.
    """
    widths = [max(len(cell) for cell in column) for column in zip(*rows, strict=True)]
    lines = []
    for row in rows:
        cells = [
            cell.rjust(width) if cell[:1].isdigit() or cell[:1] in "-." else cell.ljust(width)
            for cell, width in zip(row, widths, strict=True)
        ]
        lines.append("  ".join(cells).rstrip())
    return "\n".join(lines)


def progress(arguments: argparse.Namespace) -> Progress:
    """Return the function that shows where long work stands.

    Parameters
    ----------
    arguments : Namespace
        Of the command.

    Returns
    -------
    callable
        Draws one line on a terminal once work takes long; silent elsewhere.
    """
    if arguments.quiet or not sys.stderr.isatty():
        return silent
    return _Line()


class _Line:
    """A line on the terminal that is written over."""

    def __init__(self) -> None:
        self._start = time.monotonic()

    def __call__(self, share: float, step: str) -> bool:
        elapsed = time.monotonic() - self._start
        if elapsed > _PATIENCE:
            sys.stderr.write(f"\r\033[K{100.0 * share:3.0f} %  {step}  {elapsed:.0f} s")
            if step == "drawing":
                sys.stderr.write("\r\033[K")
            sys.stderr.flush()
        return True
