"""A stability report of shading as data, and the file that it is saved to."""

import csv
import io
import json
from pathlib import Path

import numpy as np

from app.endings import unknown_ending
from app.stability_of_shading.report import Outcome, Report, cells
from app.writing import write_bytes
from lutcore.stability_of_shading.maps import BETAS, CURVATURES, REASONS

SUFFIXES = (".png", ".csv", ".json", ".html")


def record(report: Report) -> dict[str, object]:
    """Return a report as what JSON can say.

    Parameters
    ----------
    report : Report
        A run.

    Returns
    -------
    dict
        Meaning of the regions, and by model its regions and checks.
    """
    return {
        "profile": report.profile,
        "eta": report.ground.eta,
        "tolerance": report.tolerance,
        "k_l_u": [float(CURVATURES[0]), float(CURVATURES[-1])],
        "beta": [float(BETAS[0]), float(BETAS[-1])],
        "regions": REASONS,
        "models": {one.name: _model(one) for one in report.outcomes},
    }


def _model(one: Outcome) -> dict[str, object]:
    return {
        "share_failing": one.failing,
        "regions": {
            region.name: {"share": float(region.mask.mean()), "worst": region.worst}
            for region in one.regions
        },
        "checks": {
            check.name: {
                "value": check.value if np.isfinite(check.value) else None,
                "limit": check.limit if np.isfinite(check.limit) else None,
                "passed": check.passed,
                "meaning": check.meaning,
            }
            for check in one.checks
        },
    }


def save(path: Path, report: Report) -> None:
    """Write a report; the format follows from the name's ending.

    Parameters
    ----------
    path : Path
        Ends in .png, .csv, .json or .html. .json holds every ball and every angle of the light.
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
        content = (json.dumps(_everything(report), allow_nan=False) + "\n").encode()
    elif suffix == ".png":
        from app.chart.drawing import png
        from app.stability_of_shading.picture import figure

        content = png(figure(report))
    elif suffix == ".html":
        from app.stability_of_shading.page import page

        content = page(report).encode()
    else:
        raise unknown_ending(path, SUFFIXES)
    write_bytes(path, content)


def _everything(report: Report) -> dict[str, object]:
    missed = {one.name: np.round(one.field.missed, 6).tolist() for one in report.outcomes}
    return record(report) | {
        "cells": cells(report),
        "n_dot_w": report.ground.cosines.tolist(),
        "missed_over_r_d": missed,
    }


def _csv(report: Report) -> str:
    rows = cells(report)
    out = io.StringIO()
    writer = csv.DictWriter(out, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return out.getvalue()
