"""`curvelight stability --shading`: flags and work."""

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.console import answer, progress, table
from app.endings import check_ending
from lutcore.errors import ParameterError
from lutcore.parameters import Number

if TYPE_CHECKING:
    from app.stability_of_shading.report import Report

_TOLERANCE = Number(1e-4, 10.0, "", "Relative L2 error over a ball that is accepted.", False)
_ETA = Number(1.0, 3.0, "", "Refractive index of the balls.", False)
_SHOWN = (0.01, 0.03, 0.1, 0.3, 1.0)
_AT = 0.4


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the flags.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    """
    from app.stability_of_shading.report import ETA, TOLERANCE

    parser.add_argument("-o", "--output", required=True, type=Path, metavar="OUT", help="result")
    parser.add_argument(
        "--models", metavar="A,B[,...]", help="local models; all if not given (curvelight models)"
    )
    parser.add_argument("--profile", metavar="NAME", default="jensen2001", help="how light spreads")
    parser.add_argument("--tolerance", metavar="T", help=f"{_TOLERANCE.doc} ({TOLERANCE:g})")
    parser.add_argument("--eta", metavar="N", help=f"{_ETA.doc} ({ETA:g})")
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
    from app.stability_of_shading import files
    from app.stability_of_shading.report import ETA, TOLERANCE, examine
    from app.writing import check_writable

    output: Path = arguments.output
    check_ending(output, files.SUFFIXES)
    names = _chosen(arguments.models)
    given = TOLERANCE if arguments.tolerance is None else arguments.tolerance
    tolerance = float(_TOLERANCE.check("tolerance", given))
    eta = float(_ETA.check("eta", ETA if arguments.eta is None else arguments.eta))
    check_writable(output)
    start = time.perf_counter()
    report = examine(names, arguments.profile, tolerance, eta, progress(arguments))
    files.save(output, report)
    result = {"output": str(output)} | files.record(report)
    result["seconds"] = round(time.perf_counter() - start, 3)
    answer(arguments, result, f"{_text(report)}\nwrote {output}")
    return 0


def _chosen(given: str | None) -> list[str]:
    from lutcore.shading import model_registry, shading_models

    local = [name for name in shading_models() if model_registry.get(name).local]
    if given is None:
        return local
    wanted = list(dict.fromkeys(name.strip() for name in given.split(",")))
    for name in wanted:
        if name not in local:
            raise ParameterError.unknown("local shading model", name, local)
    return wanted


def _text(report: "Report") -> str:
    import numpy as np

    from app.stability_of_shading.looks import summary
    from lutcore.stability_of_shading.maps import BETAS, CURVATURES, REASONS

    row = int(np.argmin(np.abs(BETAS - _AT)))
    columns = [int(np.argmin(np.abs(CURVATURES - k))) for k in _SHOWN]
    errors = [["error at k l_u", *(f"{CURVATURES[at]:.2g}" for at in columns), "fails on"]]
    tried = [["", *(check.name for check in report.outcomes[0].checks)]]
    for one in report.outcomes:
        cells = [f"{100.0 * one.field.error[row, at]:.3g} %" for at in columns]
        errors.append([one.name, *cells, f"{100.0 * one.failing:.0f} %"])
        values = [f"{check.value:.2g}" + ("" if check.passed else " x") for check in one.checks]
        tried.append([one.name, *values])
    limits = [
        f"{check.name}: {check.meaning}"
        + (f"; at most {check.limit:g}" if np.isfinite(check.limit) else "")
        for check in report.outcomes[0].checks
    ]
    where = [f"{one.name}: {summary(one)}" for one in report.outcomes]
    said = {region.name for one in report.outcomes for region in one.regions}
    return "\n".join(
        [
            f"relative L2 error on balls against {report.profile}, beta {BETAS[row]:.2g}, "
            f"eta {report.ground.eta:g}",
            table(errors),
            "",
            f"where they fail, of all k l_u and beta (tolerance {100.0 * report.tolerance:g} %)",
            *where,
            *(f"  {name}: {reason}" for name, reason in REASONS.items() if name in said),
            "",
            table(tried),
            *(f"  {one}" for one in limits),
        ]
    )
