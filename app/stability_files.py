"""A stability report as data, and the file that it is saved to."""

import csv
import io
import json
from pathlib import Path

import numpy as np

from app.endings import unknown_ending
from app.stability import Outcome, Report
from app.writing import write_bytes
from lutcore.gallery.judgement import REASONS

SUFFIXES = (".png", ".csv", ".json", ".html")


def row(outcome: Outcome) -> dict[str, object]:
    """Return an outcome as a flat record.

    Parameters
    ----------
    outcome : Outcome
        One estimator on one case.

    Returns
    -------
    dict
        Errors are shares of the RMS curvature. None stands for what is not known or not finite.
    """
    found = outcome.score
    errors = ("error", "worst", "turned", "missing", "within_1", "within_2")
    values = {name: None if found is None else _number(getattr(found, name)) for name in errors}
    return {
        "case": outcome.case,
        "method": outcome.method,
        "verdict": str(outcome.verdict),
        "error": values["error"],
        "error_without_defect": _number(outcome.without),
        "ratio": _number(outcome.ratio),
        "error_p99": values["worst"],
        "wrong_sign": values["turned"],
        "not_estimated": values["missing"],
        "within_1_sigma": values["within_1"],
        "within_2_sigma": values["within_2"],
        "seconds": round(outcome.seconds, 4),
        "message": outcome.message,
    }


def record(report: Report) -> dict[str, object]:
    """Return a report as what JSON can say.

    Parameters
    ----------
    report : Report
        A run.

    Returns
    -------
    dict
        Cases with their descriptions, the meaning of the verdicts, counts, and every outcome.
    """
    return {
        "seed": report.seed,
        "limit_seconds": report.limit,
        "verdicts": {str(verdict): reason for verdict, reason in REASONS.items()},
        "cases": [
            {
                "name": case.name,
                "title": case.title,
                "why": case.why,
                "vertices": len(case.broken.mesh.vertices),
                "faces": len(case.broken.mesh.faces),
                "judged_vertices": int(np.count_nonzero(case.broken.judged)),
            }
            for case in report.cases
        ],
        "methods": {
            method: {str(verdict): count for verdict, count in report.count(method).items()}
            for method in report.methods
        },
        "results": [row(outcome) for outcome in _in_order(report)],
    }


def save(path: Path, report: Report) -> None:
    """Write a report; the format follows from the name's ending.

    Parameters
    ----------
    path : Path
        Ends in .png, .csv, .json or .html.
    report : Report
        A run.

    Raises
    ------
    ParameterError
        If the ending is another.
    WriteError
        If it cannot be written; an older file of that name is then untouched.
    """
    suffix = path.suffix.lower()
    if suffix == ".csv":
        content = _csv(report).encode()
    elif suffix == ".json":
        content = (json.dumps(record(report), indent=2, allow_nan=False) + "\n").encode()
    elif suffix == ".png":
        from app.stability_picture import picture

        content = picture(report)
    elif suffix == ".html":
        from app.stability_page import page

        content = page(report).encode()
    else:
        raise unknown_ending(path, SUFFIXES)
    write_bytes(path, content)


def _csv(report: Report) -> str:
    rows = [row(outcome) for outcome in _in_order(report)]
    out = io.StringIO()
    writer = csv.DictWriter(out, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return out.getvalue()


def _in_order(report: Report) -> list[Outcome]:
    return [report.outcomes[case.name, one] for case in report.cases for one in report.methods]


def _number(value: float | None) -> float | None:
    """Six digits are more than a judgement has."""
    return None if value is None or not np.isfinite(value) else float(f"{value:.6g}")
