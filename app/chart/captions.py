"""What stands around a chart: the recommendation above it, and who is who beside it."""

import textwrap
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from app.chart.data import gathered
from app.chart.points import Chart

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Okabe and Ito's colours, which the colour-blind can tell apart, less yellow and black, which one
# of the two backgrounds swallows; then others between them. The marker tells apart what is close.
_COLORS = (
    *("#e69f00", "#0072b2", "#009e73", "#d55e00", "#56b4e9", "#cc79a7", "#808080"),
    *("#7b5cd6", "#a87415", "#2aa7a7", "#c0397b", "#9a9a00", "#6b7fa8", "#6a9c3f"),
    *("#e58a7b", "#b05fc4"),
)
_MARKERS = "osD^vPX<>"
_MAKERS = ("curvelight", "Python")
# Reasons are whole in the table, the CSV and the JSON.
_LONGEST_REASON, _MOST_REASONS = 90, 7


@dataclass(frozen=True)
class Inks:
    """Colours of what is neither point nor line.

    Parameters
    ----------
    text, faint, paper : str
        Of words and the front, of the grid, of the background.
    """

    text: str = "#1d2126"
    faint: str = "#c9ced4"
    paper: str = "#ffffff"


def styles_of(chart: Chart) -> dict[str, tuple[str, str]]:
    """Return how each name is drawn.

    Parameters
    ----------
    chart : Chart
        Any.

    Returns
    -------
    dict of str to tuple of str
        Colour and marker; charts of the same names draw them alike.
    """
    return styles({p.name for p in chart.points} | {one.name for one in chart.missing})


def styles(names: Iterable[str]) -> dict[str, tuple[str, str]]:
    """Return how names are drawn.

    Parameters
    ----------
    names : iterable of str
        All that are drawn.

    Returns
    -------
    dict of str to tuple of str
        Colour and marker; the same names are drawn alike.
    """
    return {
        name: (_COLORS[at % len(_COLORS)], _MARKERS[at % len(_MARKERS)])
        for at, name in enumerate(sorted(names))
    }


def head(drawn: "Figure", chart: Chart, inks: Inks) -> float:
    """Write the recommendation, the subject and the meaning.

    Parameters
    ----------
    drawn : Figure
        Where to.
    chart : Chart
        What is said.
    inks : Inks
        Colours.

    Returns
    -------
    float
        How far down they reach, as a share of the figure's height from below.
    """
    machine = chart.machine
    made = f"{machine['cores']} cores, {machine['system']}"
    made += "".join(f", {name} {machine[name]}" for name in _MAKERS if name in machine)
    top = 0.975
    for words, columns, points, weight in (
        (chart.advice.sentence, 105, 13.5, "bold"),
        (f"{chart.subject}; {made}", 140, 10.5, "normal"),
        (" ".join(chart.meaning), 175, 8.5, "normal"),
    ):
        # A number and its per cent sign stay in one line.
        lines = textwrap.wrap(words.replace(" %", "\N{NO-BREAK SPACE}%"), columns)
        drawn.text(
            0.03,
            top,
            "\n".join(lines),
            fontsize=points,
            weight=weight,
            va="top",
            color=inks.text,
            linespacing=1.3,
            parse_math=False,
        )
        top -= (1.45 * len(lines) + 0.5) * points / (72.0 * drawn.get_figheight())
    return top


def key(
    drawn: "Figure", chart: Chart, styles: dict[str, tuple[str, str]], inks: Inks, top: float
) -> None:
    """List who is who, most accurate first, and who is missing and why.

    Parameters
    ----------
    drawn : Figure
        Where to.
    chart : Chart
        What is said.
    styles : dict of str to tuple of str
        From `styles_of`.
    inks : Inks
        Colours.
    top : float
        Where the list begins, as a share of the figure's height from below.
    """
    from matplotlib.lines import Line2D

    least: dict[str, float] = {}
    for point in chart.points:
        least[point.name] = min(point.share, least.get(point.name, point.share))
    names = sorted(least, key=lambda name: least[name])
    handles = [
        Line2D([], [], color=styles[name][0], marker=styles[name][1], markersize=6.5, lw=1.4)
        for name in names
    ]
    words = [f"{name}  {chart.measure.said(least[name])}" for name in names]
    handles.append(Line2D([], [], color=inks.text, alpha=0.6, lw=1.1, linestyle=(0, (1, 1.5))))
    words.append("front: nothing is faster and as good")
    box = drawn.legend(
        handles,
        words,
        loc="upper left",
        bbox_to_anchor=(0.745, top + 0.015),
        frameon=False,
        fontsize=9.5,
        labelcolor=inks.text,
        title=f"least {chart.measure.title} of each",
        alignment="left",
    )
    box.get_title().set_color(inks.text)
    for one in box.get_texts():
        one.set_parse_math(False)
    lines = []
    absent = gathered(chart.missing)
    for who, reason in absent[:_MOST_REASONS]:
        lines += textwrap.wrap(f"{who}: {textwrap.shorten(reason, _LONGEST_REASON)}", 46)
    if len(absent) > _MOST_REASONS:
        lines.append(f"and {len(absent) - _MOST_REASONS} more, see the table")
    if lines:
        drawn.text(
            0.755,
            0.025,
            "\n".join(["without figures:", *lines]),
            fontsize=8.5,
            va="bottom",
            color=inks.text,
            alpha=0.85,
            parse_math=False,
        )
