"""The picture of a chart: error against time, both logarithmic."""

import io
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from app.chart.captions import Inks, head, key, styles_of
from app.chart.labels import Box, place
from app.chart.points import Chart, Point

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WIDE, _HIGH, _DPI = 12.0, 7.5, 130
_FRAME = 0.05  # what the upper axis takes


def png(drawn: "Figure") -> bytes:
    """Return a figure as PNG.

    Parameters
    ----------
    drawn : Figure
        From `figure`.

    Returns
    -------
    bytes
        A whole PNG file.
    """
    out = io.BytesIO()
    drawn.savefig(out, format="png", dpi=_DPI)
    return out.getvalue()


def svg(drawn: "Figure") -> str:
    """Return a figure as SVG, its words as text.

    Parameters
    ----------
    drawn : Figure
        From `figure`.

    Returns
    -------
    str
        A whole SVG file, the same each time.
    """
    import matplotlib

    out = io.StringIO()
    with matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": "curvelight"}):
        drawn.savefig(out, format="svg", metadata={"Date": None, "Creator": None})
    return out.getvalue()


def gid(index: int) -> str:
    """Return the name that a point has in the SVG.

    Parameters
    ----------
    index : int
        Its place among the chart's points.

    Returns
    -------
    str
        The id of its group.
    """
    return f"point-{index}"


def figure(chart: Chart, inks: Inks, *, headed: bool = True) -> "Figure":
    """Draw a chart.

    Parameters
    ----------
    chart : Chart
        Any.
    inks : Inks
        Colours of words, grid and background.
    headed : bool
        Whether the recommendation, the subject and the meaning stand above it.

    Returns
    -------
    Figure
        Of matplotlib; the points are groups named by `gid`.
    """
    from matplotlib.figure import Figure

    drawn = Figure(figsize=(_WIDE, _HIGH), facecolor=inks.paper)
    top = head(drawn, chart, inks) - 0.02 if headed else 0.98
    top -= 0.0 if chart.frame is None else _FRAME
    axes = drawn.add_axes((0.07, 0.10, 0.66, top - 0.10), facecolor=inks.paper)
    _frame(axes, chart, inks)
    styles = styles_of(chart)
    floor = _floor(chart.points)
    for index, point in enumerate(chart.points):
        _draw_point(axes, point, styles[point.name], chart, floor, gid(index))
    _draw_series(axes, chart, styles, floor)
    _limits(axes, chart, floor)
    _draw_front(axes, chart, floor, inks)
    written = _draw_tolerance(axes, chart, inks)
    key(drawn, chart, styles, inks, top)
    place(
        axes,
        [(point.label, *_at(point, chart, floor)) for point in chart.front],
        _marks(chart, floor),
        written,
        bold=chart.advice.point.label if chart.advice.point else "",
        color=inks.text,
        paper=inks.paper,
    )
    return drawn


def _floor(points: Sequence[Point]) -> float:
    """Return where an error of 0 is drawn, which has no logarithm: below all others."""
    positive = [point.error.least for point in points if point.error.least > 0.0]
    return 0.3 * min(positive, default=0.01)


def _at(point: Point, chart: Chart, floor: float) -> tuple[float, float]:
    return 1e6 * point.seconds, chart.measure.factor * max(point.share, floor)


def _marks(chart: Chart, floor: float) -> list[tuple[float, float]]:
    return [_at(point, chart, floor) for point in chart.points]


def _frame(axes: "Axes", chart: Chart, inks: Inks) -> None:
    from matplotlib.ticker import FuncFormatter, NullFormatter

    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(True, which="major", color=inks.faint, linewidth=0.7)
    axes.set_axisbelow(True)
    for side, spine in axes.spines.items():
        spine.set_visible(side in ("left", "bottom"))
        spine.set_color(inks.faint)
    axes.tick_params(which="both", color=inks.faint, labelcolor=inks.text, labelsize=10)
    known = [axes.xaxis, axes.yaxis]
    axes.set_xlabel("time for a vertex, µs", color=inks.text, fontsize=11)
    axes.set_ylabel(chart.measure.heading, color=inks.text, fontsize=11)
    if chart.frame is not None:
        each = 1e-3 * chart.frame

        def milliseconds(us: Any) -> Any:
            return us * each

        def microseconds(ms: Any) -> Any:
            return ms / each

        upper = axes.secondary_xaxis("top", functions=(milliseconds, microseconds))
        upper.set_xlabel(
            f"time for a frame of {chart.frame:,} vertices, ms", color=inks.text, fontsize=11
        )
        upper.spines["top"].set_color(inks.faint)
        upper.tick_params(which="both", color=inks.faint, labelcolor=inks.text, labelsize=10)
        known.append(upper.xaxis)
    for axis in known:
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.6g}"))
        axis.set_minor_formatter(NullFormatter())


def _draw_point(
    axes: "Axes", point: Point, style: tuple[str, str], chart: Chart, floor: float, name: str
) -> None:
    color, marker = style
    x, y = _at(point, chart, floor)
    time, factor = point.time, chart.measure.factor
    low, high = (factor * max(e, floor) for e in (point.error.least, point.error.greatest))
    axes.plot([1e6 * time.least, 1e6 * time.greatest], [y, y], color=color, alpha=0.55, lw=1.2)
    axes.plot([x, x], [low, high], color=color, alpha=0.55, lw=1.2)
    (drawn,) = axes.plot([x], [y], marker=marker, color=color, markersize=6.5, zorder=4)
    drawn.set_gid(name)


def _draw_series(
    axes: "Axes", chart: Chart, styles: dict[str, tuple[str, str]], floor: float
) -> None:
    series: dict[tuple[str, str], list[Point]] = {}
    for point in chart.points:
        series.setdefault((point.name, point.series), []).append(point)
    for (name, which), members in series.items():
        members.sort(key=lambda point: point.order)
        x, y = zip(*(_at(point, chart, floor) for point in members), strict=True)
        dashes: Any = (0, (4, 2)) if which else "solid"
        axes.plot(x, y, color=styles[name][0], linewidth=1.4, alpha=0.8, linestyle=dashes, zorder=3)


def _limits(axes: "Axes", chart: Chart, floor: float) -> None:
    """Leave room around the points for labels."""
    if not chart.points:
        return
    from matplotlib.ticker import LogLocator

    times = [1e6 * one for p in chart.points for one in (p.time.least, p.time.greatest)]
    factor = chart.measure.factor
    errors = [
        factor * max(one, floor) for p in chart.points for one in (p.error.least, p.error.greatest)
    ]
    if chart.tolerance is not None:
        errors.append(factor * chart.tolerance)
    axes.set_xlim(min(times) / 1.8, max(times) * 1.5)
    axes.set_ylim(min(errors) / 2.0, max(errors) * 1.6)
    for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        if high < 300.0 * low:  # powers of ten alone would leave too few numbers
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))


def _draw_front(axes: "Axes", chart: Chart, floor: float, inks: Inks) -> None:
    """Draw what is reached at each time: a stair, for there is nothing between two points."""
    if not chart.front:
        return
    x, y = (
        list(values) for values in zip(*(_at(p, chart, floor) for p in chart.front), strict=True)
    )
    top, right = axes.get_ylim()[1], axes.get_xlim()[1]
    stair_x, stair_y = [x[0], *x, right], [top, *y, y[-1]]
    axes.plot(
        stair_x,
        stair_y,
        drawstyle="steps-post",
        color=inks.text,
        linewidth=1.1,
        alpha=0.6,
        linestyle=(0, (1, 1.5)),
        zorder=2,
    )
    if chart.advice.point is not None:
        at = _at(chart.advice.point, chart, floor)
        axes.plot(
            [at[0]],
            [at[1]],
            marker="o",
            markersize=17,
            color=inks.text,
            zorder=5,
            fillstyle="none",
            markeredgewidth=2.0,
        )


def _draw_tolerance(axes: "Axes", chart: Chart, inks: Inks) -> list[Box]:
    """Draw the line of the tolerance, and return where its words are."""
    if chart.tolerance is None:
        return []
    y = chart.measure.factor * chart.tolerance
    axes.axhline(y, color=inks.text, linewidth=1.0, linestyle="dashed", alpha=0.7)
    words = axes.annotate(
        f"tolerance {chart.measure.said(chart.tolerance)}",
        (1.0, y),
        xycoords=("axes fraction", "data"),
        xytext=(-2, 3),
        textcoords="offset points",
        ha="right",
        color=inks.text,
        fontsize=9.5,
    )

    extent = words.get_window_extent()
    return [(extent.x0, extent.y0, extent.x1, extent.y1)]
