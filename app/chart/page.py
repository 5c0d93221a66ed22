"""A chart as one page of HTML that needs nothing else: picture with hints, table, the missing."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

from app.chart.captions import Inks
from app.chart.data import gathered, rows
from app.chart.drawing import figure, gid, svg
from app.chart.measure import microseconds
from app.chart.points import Chart, Point

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Colours that nothing else in the picture has, so that they can be told and follow the theme.
_TEXT, _FAINT, _PAPER = "#010203", "#040506", "#070809"
THEMED = Inks(_TEXT, _FAINT, _PAPER)
"""Colours that follow the page's theme."""
_STYLE = """
:root { color-scheme: light dark; --text: #1d2126; --faint: #c9ced4; --paper: #ffffff; }
@media (prefers-color-scheme: dark) {
  :root { --text: #e4e7eb; --faint: #3d444d; --paper: #16191d; }
}
body { font: 15px/1.5 system-ui, sans-serif; color: var(--text); background: var(--paper);
  max-width: 1200px; margin: 1.5rem auto; padding: 0 1rem; }
h1 { font-size: 1.25rem; }
svg, img { width: 100%; height: auto; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .15rem .9rem .15rem 0; border-bottom: 1px solid var(--faint); }
td.number { text-align: right; white-space: nowrap; }
tr.recommended { font-weight: bold; }
"""


@dataclass(frozen=True)
class Section:
    """What stands below a chart on its page.

    Parameters
    ----------
    title, words : str
        Shown, not obeyed, whatever they hold.
    body : str
        HTML.
    """

    title: str
    words: str
    body: str


def page(chart: Chart, sections: Sequence[Section] = ()) -> str:
    """Return a chart as HTML.

    Parameters
    ----------
    chart : Chart
        Any; whatever its texts hold is shown, not obeyed.
    sections : sequence of Section
        What else belongs to it.

    Returns
    -------
    str
        A whole file, for light and for dark screens.
    """
    machine = ", ".join(f"{key} {value}" for key, value in chart.machine.items())
    absent = "".join(
        f"<li>{escape(who)}: {escape(reason)}</li>\n" for who, reason in gathered(chart.missing)
    )
    below = "".join(
        f"<h2>{escape(one.title)}</h2>\n<p>{escape(one.words)}</p>\n{one.body}\n"
        for one in sections
    )
    without = f"<h2>Without figures</h2>\n<ul>\n{absent}</ul>\n" if absent else ""
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        "<title>Speed against accuracy</title>\n"
        f"<style>{_STYLE}</style>\n</head>\n<body>\n"
        f"<h1>{escape(chart.advice.sentence)}</h1>\n"
        f"<p>{escape(chart.subject)}</p>\n"
        f"{_picture(chart)}\n"
        f"<p>{escape(' '.join(chart.meaning))}</p>\n"
        f'<div class="wide">\n{_table(chart)}</div>\n{without}{below}'
        f"<p>Measured with {escape(machine)}.</p>\n</body>\n</html>\n"
    )


def _picture(chart: Chart) -> str:
    drawn = inline(figure(chart, THEMED, headed=False))
    for index, point in enumerate(chart.points):
        group = f'<g id="{gid(index)}">'
        hint = escape(_hint(point, chart))
        drawn = drawn.replace(group, f"{group}<title>{hint}</title>", 1)
    return drawn


def inline(drawn: "Figure") -> str:
    """Return a figure as SVG that stands in a page, as wide as it and in its colours.

    Parameters
    ----------
    drawn : Figure
        Of matplotlib, drawn with `THEMED`.

    Returns
    -------
    str
        An svg element.
    """
    text = svg(drawn)
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    text = re.sub(r'(<svg[^>]*?) width="[^"]*"', r"\1", text, count=1)
    text = re.sub(r'(<svg[^>]*?) height="[^"]*"', r"\1", text, count=1)
    for color, name in ((_TEXT, "text"), (_FAINT, "faint"), (_PAPER, "paper")):
        text = text.replace(color, f"var(--{name})")
    return text


def _hint(point: Point, chart: Chart) -> str:
    """Return what is shown while the pointer rests on a point."""
    time, error, said = point.time, point.error, chart.measure.said
    lines = [
        point.label,
        f"{chart.measure.title} {said(point.share)} "
        f"({said(error.least)} to {said(error.greatest)})",
        f"{microseconds(time.least)} µs a vertex "
        f"(median {microseconds(time.middle)}, greatest {microseconds(time.greatest)})",
    ]
    lines += [f"{name}: {value:.3g}" for name, value in point.details.items()]
    return "\n".join(lines)


def _table(chart: Chart) -> str:
    heading, *body = rows(chart)
    lines = ["<tr>", *(f"<th>{escape(cell)}</th>" for cell in heading), "</tr>\n"]
    for row in body:
        kind = ' class="recommended"' if row[-1] == "recommended" else ""
        lines.append(f"<tr{kind}>")
        for cell in row:
            right = ' class="number"' if cell[:1].isdigit() else ""
            lines.append(f"<td{right}>{escape(cell)}</td>")
        lines.append("</tr>\n")
    return f"<table>\n{''.join(lines)}</table>\n"
