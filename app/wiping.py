"""A surface shown in two ways at once: left of a divider in one, right of it in the other."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from app.ground import Ground

if TYPE_CHECKING:
    from app.render import Box, Image

# Of the picture's height, so that a divider is as visible in a large picture.
_LINE = 1.0 / 450.0


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


def line_color(behind: Ground) -> int:
    """Return the grey of the divider: as of letters, to be seen before the ground.

    Parameters
    ----------
    behind : Ground
        The background.

    Returns
    -------
    int
        0 to 255.
    """
    return round(255.0 * behind.ink)


def composed(
    first: "Image",
    second: "Image",
    wipes: Sequence[tuple["Box", float]],
    behind: Ground,
) -> "Image":
    """Return a picture of two, pixel for pixel.

    Parameters
    ----------
    first, second : ndarray of uint8, shape=(height, width, 3 or 4)
        The whole picture in either way, the first row at the top.
    wipes : sequence of (tuple of 4 ints, float)
        Where wiped surfaces are drawn, and where in them the second begins.
    behind : Ground
        The background.

    Returns
    -------
    ndarray of uint8, shape=(height, width, 3 or 4)
        With the dividers.
    """
    image: NDArray[np.uint8] = first.copy()
    for box, at in wipes:
        left, bottom, width, height = box
        rows = slice(len(image) - bottom - height, len(image) - bottom)
        image[rows, column(box, at) : left + width] = second[rows, column(box, at) : left + width]
        divider = slice(*line(box, at))
        image[rows, divider] = 255
        image[rows, divider, :3] = line_color(behind)
    return image
