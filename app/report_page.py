"""The HTML of a report: nothing from outside, every text escaped."""

from html import escape
from pathlib import PurePath

import numpy as np

from app.quantities import QUANTITIES
from app.report import Content, Views, data_uri
from app.report_style import STYLE
from lutcore.statistics import PERCENTILES

_GROUPS = {
    "interior": "away from borders",
    "border": "within one scale of a border",
    "debris": "in parts far smaller than the largest",
}
_ONE_RING = ("one-ring", "no length to average over")


def page(content: Content) -> str:
    """Return the page.

    Parameters
    ----------
    content : Content
        What it shows.

    Returns
    -------
    str
        A whole HTML document that refers to nothing outside.
    """
    name = escape(PurePath(content.mesh).name)
    sections = (
        _head(content, name),
        _tiles(content),
        _picture(content.quantities, "every quantity on the surface, one camera"),
        _how_to_read(content),
        f'<section><h2>Histograms</h2><div class="histograms">{content.histograms}</div>'
        "<p>Over the ranges and in the colours of the pictures; vertices without an estimate are "
        "left out.</p></section>",
        _percentiles(content),
        _disagreement(content),
        _remarks(content),
        _origin(content),
    )
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta http-equiv="Content-Security-Policy" content="default-src \'none\'; '
        "img-src data:; style-src 'unsafe-inline'\">\n"
        '<meta name="viewport" content="width=device-width">\n'
        '<meta name="color-scheme" content="light dark">\n'
        f"<title>Curvature of {name}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n"
        + "\n".join(section for section in sections if section)
        + "\n</body>\n</html>\n"
    )


def _head(content: Content, name: str) -> str:
    taken = " (assumed)" if content.assumed else ""
    return (
        f"<header><h1>Curvature of {name}</h1><p>{content.vertices:,} vertices, "
        f"{content.faces:,} triangles, diagonal {content.diagonal:.4g} mm; 1 mesh unit is "
        f"{content.mm_per_unit:g} mm{taken}</p></header>"
    )


def _tiles(content: Content) -> str:
    found = content.found
    group = next(iter(found.statistics))
    middle = {name: _mm(content, name, shares["p50"]) for name, shares in _of(content, group)}
    low, high = (_mm(content, "scale", found.statistics[group]["scale"][p]) for p in ("p5", "p95"))
    if low == high:
        scale = (f"{low} mm", "length averaged over") if content.found.scale else _ONE_RING
    else:
        scale = (f"{low} to {high} mm", f"length averaged over (median {middle['scale']} mm)")
    tiles = (
        (
            f"{middle['curvedness']} ± {middle['error']}",
            f"1/mm, median curvedness and error bar, {group}",
        ),
        scale,
        (f"{found.judged.below_error:.1%}", "of the vertices have |k| below its error"),
        (f"{found.judged.gauss_bonnet_residual:.2%}", "Gauss-Bonnet residual"),
    )
    cells = "".join(
        f"<div><b>{escape(value)}</b><span>{escape(what)}</span></div>" for value, what in tiles
    )
    return f'<section class="tiles">{cells}</section>'


def _how_to_read(content: Content) -> str:
    judged = content.found.judged
    summary = escape(content.summary)
    return (
        f"<p>Method <b>{escape(content.found.method)}</b>: {summary} Positive is convex, "
        "k1 ≥ k2. The error bar is one sigma of k1 and of k2 as the estimator itself tells it: of "
        "normal errors two in three stay within it. Gauss and Bonnet: k1 k2 integrates "
        f"to {judged.total_curvature:.4g} over the interior, where the angles of the triangles "
        f"say {judged.angle_defect:.4g}; the residual is relative to the integral of |k1 k2|.</p>"
    )


def _disagreement(content: Content) -> str:
    found = content.found
    if content.disagreement is None or found.beyond_error is None:
        return ""
    rows = "".join(
        f"<tr><th>{escape(name)}</th><td>{_mm(content, 'disagreement', value)}</td></tr>"
        for name, value in found.distances.items()
    )
    left_out = "".join(
        f"<li>{escape(name)}: {escape(reason)}</li>" for name, reason in found.refused.items()
    )
    refused = f"<p>Left out:</p><ul>{left_out}</ul>" if left_out else ""
    return (
        '<section><h2>Where estimators disagree</h2><div class="beside">'
        + _picture(content.disagreement, "disagreement of the estimators on the surface")
        + "<div><p>At each vertex, the median absolute deviation of k1 and k2 among "
        f"{len(found.distances)} estimators, as one sigma. It exceeds twice the error bar of "
        f"{escape(found.method)} at <b>{found.beyond_error:.1%}</b> of the vertices.</p>"
        "<table><thead><tr><th>estimator</th><th>median distance from the median, 1/mm</th></tr>"
        f"</thead><tbody>{rows}</tbody></table>{refused}</div></div></section>"
    )


def _percentiles(content: Content) -> str:
    heading = "".join(f"<th>{share} %</th>" for share in PERCENTILES)
    bodies = []
    for group in content.found.statistics:
        count = int(np.count_nonzero(getattr(content.found.judged, group)))
        rows = "".join(
            f"<tr><th>{escape(QUANTITIES[name].heading)}</th>"
            + "".join(f"<td>{_mm(content, name, value)}</td>" for value in shares.values())
            + "</tr>"
            for name, shares in _of(content, group)
        )
        bodies.append(
            f'<tbody><tr class="group"><th colspan="{len(PERCENTILES) + 1}">{group}: {count:,} '
            f"vertices {_GROUPS[group]}</th></tr>{rows}</tbody>"
        )
    return (
        '<section><h2>Percentiles</h2><table class="numbers"><thead><tr><th></th>'
        f"{heading}</tr></thead>{''.join(bodies)}</table></section>"
    )


def _remarks(content: Content) -> str:
    missing = content.found.not_estimated
    remarks = [*content.remarks]
    if missing:
        remarks.append(f"vertices without an estimate: {missing:,}")
    if content.assumed:
        remarks.append("nobody said how big a mesh unit is; it is taken as 1 mm")
    items = "".join(f"<li>{escape(remark)}</li>" for remark in remarks)
    body = f"<ul>{items}</ul>" if items else "<p>Nothing odd about the mesh was found.</p>"
    return f"<section><h2>Remarks on the mesh</h2>{body}</section>"


def _origin(content: Content) -> str:
    versions = ", ".join(f"{name} {number}" for name, number in content.versions.items())
    return (
        f"<footer><p>{escape(content.mesh)}<br>SHA-256 <code>{content.digest}</code></p>"
        f"<p>Made again by</p><pre>{escape(content.command)}</pre>"
        f"<p>{escape(versions)}</p></footer>"
    )


def _picture(views: Views, what: str) -> str:
    if views.light == views.dark:
        return f'<figure><img src="{data_uri(views.light)}" alt="{what}"></figure>'
    images = "".join(
        f'<img class="{name}" src="{data_uri(png)}" alt="{what}">'
        for name, png in (("light", views.light), ("dark", views.dark))
    )
    return f"<figure>{images}</figure>"


def _of(content: Content, group: str) -> list[tuple[str, dict[str, float | None]]]:
    return list(content.found.statistics[group].items())


def _mm(content: Content, name: str, value: float | None) -> str:
    """Return a number in mesh units as text in millimetres."""
    if value is None:
        return "-"
    return f"{value / content.mm_per_unit ** QUANTITIES[name].power:.3g}"
