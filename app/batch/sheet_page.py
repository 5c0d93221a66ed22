"""The contact sheet as a web page beside the pictures; nothing is loaded from outside."""

from collections.abc import Sequence
from html import escape
from urllib.parse import quote

from app.batch.ledger import Record
from app.batch.sheet import Cell, cells
from app.batch.store import Store

HTML = "index.html"
_STYLE = """
:root { --ink: #1b1f24; --soft: #5c6670; --ground: #ffffff; --raised: #f4f6f8; --bad: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --ink: #dde1e6; --soft: #98a2ad; --ground: #20242a;
  --raised: #282d34; --bad: #ff8a75; } }
body { margin: 0 auto; max-width: 1500px; padding: 24px; background: var(--ground);
  color: var(--ink); font: 14px/1.45 system-ui, "Segoe UI", Roboto, Helvetica, Arial, sans-serif; }
h1 { font-size: 24px; margin: 0; }
header p { color: var(--soft); }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(420px, 1fr)); gap: 12px; }
article { display: grid; grid-template-columns: 190px 1fr; gap: 12px; background: var(--raised);
  border-radius: 8px; padding: 10px; overflow-wrap: anywhere; }
img { width: 190px; height: auto; max-height: 240px; object-fit: contain; }
h2 { font-size: 14px; margin: 0 0 4px; }
p { margin: 0; color: var(--soft); font-size: 12.5px; font-variant-numeric: tabular-nums; }
p.bad { color: var(--bad); }
a { color: inherit; }
@media (max-width: 480px) { main { grid-template-columns: 1fr; } }
"""


def write_html(store: Store, records: Sequence[Record]) -> None:
    """Write the page, whole or not at all.

    Parameters
    ----------
    store : Store
        Where to; holds the pictures.
    records : sequence of dict
        Of the meshes.
    """
    store.write(HTML, page(cells(records)).encode("utf-8", "replace"))


def page(shown: Sequence[Cell]) -> str:
    """Return the page.

    Parameters
    ----------
    shown : sequence of Cell
        The meshes.

    Returns
    -------
    str
        A whole HTML document; pictures are named by relative paths, every text is escaped.
    """
    failed = sum(bool(cell.bad) for cell in shown)
    told = f"{len(shown):,} meshes" + (f", {failed:,} failed" if failed else "")
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta http-equiv="Content-Security-Policy" content="default-src \'none\'; '
        "img-src 'self' file:; style-src 'unsafe-inline'\">\n"
        '<meta name="viewport" content="width=device-width">\n'
        '<meta name="color-scheme" content="light dark">\n'
        f"<title>Curvelight: {told}</title>\n<style>{_STYLE}</style>\n</head>\n<body>\n"
        f"<header><h1>{told}</h1><p>Curvature in mm: 5th percentile, median and 95th over the "
        'vertices of each mesh. <a href="summary.csv">All numbers</a></p></header>\n<main>\n'
        + "\n".join(_article(cell) for cell in shown)
        + "\n</main>\n</body>\n</html>\n"
    )


def _article(cell: Cell) -> str:
    name = escape(cell.name)
    picture = "<span></span>"
    if cell.picture:
        place = escape(quote(cell.picture))
        picture = f'<a href="{place}"><img src="{place}" alt="{name}" loading="lazy"></a>'
    lines = "".join(f"<p>{escape(line)}</p>" for line in cell.lines)
    bad = f'<p class="bad">{escape(cell.bad)}</p>' if cell.bad else ""
    links = " · ".join(f'<a href="{escape(quote(file))}">{escape(file)}</a>' for file in cell.files)
    return f"<article>{picture}<div><h2>{name}</h2>{bad}{lines}<p>{links}</p></div></article>"
