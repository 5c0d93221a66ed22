"""Marks on the surface: balls of the same size on the screen, wherever they are."""

from collections.abc import Sequence

from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

from app.gui.canvas import Canvas
from app.session import Vector

_PIXELS = 9.0


class Pins:
    """Points drawn over what the view holds.

    Parameters
    ----------
    canvas : Canvas
        The view.
    color : tuple of 3 floats
        sRGB, 0 to 1.
    pixels : float
        Size, in pixels of a screen at 100 %.
    """

    def __init__(
        self, canvas: Canvas, color: tuple[float, float, float], pixels: float = _PIXELS
    ) -> None:
        self._canvas, self._color, self._pixels = canvas, color, pixels
        self._positions: list[Vector] = []
        self._actors: list[tuple[object, vtkActor]] = []
        canvas.filled.connect(self._fill)

    def show(self, positions: Sequence[Vector]) -> None:
        """Show these points in place of those before.

        Parameters
        ----------
        positions : sequence of tuple of 3 floats
            World coordinates.
        """
        if list(positions) == self._positions:
            return
        self._positions = list(positions)
        self._fill()
        self._canvas.update()

    def _fill(self) -> None:
        for renderer, actor in self._actors:
            renderer.RemoveActor(actor)  # type: ignore[attr-defined]
        self._actors = []
        if not self._positions:
            return
        for drawn in self._canvas.renderers():
            actor = self._actor()
            drawn.renderer.AddActor(actor)
            self._actors.append((drawn.renderer, actor))

    def _actor(self) -> vtkActor:
        points, cells = vtkPoints(), vtkCellArray()
        ox, oy, oz = self._canvas.origin
        for index, (x, y, z) in enumerate(self._positions):
            points.InsertNextPoint(x - ox, y - oy, z - oz)
            cells.InsertNextCell(1, [index])
        data = vtkPolyData()
        data.SetPoints(points)
        data.SetVerts(cells)
        mapper = vtkPolyDataMapper()
        mapper.SetInputData(data)
        # In front of the surface that they lie on.
        mapper.SetResolveCoincidentTopologyToPolygonOffset()
        mapper.SetRelativeCoincidentTopologyPointOffsetParameter(-4000.0)
        actor = vtkActor()
        actor.SetMapper(mapper)
        style = actor.GetProperty()
        style.SetRenderPointsAsSpheres(True)
        style.SetPointSize(self._pixels * self._canvas.devicePixelRatioF())
        style.SetColor(*self._color)
        style.LightingOff()
        return actor
