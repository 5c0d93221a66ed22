"""A stability report of shading as one HTML file that needs nothing else."""

from html import escape

import numpy as np

from app.stability_of_shading.looks import OUTLINES, shade, summary
from app.stability_of_shading.report import Outcome, Report
from lutcore.arrays import BoolArray, FloatArray
from lutcore.stability_of_shading.checks import Check
from lutcore.stability_of_shading.maps import BETAS, CURVATURES, REASONS, Region

_CELL = 13  # pixels
_STYLE = """
body { font: 14px/1.45 system-ui, sans-serif; margin: 24px; color: #222; background: #fff; }
h1 { font-size: 22px; margin: 0 0 6px; }
h2 { font-size: 16px; margin: 24px 0 4px; }
p { max-width: 62em; margin: 0 0 12px; }
.models { display: flex; flex-wrap: wrap; gap: 8px 28px; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: 2px 12px 2px 0; border-bottom: 1px solid #ddd; }
td.failed { background: #b8480a; color: #fff; padding-left: 6px; }
text { font-size: 10px; fill: #333; }
path { fill: none; stroke-width: 2.4; }
dl { display: grid; grid-template-columns: max-content auto; gap: 4px 12px; max-width: 70em; }
dt { font-weight: bold; padding-left: 8px; border-left: 6px solid; }
dd { margin: 0; }
"""


def page(report: Report) -> str:
    """Write a report as HTML.

    Parameters
    ----------
    report : Report
        A run.

    Returns
    -------
    str
        A whole page; point at a cell of a map, or at a number, for what is known of it.
    """
    models = "\n".join(_model(one) for one in report.outcomes)
    meanings = "\n".join(
        f'<dt style="border-color: {color}">{escape(name)}</dt><dd>{escape(REASONS[name])}</dd>'
        for name, (color, _) in OUTLINES.items()
    )
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Where shading models fail</title>
<style>{_STYLE}</style>
</head>
<body>
<h1>Where shading models fail</h1>
<p>Balls of curvature k (across, k l_u from {CURVATURES[0]:g} to {CURVATURES[-1]:g}) and of
substances beta = l_u/l_d (up, {BETAS[0]:g} to {BETAS[-1]:g}), eta {report.ground.eta:g}, lit from
one side, against the profile {escape(report.profile)} integrated over the true ball. The darker the
larger the relative L2 error; the tolerance is {100.0 * report.tolerance:g} %. Point at a cell for
its figures. Those that fail least come
first; models that aim at more than the profile are judged by it too.</p>
<dl>
{meanings}
</dl>
<div class="models">
{models}
</div>
<h2>What else was tried</h2>
{_checks(report)}
</body>
</html>
"""


def _model(one: Outcome) -> str:
    wide, high = _CELL * len(CURVATURES), _CELL * len(BETAS)
    cells = "".join(
        _cell(one, row, column) for row in range(len(BETAS)) for column in range(len(CURVATURES))
    )
    outlines = "".join(_path(region) for region in one.regions)
    return (
        f"<section><h2>{escape(one.name)}</h2>\n"
        f'<svg width="{wide + 30}" height="{high + 18}" viewBox="-30 -2 {wide + 32} {high + 20}">'
        f"{cells}{outlines}{_ticks(high)}</svg>\n<p>{escape(summary(one))}</p></section>"
    )


def _path(region: Region) -> str:
    color, line = OUTLINES[region.name]
    dashes = ' stroke-dasharray="5 3"' if line == "dashed" else ""
    return f'<path d="{_outline(region.mask)}" stroke="{color}"{dashes} />'


def _cell(one: Outcome, row: int, column: int) -> str:
    found, at = one.field, (row, column)
    grey = round(255.0 * (1.0 - 0.85 * float(shade(found.error[at]))))
    names = [region.name for region in one.regions if region.mask[at]]
    said = [
        f"k l_u {CURVATURES[column]:.3g}, beta {BETAS[row]:.3g}",
        f"error {100.0 * found.error[at]:.3g} %",
        f"light out over in {found.energy[at]:.3g}",
        f"falls by {found.fall[at]:.2g} R_d while the light rises",
        *names,
    ]
    y = _CELL * (len(BETAS) - 1 - row)
    hint = escape("\n".join(said))
    return (
        f'<rect x="{_CELL * column}" y="{y}" width="{_CELL}" height="{_CELL}" '
        f'fill="rgb({grey},{grey},{grey})"><title>{hint}</title></rect>'
    )


def _outline(mask: BoolArray) -> str:
    """Return the edges between cells inside and outside a region as an SVG path."""
    padded = np.pad(mask[::-1], 1)
    parts = []
    # Between one column and the next an edge is upright, between rows it lies.
    for row, column in np.argwhere(padded[1:-1, 1:] != padded[1:-1, :-1]):
        parts.append(f"M{_CELL * column} {_CELL * row}v{_CELL}")
    for row, column in np.argwhere(padded[1:, 1:-1] != padded[:-1, 1:-1]):
        parts.append(f"M{_CELL * column} {_CELL * row}h{_CELL}")
    return "".join(parts)


def _ticks(high: int) -> str:
    marks = []
    for value in (0.01, 0.1, 1.0):
        x = _CELL * (0.5 + _place(value, CURVATURES))
        y = high - _CELL * (0.5 + _place(value, BETAS))
        marks.append(f'<text x="{x:.1f}" y="{high + 12}" text-anchor="middle">{value:g}</text>')
        marks.append(f'<text x="-4" y="{y + 3:.1f}" text-anchor="end">{value:g}</text>')
    return "".join(marks)


def _place(value: float, axis: FloatArray) -> float:
    return float(np.log(value / axis[0]) / np.log(axis[1] / axis[0]))


def _checks(report: Report) -> str:
    heads = "".join(
        f'<th title="{escape(check.meaning)}">{escape(check.name)}</th>'
        for check in report.outcomes[0].checks
    )
    rows = "".join(
        f"<tr><th>{escape(one.name)}</th>{''.join(map(_value, one.checks))}</tr>\n"
        for one in report.outcomes
    )
    meanings = "".join(
        f"<li>{escape(check.name)}: {escape(check.meaning)}{_limit(check)}</li>\n"
        for check in report.outcomes[0].checks
    )
    return f"<table><tr><th></th>{heads}</tr>\n{rows}</table>\n<ul>\n{meanings}</ul>"


def _value(check: Check) -> str:
    failed = not check.passed and np.isfinite(check.limit)
    kind = ' class="failed"' if failed else ""
    return f'<td{kind} title="{escape(check.meaning)}">{check.value:.3g}</td>'


def _limit(check: Check) -> str:
    return f"; at most {check.limit:g}" if np.isfinite(check.limit) else ""
