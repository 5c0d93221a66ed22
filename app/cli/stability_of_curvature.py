"""`curvelight stability --curvature`: flags and work."""

import argparse
import math
import time
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.console import answer, progress, table
from app.endings import check_ending
from lutcore.errors import ParameterError

if TYPE_CHECKING:
    from app.stability import Outcome, Report

_LIMIT = 5.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the flags.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    """
    parser.add_argument("-o", "--output", required=True, type=Path, metavar="OUT", help="result")
    parser.add_argument(
        "--methods", metavar="A,B[,...]", help="estimators; all if not given (curvelight models)"
    )
    parser.add_argument("--cases", metavar="A,B[,...]", help="cases; all if not given")
    parser.add_argument(
        "--limit",
        type=float,
        default=_LIMIT,
        metavar="SECONDS",
        help=f"time for one call, after which it is stopped and counts as dead ({_LIMIT:g})",
    )
    parser.add_argument(
        "--seed", type=int, default=0, metavar="N", help="of everything random in the cases (0)"
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
    from app import stability_files
    from app.stability import examine
    from app.writing import check_writable
    from lutcore.estimation import estimators
    from lutcore.gallery import catalogue

    if not 0.0 < arguments.limit < math.inf:
        raise ParameterError(f"--limit = {arguments.limit:g} is not a time; give seconds above 0")
    output: Path = arguments.output
    check_ending(output, stability_files.SUFFIXES)
    methods = _chosen("curvature estimator", arguments.methods, estimators())
    names = _chosen("case", arguments.cases, catalogue.names())
    check_writable(output)
    start = time.perf_counter()
    report = examine(
        [catalogue.build(name, arguments.seed) for name in names],
        methods,
        seed=arguments.seed,
        limit=arguments.limit,
        progress=progress(arguments),
    )
    stability_files.save(output, report)
    result = {"output": str(output)} | stability_files.record(report)
    result["seconds"] = round(time.perf_counter() - start, 3)
    answer(arguments, result, f"{_text(report)}\nwrote {output}")
    return 0


def _chosen(kind: str, given: str | None, choices: list[str]) -> list[str]:
    if given is None:
        return choices
    # A name that is given twice counts once.
    wanted = list(dict.fromkeys(name.strip() for name in given.split(",")))
    for name in wanted:
        if name not in choices:
            raise ParameterError.unknown(kind, name, choices)
    return wanted


def _text(report: "Report") -> str:
    from lutcore.gallery.judgement import REASONS

    columns = range(1, len(report.methods) + 1)
    grid = [["case", *map(str, columns)]]
    grid += [
        [case.name, *(_cell(report.outcomes[case.name, one]) for one in report.methods)]
        for case in report.cases
    ]
    ranking = [["", "estimator", *map(str, REASONS)]]
    for column, method in zip(columns, report.methods, strict=True):
        ranking.append([str(column), method, *map(str, report.count(method).values())])
    meaning = [f"{verdict}: {reason}" for verdict, reason in REASONS.items()]
    said = [f"{method}: {words}" for method, words in _messages(report)]
    return "\n".join(
        [
            table(grid),
            "",
            "RMS error over RMS curvature; ~ degraded, x wrong",
            *meaning,
            "",
            *([*said, ""] if said else []),
            table(ranking),
        ]
    )


def _messages(report: "Report") -> list[tuple[str, str]]:
    """Return who said what and where, each message once."""
    found: dict[tuple[str, str], list[str]] = {}
    for (case, method), outcome in report.outcomes.items():
        if outcome.message:
            words = outcome.message.removeprefix(f"{method}: ")
            found.setdefault((method, words), []).append(case)
    every = len(report.cases)
    return [
        (method, f"{message} ({'all cases' if len(cases) == every else ', '.join(cases)})")
        for (method, message), cases in found.items()
    ]


def _cell(outcome: "Outcome") -> str:
    from app.stability_look import LOOKS, number

    plain = LOOKS[outcome.verdict].plain
    return plain if outcome.score is None else number(outcome.score.error) + plain
