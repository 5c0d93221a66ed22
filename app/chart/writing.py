"""A chart as the content of a file, by the ending of its name."""

import json
from collections.abc import Sequence

from app.chart.captions import Inks
from app.chart.data import as_csv, plain
from app.chart.drawing import figure, png, svg
from app.chart.page import Section, page
from app.chart.points import Chart
from lutcore.errors import ParameterError

SUFFIXES = (".png", ".svg", ".csv", ".json", ".html")


def content(chart: Chart, suffix: str, sections: Sequence[Section] = ()) -> bytes:
    """Return what a file shall hold.

    Parameters
    ----------
    chart : Chart
        Any.
    suffix : str
        One of `SUFFIXES`.
    sections : sequence of Section
        What stands below it in .html.

    Returns
    -------
    bytes
        All of it.

    Raises
    ------
    ParameterError
        If the ending is another.
    """
    if suffix == ".png":
        return png(figure(chart, Inks()))
    makers = {
        ".svg": lambda: svg(figure(chart, Inks())),
        ".csv": lambda: as_csv(chart),
        ".json": lambda: json.dumps(plain(chart), indent=2, allow_nan=False) + "\n",
        ".html": lambda: page(chart, sections),
    }
    if suffix not in makers:
        raise ParameterError.unknown("output format", suffix, SUFFIXES)
    return makers[suffix]().encode()
