"""A stability report as one picture: each model's error over k and beta, and over k and angle."""

from typing import TYPE_CHECKING

import numpy as np

from app.stability_of_shading.looks import LEAST, MOST, OUTLINES
from app.stability_of_shading.report import Outcome, Report
from lutcore.arrays import FloatArray
from lutcore.stability_of_shading.maps import BETAS, CURVATURES, REASONS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Inches: a model's pair of maps, and what stands above and below all.
_PAIR, _ROW, _HEAD, _FOOT, _ACROSS = 4.8, 2.45, 0.95, 1.5, 4
# The substance whose error is drawn over the angle: between the channels of skin.
_TYPICAL, _SIGNED = 0.4, 0.2


def figure(report: Report) -> "Figure":
    """Draw a report.

    Parameters
    ----------
    report : Report
        A run.

    Returns
    -------
    Figure
        Of matplotlib.
    """
    from matplotlib.figure import Figure

    across = min(_ACROSS, len(report.outcomes))
    rows = -(-len(report.outcomes) // across)
    wide, high = max(_PAIR * across, 2.0 * _PAIR), _HEAD + _ROW * rows + _FOOT
    drawn = Figure(figsize=(wide, high), facecolor="white")
    drawn.text(
        0.3 / wide,
        1.0 - 0.18 / high,
        "Where shading models fail",
        fontsize=16,
        weight="bold",
        va="top",
    )
    drawn.text(
        0.3 / wide,
        1.0 - 0.52 / high,
        f"Balls lit from one side, eta {report.ground.eta:g}, against {report.profile} integrated "
        "over the true ball; models that aim at more than it are judged by it too. Left: relative "
        "L2 error over curvature k and beta = l_u/l_d.\nRight, at beta "
        f"{BETAS[_typical()]:.2g}: error in R_d over k and the height of the light.",
        fontsize=10,
        va="top",
        parse_math=False,
    )
    for at, one in enumerate(report.outcomes):
        row, column = divmod(at, across)
        left = (_PAIR * column + 0.62) / wide
        bottom = 1.0 - (_HEAD + _ROW * (row + 1) - 0.52) / high
        size = 1.72 / wide, (_ROW - 0.9) / high
        whole = drawn.add_axes((left, bottom, *size))
        angle = drawn.add_axes((left + 2.35 / wide, bottom, *size))
        _draw_whole(whole, one)
        _draw_angle(angle, one, report)
    _draw_key(drawn, report, wide, high)
    return drawn


def _typical() -> int:
    return int(np.argmin(np.abs(BETAS - _TYPICAL)))


def _draw_whole(axes: "Axes", one: Outcome) -> None:
    from matplotlib.colors import LogNorm

    norm = LogNorm(LEAST, MOST)
    axes.pcolormesh(CURVATURES, BETAS, one.field.error, norm=norm, cmap="Greys", shading="nearest")
    for region in one.regions:
        color, line = OUTLINES[region.name]
        # A margin of nothing around closes outlines at the edges.
        mask = np.pad(region.mask.astype(float), 1)
        x, y = (_around(values) for values in (CURVATURES, BETAS))
        axes.contour(x, y, mask, [0.5], colors=[color], linestyles=[line], linewidths=1.8)
    axes.set_xlim(*_edges(CURVATURES))
    axes.set_ylim(*_edges(BETAS))
    axes.set_yscale("log")
    _finish(axes, one.name, "beta")


def _draw_angle(axes: "Axes", one: Outcome, report: Report) -> None:
    height = np.degrees(np.arcsin(report.ground.cosines))
    missed = one.field.missed[_typical()].T
    axes.pcolormesh(
        CURVATURES, height, missed, vmin=-_SIGNED, vmax=_SIGNED, cmap="RdBu_r", shading="nearest"
    )
    axes.axhline(0.0, color="#444444", lw=0.6)
    _finish(axes, "", "height of light, degrees")


def _finish(axes: "Axes", title: str, label: str) -> None:
    from matplotlib.ticker import FuncFormatter

    axes.set_xscale("log")
    axes.set_title(title, fontsize=11, weight="bold", loc="left", parse_math=False)
    axes.set_xlabel("k l_u", fontsize=8.5, labelpad=1, parse_math=False)
    axes.set_ylabel(label, fontsize=8.5, labelpad=1)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.tick_params(labelsize=8)


def _around(values: FloatArray) -> FloatArray:
    low, high = _edges(values)
    return np.concatenate(([low], values, [high]))


def _edges(values: FloatArray) -> tuple[float, float]:
    step = np.sqrt(values[1] / values[0])
    return float(values[0] / step), float(values[-1] * step)


def _draw_key(drawn: "Figure", report: Report, wide: float, high: float) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LogNorm, Normalize
    from matplotlib.lines import Line2D

    said = {region.name for one in report.outcomes for region in one.regions}
    names = [name for name in OUTLINES if name in said]
    handles = [
        Line2D([], [], color=OUTLINES[name][0], linestyle=OUTLINES[name][1], lw=2.0)
        for name in names
    ]
    words = [f"{name}: {REASONS[name]}" for name in names]
    box = drawn.legend(
        handles,
        words,
        loc="lower left",
        bbox_to_anchor=(0.3 / wide, 0.1 / high),
        frameon=False,
        fontsize=9,
        title=f"tolerance {100.0 * report.tolerance:g} %",
        alignment="left",
    )
    for one in box.get_texts():
        one.set_parse_math(False)
    for at, (label, norm, colors) in enumerate(
        (
            ("relative L2 error", LogNorm(LEAST, MOST), "Greys"),
            ("error, R_d", Normalize(-_SIGNED, _SIGNED), "RdBu_r"),
        )
    ):
        bottom = (1.05 - 0.7 * at) / high
        place = drawn.add_axes((1.0 - 2.4 / wide, bottom, 2.0 / wide, 0.14 / high))
        bar = drawn.colorbar(ScalarMappable(norm, colors), cax=place, orientation="horizontal")
        bar.ax.tick_params(labelsize=8)
        bar.ax.set_title(label, fontsize=9, parse_math=False)
