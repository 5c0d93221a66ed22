"""A chart as text: a table for people, CSV and plain values for programs."""

import csv
import io
from collections.abc import Sequence

from app.chart.measure import microseconds, number
from app.chart.points import Chart, Missing, Point, Spread


def plain(chart: Chart) -> dict[str, object]:
    """Return a chart as plain values, for JSON.

    Parameters
    ----------
    chart : Chart
        Any.

    Returns
    -------
    dict
        Times in microseconds a vertex, errors as shares.
    """
    best = chart.advice.point
    return {
        "subject": chart.subject,
        "meaning": list(chart.meaning),
        "recommendation": {
            "sentence": chart.advice.sentence,
            "name": best.name if best else None,
            "setting": best.setting if best else None,
        },
        "measure": chart.measure.title,
        "tolerance": chart.tolerance,
        "points": [_plain(point, chart) for point in chart.points],
        "missing": [
            {"name": one.name, "setting": one.setting, "reason": one.reason}
            for one in chart.missing
        ],
        "machine": dict(chart.machine),
        **chart.facts,
    }


def _plain(point: Point, chart: Chart) -> dict[str, object]:
    return {
        "name": point.name,
        "setting": point.setting,
        "microseconds_per_vertex": _spread(point.time, 1e6),
        **_frame(point, chart),
        "error": _spread(point.error, 1.0),
        "on_front": point in chart.front,
        **point.details,
    }


def _frame(point: Point, chart: Chart) -> dict[str, float]:
    if chart.frame is None:
        return {}
    return {"milliseconds_per_frame": 1e3 * point.seconds * chart.frame}


def _spread(spread: Spread, factor: float) -> dict[str, float]:
    return {
        "least": factor * spread.least,
        "median": factor * spread.middle,
        "greatest": factor * spread.greatest,
    }


def as_csv(chart: Chart) -> str:
    """Return a chart as comma-separated values.

    Parameters
    ----------
    chart : Chart
        Any.

    Returns
    -------
    str
        A heading, a line for each point, then one for each that gave no figures.
    """
    every = [_frame(point, chart) | dict(point.details) for point in chart.points]
    details = list(dict.fromkeys(key for one in every for key in one))
    figures = ("least", "median", "greatest")
    heading = ["name", "setting"]
    heading += [f"microseconds_per_vertex_{figure}" for figure in figures]
    heading += [f"error_{figure}" for figure in figures]
    heading += ["on_front", "recommended", *details, "reason"]
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(heading)
    for point, known in zip(chart.points, every, strict=True):
        numbers = [*_spread(point.time, 1e6).values(), *_spread(point.error, 1.0).values()]
        extra = [f"{known[key]:.6g}" if key in known else "" for key in details]
        marks = [int(point in chart.front), int(point == chart.advice.point)]
        figures_said = [f"{value:.6g}" for value in numbers]
        writer.writerow([point.name, point.setting, *figures_said, *marks, *extra, ""])
    for one in chart.missing:
        writer.writerow([one.name, one.setting, *[""] * (len(heading) - 3), one.reason])
    return out.getvalue()


def rows(chart: Chart) -> list[list[str]]:
    """Return a chart's figures as rows of a table, least error first.

    Parameters
    ----------
    chart : Chart
        Any.

    Returns
    -------
    list of list of str
        The heading, then a row for each point. The last cell marks the front and the
        recommended one.
    """
    measure = chart.measure
    table = [["method", "setting", measure.title, "least to most", "µs/vertex", "median, most"]]
    table[0] += [] if chart.frame is None else ["ms/frame"]
    table[0] += [*(shown.title for shown in chart.columns.values()), ""]
    for point in sorted(chart.points, key=lambda one: one.share):
        mark = "front" if point in chart.front else ""
        table.append(
            [
                point.name,
                point.setting or "default",
                measure.said(point.share),
                f"{measure.said(point.error.least)} to {measure.said(point.error.greatest)}",
                microseconds(point.seconds),
                f"{microseconds(point.time.middle)}, {microseconds(point.time.greatest)}",
                *(number(milliseconds) for milliseconds in _frame(point, chart).values()),
                *(shown.said(point.details[key]) for key, shown in chart.columns.items()),
                "recommended" if point == chart.advice.point else mark,
            ]
        )
    return table


def gathered(missing: Sequence[Missing]) -> list[tuple[str, str]]:
    """Return who is missing, those of one name and one reason together.

    Parameters
    ----------
    missing : sequence of Missing
        All.

    Returns
    -------
    list of tuple of str
        Who, and why.
    """
    together: dict[tuple[str, str], list[str]] = {}
    for one in missing:
        together.setdefault((one.name, one.reason.removeprefix(f"{one.name}: ")), []).append(
            one.setting
        )
    said = []
    for (name, reason), settings in together.items():
        which = ", ".join(setting for setting in settings if setting)
        said.append((f"{name} ({which})" if which else name, reason))
    return said
