"""The divider of a swipe as it is drawn over the view: a line, and a handle in its middle."""

import math
from typing import TYPE_CHECKING

from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor2D, vtkPolyDataMapper2D

from app.render import Box
from app.wiping import column, line

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer

RADIUS = 13.0
"""Of the handle, in pixels of a screen at 100 %."""
_CORNERS = 40
_Corners = list[tuple[float, float]]


class Divider:
    """Actors that are put into a renderer and moved.

    Parameters
    ----------
    grey : int
        Of the line and the handle, 0 to 255; the arrows on it are dark or bright as it needs.
    scale : float
        Pixels of the screen for each of a screen at 100 %.
    """

    def __init__(self, grey: int, scale: float) -> None:
        self._radius = RADIUS * scale
        ink = 30 if grey > 127 else 230
        self._line, self._plate, self._arrows = _actor(grey, 1), _actor(grey, 2), _actor(ink, 3)

    def put(self, renderer: "vtkRenderer") -> None:
        """Draw over what a renderer holds.

        Parameters
        ----------
        renderer : vtkRenderer
            Of the wiped surface.
        """
        for actor in (self._line, self._plate, self._arrows):
            renderer.AddViewProp(actor)

    def place(self, box: Box, at: float, on: bool) -> None:
        """Move it.

        Parameters
        ----------
        box : tuple of 4 ints
            Where the surface is drawn.
        at : float
            See `app.scene.Wipe`.
        on : bool
            Whether it is seen.
        """
        for actor in (self._line, self._plate, self._arrows):
            actor.SetVisibility(on)
        left, _, _, height = box
        start, stop = (one - left for one in line(box, at))
        x, y, r = column(box, at) - left, height / 2.0, self._radius
        _shape(self._line, [[(start, 0), (stop, 0), (stop, height), (start, height)]])
        turns = [2.0 * math.pi * step / _CORNERS for step in range(_CORNERS)]
        _shape(self._plate, [[(x + r * math.cos(t), y + r * math.sin(t)) for t in turns]])
        arrows: list[_Corners] = [
            [(x + d * 0.25 * r, y - 0.4 * r), (x + d * 0.7 * r, y), (x + d * 0.25 * r, y + 0.4 * r)]
            for d in (-1.0, 1.0)
        ]
        _shape(self._arrows, arrows)


def _actor(grey: int, layer: int) -> vtkActor2D:
    actor, mapper = vtkActor2D(), vtkPolyDataMapper2D()
    mapper.SetInputData(vtkPolyData())
    actor.SetMapper(mapper)
    actor.SetLayerNumber(layer)
    actor.GetProperty().SetColor(*(grey / 255.0,) * 3)
    return actor


def _shape(actor: vtkActor2D, polygons: list[_Corners]) -> None:
    """Fill polygons, in pixels from the renderer's lower left corner."""
    points, cells = vtkPoints(), vtkCellArray()
    for polygon in polygons:
        cells.InsertNextCell(len(polygon))
        for x, y in polygon:
            cells.InsertCellPoint(points.InsertNextPoint(x, y, 0.0))
    data = actor.GetMapper().GetInput()
    data.SetPoints(points)
    data.SetPolys(cells)
    data.Modified()
