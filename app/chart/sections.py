"""What stands beside the chart of shading models: how far they hold, and how they look."""

import json
from base64 import b64encode

import numpy as np
from numpy.typing import NDArray

from app.chart import ranges
from app.chart.captions import Inks
from app.chart.drawing import png, svg
from app.chart.page import THEMED, Section, inline
from app.chart.ranges import Ranges
from app.chart.strip import REFERENCE
from app.chart.strip import png as strip_png
from lutcore.errors import ParameterError


def range_content(found: Ranges, suffix: str) -> bytes:
    """Return what a file of the ranges shall hold.

    Parameters
    ----------
    found : Ranges
        Any.
    suffix : str
        .png, .svg, .csv or .json.

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
        return png(ranges.figure(found, Inks()))
    makers = {
        ".svg": lambda: svg(ranges.figure(found, Inks())),
        ".csv": lambda: ranges.as_csv(found),
        ".json": lambda: json.dumps(ranges.plain(found), indent=2, allow_nan=False) + "\n",
    }
    if suffix not in makers:
        raise ParameterError.unknown("output format", suffix, (".png", *makers))
    return makers[suffix]().encode()


def range_section(found: Ranges) -> Section:
    """Return the ranges as a part of a page.

    Parameters
    ----------
    found : Ranges
        Any.

    Returns
    -------
    Section
        With the picture.
    """
    body = inline(ranges.figure(found, THEMED, headed=False))
    return Section(f"Error on {found.subject}", found.meaning, body)


def strip_section(image: NDArray[np.uint8]) -> Section:
    """Return the pictures of the models as a part of a page.

    Parameters
    ----------
    image : ndarray of uint8, shape=(height, width, 3)
        From `app.chart.strip.strip`.

    Returns
    -------
    Section
        With the picture in it.
    """
    data = b64encode(strip_png(image)).decode("ascii")
    words = f"{REFERENCE} is the reference; below each model its CIEDE2000 from there."
    return Section(
        "How they look", words, f'<img src="data:image/png;base64,{data}" alt="{words}">'
    )
