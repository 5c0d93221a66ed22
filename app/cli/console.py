"""What the commands print: messages, tables, one JSON object, progress."""

import argparse
import json
import math
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
        clear_line()
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
    clear_line()
    if arguments.json:
        out(json.dumps(_sayable(result), indent=2, allow_nan=False))
    elif not arguments.quiet:
        out(text)


def _sayable(value: object) -> object:
    """Replace numbers that JSON cannot say by None."""
    if isinstance(value, dict):
        return {key: _sayable(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_sayable(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def clear_line() -> None:
    """Remove a progress line from the terminal."""
    if sys.stderr.isatty():
        sys.stderr.write("\r\033[K")
        sys.stderr.flush()


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
            sys.stderr.flush()
        return True
