"""The histograms of a report, as one SVG that takes its colour from the page around it."""

import io
from typing import Any

import numpy as np

from app.quantities import QUANTITIES
from lutcore.arrays import FloatArray
from lutcore.statistics import Histogram

_COLUMNS = (4, 5)
_WIDTH, _ROW_HEIGHT = 11.0, 1.75  # inches
# Stands for the page's text colour until the SVG is written; drawn nowhere else.
_INK = "#010203"
_STYLE: Any = {
    "svg.fonttype": "none",
    "svg.hashsalt": "curvelight",
    "font.family": "sans-serif",
    "font.size": 9.0,
    "text.color": _INK,
    "axes.edgecolor": _INK,
    "axes.labelcolor": _INK,
    "xtick.color": _INK,
    "ytick.color": _INK,
}


def svg(histograms: dict[str, Histogram], colors: FloatArray) -> str:
    """Draw histograms, each bar in the colour that its values have in the picture.

    Parameters
    ----------
    histograms : dict of str to Histogram
        By quantity, see `app.quantities.QUANTITIES`.
    colors : ndarray, shape=(m, 3)
        The colour map, sRGB-encoded, 0 to 1.

    Returns
    -------
    str
        An ``<svg>`` element for the inside of a page.
    """
    import matplotlib
    from matplotlib.figure import Figure

    # Full rows where there are some.
    columns = next((count for count in _COLUMNS if len(histograms) % count == 0), _COLUMNS[-1])
    rows = -(-len(histograms) // columns)
    with matplotlib.rc_context(_STYLE):
        figure = Figure(figsize=(_WIDTH, _ROW_HEIGHT * rows), layout="constrained")
        axes = figure.subplots(rows, columns, squeeze=False).ravel()
        for ax, (name, counted) in zip(axes, histograms.items(), strict=False):
            whole = max(1, int(counted.counts.sum()) + counted.below + counted.above)
            at = np.linspace(0, len(colors) - 1, len(counted.counts)).round().astype(int)
            ax.bar(
                counted.edges[:-1],
                100.0 * counted.counts / whole,
                width=np.diff(counted.edges),
                align="edge",
                color=colors[at],
            )
            ax.set_title(QUANTITIES[name].heading, fontsize=9.0)
            ax.set_xlim(counted.edges[0], counted.edges[-1])
            ax.spines[["top", "right"]].set_visible(False)
            ax.locator_params(axis="x", nbins=4)
            ax.locator_params(axis="y", nbins=3)
            ax.ticklabel_format(axis="x", scilimits=(-3, 4), useOffset=False)
        for ax in axes[len(histograms) :]:
            ax.set_visible(False)
        for ax in axes[::columns]:
            ax.set_ylabel("% of vertices")
        page = io.StringIO()
        nothing = dict.fromkeys(("Creator", "Date", "Format", "Type"))
        figure.savefig(page, format="svg", transparent=True, metadata=nothing)
    text = page.getvalue().replace(_INK, "currentColor")
    return text[text.index("<svg") :]
