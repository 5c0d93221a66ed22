"""A stability report as one picture: cases down, estimators across."""

import io
from typing import Any

from app.stability import Outcome, Report
from app.stability_look import LOOKS, growth, number
from app.stability_thumbnail import thumbnails
from lutcore.gallery.judgement import REASONS, Verdict

# Inches.
_DPI = 100
_THUMB, _TITLE, _CELL, _ROW = 1.3, 2.4, 0.78, 0.64
_HEAD, _FOOT, _MARGIN, _SLANT = 2.3, 2.3, 0.15, 1.1
_NARROWEST = 11.0
_LETTERS = 13.5  # of the legend's text to an inch


def picture(report: Report) -> bytes:
    """Draw a report.

    Parameters
    ----------
    report : Report
        A run.

    Returns
    -------
    bytes
        A PNG file.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    left = _MARGIN + _THUMB + _TITLE
    width = max(left + _CELL * len(report.methods) + _SLANT, _NARROWEST)
    height = _HEAD + _ROW * len(report.cases) + _FOOT
    figure = Figure(figsize=(width, height), dpi=_DPI, facecolor="white")
    canvas: Any = FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    axes.set_xlim(0.0, width)
    axes.set_ylim(height, 0.0)  # inches from the upper left corner
    _heading(axes, report, left)
    for index, case in enumerate(report.cases):
        top = _HEAD + _ROW * index
        side = _ROW - 0.04
        axes.imshow(
            thumbnails(case, 2 * round(_DPI * side)),
            extent=(_MARGIN, _MARGIN + 2.0 * side, top + side, top),
            interpolation="antialiased",
        )
        axes.text(_MARGIN + _THUMB + 0.08, top + 0.5 * _ROW, case.title, va="center", fontsize=10.5)
        for column, method in enumerate(report.methods):
            outcome = report.outcomes[case.name, method]
            _cell(axes, outcome, left + _CELL * column, top)
    _legend(axes, _HEAD + _ROW * len(report.cases) + 0.4, width)
    axes.set_xlim(0.0, width)
    axes.set_ylim(height, 0.0)
    axes.set_aspect("auto")  # imshow had its own mind about these three
    out = io.BytesIO()
    canvas.print_png(out)
    return out.getvalue()


def _heading(axes: Any, report: Report, left: float) -> None:
    axes.text(
        _MARGIN,
        0.3,
        "Curvature estimators on broken meshes",
        va="center",
        fontsize=15,
        weight="bold",
    )
    axes.text(
        _MARGIN,
        0.6,
        "upper number: RMS error over RMS curvature\n"
        "lower number: times the error without the defect",
        va="top",
        fontsize=9.5,
        color="#444444",
        linespacing=1.4,
    )
    axes.text(_MARGIN + _THUMB + 0.08, _HEAD - 0.17, "survived", va="center", fontsize=10)
    for column, method in enumerate(report.methods):
        x = left + _CELL * (column + 0.5)
        axes.text(
            x - 0.05,
            _HEAD - 0.34,
            method,
            rotation=50,
            rotation_mode="anchor",
            fontsize=10.5,
            weight="bold",
        )
        survived = report.count(method)[Verdict.SURVIVES]
        axes.text(
            x,
            _HEAD - 0.17,
            f"{survived}/{len(report.cases)}",
            ha="center",
            va="center",
            fontsize=10,
        )


def _cell(axes: Any, outcome: Outcome, x: float, y: float) -> None:
    from matplotlib.patches import Rectangle

    look = LOOKS[outcome.verdict]
    axes.add_patch(
        Rectangle((x, y), _CELL, _ROW, facecolor=look.fill, edgecolor="#ffffff", linewidth=1.5)
    )
    middle = x + 0.5 * _CELL
    if outcome.score is None:
        axes.text(
            middle,
            y + 0.5 * _ROW,
            f"{look.mark}\n{outcome.verdict}",
            ha="center",
            va="center",
            color=look.text,
            fontsize=9,
        )
        return
    axes.text(
        middle,
        y + 0.34 * _ROW,
        f"{look.mark} {number(outcome.score.error)}",
        ha="center",
        va="center",
        color=look.text,
        fontsize=11,
    )
    axes.text(
        middle,
        y + 0.72 * _ROW,
        growth(outcome),
        ha="center",
        va="center",
        color=look.text,
        fontsize=8.5,
    )


def _legend(axes: Any, top: float, width: float) -> None:
    import textwrap

    from matplotlib.patches import Rectangle

    for index, (verdict, look) in enumerate(LOOKS.items()):
        y = top + 0.34 * index
        axes.add_patch(
            Rectangle((_MARGIN, y - 0.13), 0.3, 0.26, facecolor=look.fill, edgecolor="#999999")
        )
        axes.text(
            _MARGIN + 0.15, y, look.mark, ha="center", va="center", color=look.text, fontsize=10
        )
        axes.text(_MARGIN + 0.42, y, verdict, va="center", fontsize=9.5, weight="bold")
        reason = textwrap.fill(REASONS[verdict], round(_LETTERS * (width - 1.7)))
        axes.text(_MARGIN + 1.3, y, reason, va="center", fontsize=9, linespacing=1.1)
