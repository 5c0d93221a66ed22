"""Labels beside points, so placed that they cover neither points nor each other."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.transforms import BboxBase

Box = tuple[float, float, float, float]
# Where the label's nearest corner or side lies, in points from the mark; near places first.
_PLACES = [
    (dx * far, dy * far, across, along)
    for far in (10, 22, 38, 58, 82, 110, 145)
    for dx, dy, across, along in (
        (-0.7, -0.7, "right", "top"),
        (0.7, 0.7, "left", "bottom"),
        (1.0, 0.0, "left", "center"),
        (0.0, -1.0, "center", "top"),
        (-1.0, 0.0, "right", "center"),
        (0.0, 1.0, "center", "bottom"),
        (0.7, -0.7, "left", "top"),
        (-0.7, 0.7, "right", "bottom"),
        (0.3, -1.0, "left", "top"),
        (-0.3, 1.0, "right", "bottom"),
        (-0.3, -1.0, "right", "top"),
        (0.3, 1.0, "left", "bottom"),
    )
]
_FAR = 20.0  # a line leads from labels farther than this to their points
_RING = 11.0
_MARK = 7.0  # half the size of a point with room around it, in points


def place(
    axes: "Axes",
    labels: Sequence[tuple[str, float, float]],
    marks: Sequence[tuple[float, float]],
    written: Sequence[Box] = (),
    *,
    bold: str,
    color: str,
    paper: str,
) -> list[Box]:
    """Write labels where there is room.

    Parameters
    ----------
    axes : Axes
        Of matplotlib, its limits set.
    labels : sequence of (str, float, float)
        Words and the point they belong to, in the axes' units.
    marks : sequence of (float, float)
        All points, none of which may be covered.
    written : sequence of tuple of float
        Boxes in pixels that hold words already.
    bold : str
        The label that stands out.
    color, paper : str
        Of words and background.

    Returns
    -------
    list of tuple of float
        The boxes of the labels in pixels: left, bottom, right, top. One for which there is no
        room is left out.
    """
    pixel = axes.figure.dpi / 72.0
    half = _MARK * pixel
    taken: list[Box] = list(written)
    for x, y in axes.transData.transform(list(marks)) if marks else []:
        taken.append((x - half, y - half, x + half, y + half))
    frame = axes.get_window_extent()
    boxes = []
    # The one that matters chooses its place first.
    for words, x, y in sorted(labels, key=lambda label: label[0] != bold):
        look = {
            "textcoords": "offset points",
            "fontsize": 10.5 if words == bold else 9.5,
            "weight": "bold" if words == bold else "normal",
            "color": color,
            "parse_math": False,
            "zorder": 6,
            "bbox": {"facecolor": paper, "edgecolor": "none", "alpha": 0.75, "pad": 0.8},
        }
        for dx, dy, across, along in _PLACES:
            at: dict[str, Any] = {"xytext": (dx, dy), "ha": across, "va": along, **look}
            text = axes.annotate(words, (x, y), **at)
            extent = text.get_window_extent()
            box = (extent.x0, extent.y0, extent.x1, extent.y1)
            if _within(box, frame) and not any(overlap(box, other) for other in taken):
                if max(abs(dx), abs(dy)) > _FAR:
                    text.remove()  # only now, for the extent would hold the line
                    line = {"arrowstyle": "-", "color": color, "alpha": 0.5, "lw": 0.7}
                    axes.annotate(words, (x, y), arrowprops=line, **at)
                taken.append(box)
                boxes.append(box)
                if words == bold:  # its point wears a ring, which others must not cover
                    px, py = axes.transData.transform((x, y))
                    wide = _RING * pixel
                    taken.append((px - wide, py - wide, px + wide, py + wide))
                break
            text.remove()
    return boxes


def _within(box: Box, frame: "BboxBase") -> bool:
    left, bottom, right, top = box
    return frame.x0 <= left and right <= frame.x1 and frame.y0 <= bottom and top <= frame.y1


def overlap(one: Box, other: Box) -> bool:
    """Return whether two boxes cover each other.

    Parameters
    ----------
    one, other : tuple of float
        Left, bottom, right, top.

    Returns
    -------
    bool
        Whether they share more than an edge.
    """
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]
