"""A stability report as one HTML file that needs nothing else."""

from base64 import b64encode
from html import escape

from app.stability import Outcome, Report
from app.stability_look import LOOKS, growth, number, sentence
from app.stability_thumbnail import png, thumbnails
from lutcore.gallery.case import Case
from lutcore.gallery.judgement import REASONS, Verdict

_THUMB = 112

_STYLE = """
body { font: 14px/1.4 system-ui, sans-serif; margin: 24px; color: #222; background: #fff; }
h1 { font-size: 22px; margin: 0 0 6px; }
p { max-width: 60em; margin: 0 0 12px; }
table { border-collapse: separate; border-spacing: 2px; }
thead { position: sticky; top: 0; background: #fff; }
thead th { vertical-align: bottom; }
thead th.method div { writing-mode: vertical-rl; transform: rotate(180deg); padding: 6px 0;
  margin: 0 auto; }
tbody th { text-align: left; font-weight: normal; max-width: 23em; padding-right: 10px; }
tbody th b { display: block; }
tbody th small { color: #555; }
td { min-width: 54px; text-align: center; padding: 4px; cursor: help; }
td small { display: block; }
img { display: block; }
dl { display: grid; grid-template-columns: max-content auto; gap: 4px 12px; max-width: 70em; }
dt { padding: 1px 8px; font-weight: bold; border: 1px solid #999; }
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
        A whole page; pictures, style and messages are in it.
    """
    heads = "".join(
        f'<th scope="col" class="method"><div>{escape(one)}</div></th>' for one in report.methods
    )
    total = len(report.cases)
    survived = "".join(
        f"<th>{report.count(one)[Verdict.SURVIVES]}/{total}</th>" for one in report.methods
    )
    rows = "\n".join(_row(report, case) for case in report.cases)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Curvature estimators on broken meshes</title>
<style>{_STYLE}</style>
</head>
<body>
<h1>Curvature estimators on broken meshes</h1>
<p>Upper number: RMS error over RMS curvature, at the vertices that the defect can harm. Lower
number: times the error without the defect. Point at a cell for the rest. Those that survive most
come first. Seed {report.seed}, at most {report.limit:g} s a call.</p>
<table>
<thead><tr><th></th><th></th>{heads}</tr>
<tr><th></th><th style="text-align: left">survived</th>{survived}</tr></thead>
<tbody>
{rows}
</tbody>
</table>
<h2>What the verdicts mean</h2>
<dl>
{_legend()}
</dl>
</body>
</html>
"""


def _row(report: Report, case: Case) -> str:
    data = b64encode(png(thumbnails(case, _THUMB))).decode("ascii")
    cells = "".join(_cell(report.outcomes[case.name, one]) for one in report.methods)
    return (
        f'<tr><td><img src="data:image/png;base64,{data}" width="{_THUMB}" '
        f'height="{_THUMB // 2}" alt=""></td>'
        f'<th scope="row"><b>{escape(case.title)}</b><small>{escape(case.why)}</small></th>'
        f"{cells}</tr>"
    )


def _cell(outcome: Outcome) -> str:
    look = LOOKS[outcome.verdict]
    if outcome.score is None:
        text = f"{look.mark}<small>{outcome.verdict}</small>"
    else:
        text = f"{look.mark}&nbsp;{escape(number(outcome.score.error))}"
        text += f"<small>{escape(growth(outcome))}</small>"
    return (
        f'<td style="background: {look.fill}; color: {look.text}" '
        f'title="{escape(sentence(outcome))}">{text}</td>'
    )


def _legend() -> str:
    return "\n".join(
        f'<dt style="background: {look.fill}; color: {look.text}">{look.mark} {verdict}</dt>'
        f"<dd>{escape(REASONS[verdict])}</dd>"
        for verdict, look in LOOKS.items()
    )
