"""What charting commands have in common: flags of how to measure, checks, and the answer."""

import argparse
import time
from dataclasses import fields
from pathlib import Path
from typing import TypeVar

from app.chart.points import Chart
from app.cli.console import note, table
from app.endings import check_ending
from app.writing import check_writable, write_bytes
from lutcore.errors import ParameterError
from lutcore.parameters import Choice, Number, Parameters, declared

TOLERANCE = Number(1e-9, 1e3, "", "Error that is good enough; of a share, 0.01 is 1 %.", False)
P = TypeVar("P", bound=Parameters)


def add_measuring(
    parser: argparse.ArgumentParser, kind: type[Parameters], usual: str = "twice the least error"
) -> None:
    """Add a flag for each way to measure, and the tolerance.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    kind : type
        Holds the parameters.
    usual : str
        The tolerance where none is given.
    """
    how = parser.add_argument_group("measuring")
    for field in fields(kind):
        spec = declared(kind)[field.name]
        metavar = "|".join(spec.options) if isinstance(spec, Choice) else "N"
        doc = f"{spec.doc} ({field.default})".replace("%", "%%")
        how.add_argument(f"--{field.name}", metavar=metavar, help=doc)
    doc = f"{TOLERANCE.doc} ({usual})".replace("%", "%%")
    how.add_argument("--tolerance", metavar="T", help=doc)


def measuring_from(arguments: argparse.Namespace, kind: type[P]) -> P:
    """Return how to measure.

    Parameters
    ----------
    arguments : Namespace
        Of a command that used `add_measuring`.
    kind : type
        The same.

    Returns
    -------
    object
        An instance of it, its values checked.
    """
    given = {name: getattr(arguments, name) for name in declared(kind)}
    return kind(**{name: value for name, value in given.items() if value is not None})


def tolerance_from(arguments: argparse.Namespace) -> float | None:
    """Return the tolerance.

    Parameters
    ----------
    arguments : Namespace
        Of a command that used `add_measuring`.

    Returns
    -------
    float or None
        None where none is given.
    """
    if arguments.tolerance is None:
        return None
    return float(TOLERANCE.check("tolerance", arguments.tolerance))


def require(output: Path, mesh: str | None) -> None:
    """Make sure, before any work, that the chart can be written.

    Parameters
    ----------
    output : Path
        Where to.
    mesh : str or None
        What it is made from.

    Raises
    ------
    ParameterError
        If the output ends wrongly, or is the mesh.
    WriteError
        If it cannot be written there.
    """
    from app.chart.writing import SUFFIXES

    check_ending(output, SUFFIXES)
    source = Path(mesh or "")
    if source.is_file() and output.exists() and output.samefile(source):
        raise ParameterError(f"{output} is the mesh itself; choose another name")
    check_writable(output)


def written(
    arguments: argparse.Namespace, chart: Chart, content: bytes, start: float
) -> tuple[dict[str, object], str]:
    """Write a chart.

    Parameters
    ----------
    arguments : Namespace
        Of the command.
    chart : Chart
        What was found.
    content : bytes
        Of the file.
    start : float
        When the command began.

    Returns
    -------
    tuple of dict and str
        What it holds, for a script and for a person.
    """
    from app.chart import data

    write_bytes(arguments.output, content)
    for who, reason in data.gathered(chart.missing):
        note(arguments, f"without figures: {who}: {reason}")
    seconds = round(time.perf_counter() - start, 3)
    result = data.plain(chart) | {"output": str(arguments.output), "seconds": seconds}
    text = [chart.subject, "", table(data.rows(chart)), "", *chart.meaning, ""]
    last = f"wrote {arguments.output}"
    return result, "\n".join([*text, chart.advice.sentence, last])
