"""What a picture holds before it is drawn. Light to import: a window shows one at once."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from app.render import Panel
from app.session import Camera, Session

if TYPE_CHECKING:
    from app.differences import Difference


@dataclass(frozen=True, eq=False)
class Composition:
    """What a picture holds, before it is drawn: a window draws the same.

    Parameters
    ----------
    session : Session
        What was asked for.
    panels : tuple of Panel
        From left to right, and row by row from the top.
    rows : int
        Equally high rows.
    camera : Camera
        Of all panels with a mesh.
    exposure : float or None
        The exposure, where something was shaded.
    ranges : dict of str to tuple of 2 floats
        See `app.picture.Picture`.
    difference : dict of str to Difference, or None
        See `app.picture.Picture`.
    """

    session: Session
    panels: tuple[Panel, ...]
    rows: int
    camera: Camera
    exposure: float | None
    ranges: dict[str, tuple[float, float]]
    difference: "dict[str, Difference] | None"
