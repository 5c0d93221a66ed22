"""Compared surfaces on their way to a picture: how far apart they are, and where each is put."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.colormaps import table
from app.contestants import below, has_bar, labels, tiles
from app.differences import Difference, difference_of
from app.quantities import QUANTITIES
from app.render import Panel
from app.scene import ColorScale, Surface, Wipe
from app.session import Camera, Session
from lutcore.arrays import BoolArray, FloatArray

_MAP = "magma"
CIEDE2000, DIFFERENCE = "ciede2000", "difference"
"""What the range of a difference is called in `Picture.ranges`: of colours, or of a quantity."""


@dataclass(frozen=True, eq=False)
class Single:
    """One of the compared, in its colours.

    Parameters
    ----------
    surface : Surface
        As in its own picture.
    counted : ndarray of bool, shape=(n,)
        Which vertices have a say in differences.
    """

    surface: Surface
    counted: BoolArray


@dataclass(frozen=True, eq=False)
class Place:
    """What all panels of a comparison share.

    Parameters
    ----------
    camera : Camera
        Of every surface.
    width : float
        Of a surface, as a share of the picture's.
    bar : float
        Of a colour bar.
    """

    camera: Camera
    width: float
    bar: float


@dataclass(frozen=True, eq=False)
class Comparison:
    """The panels of a comparison, and what is said of them.

    Parameters
    ----------
    panels : tuple of Panel
        From left to right, and row by row from the top.
    difference : dict of str to Difference, or None
        By what is compared with the first, where it was asked for.
    ranges : dict of str to tuple of 2 floats
        Ends of the differences' colour bar.
    """

    panels: tuple[Panel, ...]
    difference: dict[str, Difference] | None
    ranges: dict[str, tuple[float, float]]


def compared(session: Session, singles: Sequence[Single], place: Place) -> Comparison:
    """Return the panels that compare surfaces.

    Parameters
    ----------
    session : Session
        A comparison.
    singles : sequence of Single
        In the order of `Session.compared`.
    place : Place
        Where they go.

    Returns
    -------
    Comparison
        A panel for each, or one for both where they are wiped, then the differences.
    """
    surfaces = [one.surface for one in singles]
    if session.wipe is not None:
        surfaces = [_wiped(surfaces, session.wipe)]
    panels = [Panel(one, place.width, place.camera) for one in surfaces]
    if has_bar(session):
        scale = singles[0].surface.scale
        assert scale is not None
        columns, rows = tiles(session)
        bar = Panel(scale, place.bar, tall=rows > 1)
        panels.insert(len(panels) if rows == 1 else columns, bar)
    if not session.difference:
        return Comparison(tuple(panels), None, {})
    values = [_apart(session, singles[0], one) for one in singles[1:]]
    counted = [singles[0].counted & one.counted for one in singles[1:]]
    mesh = singles[0].surface.mesh
    found = {
        label: difference_of(one, mesh, which)
        for label, one, which in zip(labels(session)[1:], values, counted, strict=True)
    }
    scale = _scale(session, max(one["p99"] for one in found.values()))
    first, *others = session.compared
    maps = [
        Panel(
            Surface(
                mesh,
                singles[0].surface.normals,
                values=one,
                scale=scale,
                caption=f"{other.name} against {first.name}",
            ),
            place.width,
            place.camera,
        )
        for one, other in zip(values, others, strict=True)
    ]
    bar = Panel(scale, place.width if below(session) else place.bar)
    panels += [bar, *maps] if below(session) else [*maps, bar]
    name = DIFFERENCE if session.compared_by == "estimator" else CIEDE2000
    return Comparison(tuple(panels), found, {name: (scale.low, scale.high)})


def _wiped(surfaces: Sequence[Surface], at: float) -> Surface:
    first, second = surfaces
    caption = f"{first.caption}  |  {second.caption}"
    return replace(first, wipe=Wipe(replace(second, caption=caption), at), caption=caption)


def _apart(session: Session, first: Single, other: Single) -> FloatArray:
    one, two = first.surface, other.surface
    if session.compared_by == "estimator":
        assert one.values is not None
        assert two.values is not None
        return np.abs(two.values - one.values)
    from lutcore.metrics import ciede2000

    assert one.rgb is not None
    assert two.rgb is not None
    return ciede2000(one.rgb, two.rgb)


def _scale(session: Session, most: float) -> ColorScale:
    if session.compared_by == "estimator":
        # The session's map and range are those of the quantity itself.
        quantity = QUANTITIES[session.quantity]
        # Below, a bar is wide and low; beside, narrow and high.
        gap = ", " if below(session) else "\n"
        unit = f"{gap}{quantity.printed_unit}" if quantity.power else ""
        return ColorScale(table(_MAP), 0.0, most or 1.0, f"difference{unit}")
    # A CIEDE2000 of 1 is just visible: what is less is shown as the little that it is.
    ends = session.range or (0.0, max(1.0, most))
    return ColorScale(table(session.colormap or _MAP), *ends, "CIEDE2000")
