"""A surface shown in two ways at once: left of a divider in one, right of it in the other."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from app.render import Box, Image

# Of the picture's height, so that a divider is as visible in a large picture.
_LINE = 1.0 / 450.0
_LIGHT, _DARK = 219, 26


def column(box: "Box", at: float) -> int:
    """Return the first column of pixels that shows the second.

    Parameters
    ----------
    box : tuple of 4 ints
        Where the surface is drawn.
    at : float
        See `app.scene.Wipe`.

    Returns
    -------
    int
        From the window's left edge.
    """
    left, _, width, _ = box
    return left + round(at * width)


def line(box: "Box", at: float) -> tuple[int, int]:
    """Return the columns of pixels that the divider takes.

    Parameters
    ----------
    box : tuple of 4 ints
        Where the surface is drawn.
    at : float
        See `app.scene.Wipe`.

    Returns
    -------
    start, stop : int
        The first column, and the one after the last; none where one way is shown alone.
    """
    left, _, width, height = box
    middle = column(box, at)
    if not 0.0 < at < 1.0:
        return middle, middle
    thick = max(1, round(_LINE * height))
    start = middle - thick // 2
    return max(left, start), min(left + width, start + thick)


def line_color(background: tuple[float, float, float]) -> int:
    """Return the grey of the divider: as of letters, to be seen before the ground.

    Parameters
    ----------
    background : tuple of 3 floats
        Red, green and blue, 0 to 1.

    Returns
    -------
    int
        0 to 255.
    """
    return _LIGHT if sum(background) < 1.5 else _DARK


def composed(
    first: "Image",
    second: "Image",
    wipes: Sequence[tuple["Box", float]],
    background: tuple[float, float, float],
) -> "Image":
    """Return a picture of two, pixel for pixel.

    Parameters
    ----------
    first, second : ndarray of uint8, shape=(height, width, 3)
        The whole picture in either way, the first row at the top.
    wipes : sequence of (tuple of 4 ints, float)
        Where wiped surfaces are drawn, and where in them the second begins.
    background : tuple of 3 floats
        Of the picture.

    Returns
    -------
    ndarray of uint8, shape=(height, width, 3)
        With the dividers.
    """
    image: NDArray[np.uint8] = first.copy()
    for box, at in wipes:
        left, bottom, width, height = box
        rows = slice(len(image) - bottom - height, len(image) - bottom)
        image[rows, column(box, at) : left + width] = second[rows, column(box, at) : left + width]
        image[rows, slice(*line(box, at))] = line_color(background)
    return image
