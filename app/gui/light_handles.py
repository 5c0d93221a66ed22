"""Handles of the lights over the view: never part of a picture that is saved."""

import numpy as np
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import (
    vtkActor2D,
    vtkCoordinate,
    vtkPolyDataMapper2D,
    vtkRenderer,
)

from app.camera import axes
from app.gui import orbit
from app.gui.aiming import seen_by
from app.gui.canvas import Canvas
from app.gui.lights import AnyLight, Lights, displayed, power
from app.scene import Surface
from app.session import Camera, Cone, Directional, Vector
from lutcore.arrays import FloatArray

PIXELS = 8.0
"""Radius of a handle on a screen at 100 %."""
_AROUND = 0.4  # radius of the sphere of directional lights, in heights of the view
_INNER = 0.8  # where a directional light's line ends, in radii of that sphere
_CORNERS = 32
_CHOSEN = (1.0, 0.75, 0.1)


def radius(camera: Camera) -> float:
    """Return the radius of the sphere that directional lights' handles lie on.

    Parameters
    ----------
    camera : Camera
        Who looks; the sphere is around its target.

    Returns
    -------
    float
        Mesh units.
    """
    return _AROUND * orbit.height_at_target(camera)


def anchor(light: AnyLight, camera: Camera) -> Vector:
    """Return where a light's handle is.

    Parameters
    ----------
    light : Directional, Point or Cone
        Any.
    camera : Camera
        Who looks.

    Returns
    -------
    tuple of 3 floats
        World coordinates.
    """
    if not isinstance(light, Directional):
        return light.position
    towards = axes(camera).T @ np.asarray(seen_by(light, camera))
    away = radius(camera) / max(float(np.linalg.norm(towards)), 1e-300)
    return orbit.vector(np.add(camera.target, away * towards))


class Handles:
    """Draws a dot for each light, and a line along which it shines.

    Parameters
    ----------
    canvas : Canvas
        The view.
    lights : Lights
        What to show.
    """

    def __init__(self, canvas: Canvas, lights: Lights) -> None:
        self._canvas, self._lights = canvas, lights
        self._actors: list[tuple[vtkRenderer, vtkActor2D]] = []
        self.shown = False

    def show(self, on: bool) -> None:
        """Show the handles, or hide them.

        Parameters
        ----------
        on : bool
            Whether they are shown.
        """
        self.shown = on
        self.draw()
        self._canvas.update()

    def draw(self) -> None:
        """Draw the handles where the lights are now."""
        for renderer, actor in self._actors:
            renderer.RemoveViewProp(actor)
        self._actors = []
        camera = self._canvas.camera
        if not self.shown or camera is None:
            return
        for drawn in self._canvas.renderers():
            content = drawn.panel.content
            # Colours of a scale may be rgb too, where they fade.
            if not isinstance(content, Surface) or content.rgb is None or content.scale:
                continue  # nothing is lit there
            for index, light in enumerate(self._lights.all):
                for actor in self._of(light, camera, index == self._lights.index):
                    drawn.renderer.AddViewProp(actor)
                    self._actors.append((drawn.renderer, actor))

    def _of(self, light: AnyLight, camera: Camera, chosen: bool) -> list[vtkActor2D]:
        size = PIXELS * self._canvas.devicePixelRatioF()
        at = np.subtract(anchor(light, camera), self._canvas.origin)
        made = []
        if isinstance(light, Directional):
            middle = np.subtract(camera.target, self._canvas.origin)
            made.append(_line(at, middle + _INNER * (at - middle)))
        elif isinstance(light, Cone):
            axis = np.asarray(light.direction) / np.linalg.norm(light.direction)
            made.append(_line(at, at + 0.3 * radius(camera) * axis))
        made += [_disc(at, 1.3 * size, (0.0, 0.0, 0.0)), _disc(at, size, displayed(power(light)))]
        if chosen:
            made.insert(len(made) - 2, _disc(at, 1.8 * size, _CHOSEN))
        return made


def _disc(at: FloatArray, pixels: float, color: Vector) -> vtkActor2D:
    points, cells = vtkPoints(), vtkCellArray()
    cells.InsertNextCell(_CORNERS, list(range(_CORNERS)))
    for angle in np.linspace(0.0, 2.0 * np.pi, _CORNERS, endpoint=False):
        points.InsertNextPoint(pixels * np.cos(angle), pixels * np.sin(angle), 0.0)
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    mapper = vtkPolyDataMapper2D()
    mapper.SetInputData(data)
    actor = vtkActor2D()
    actor.SetMapper(mapper)
    actor.GetPositionCoordinate().SetCoordinateSystemToWorld()
    actor.GetPositionCoordinate().SetValue(*(float(one) for one in at))
    actor.GetProperty().SetColor(*color)
    return actor


def _line(start: FloatArray, end: FloatArray) -> vtkActor2D:
    points, cells = vtkPoints(), vtkCellArray()
    points.InsertNextPoint(*start)
    points.InsertNextPoint(*end)
    cells.InsertNextCell(2, [0, 1])
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetLines(cells)
    mapper = vtkPolyDataMapper2D()
    mapper.SetInputData(data)
    world = vtkCoordinate()
    world.SetCoordinateSystemToWorld()
    mapper.SetTransformCoordinate(world)
    actor = vtkActor2D()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*_CHOSEN)
    actor.GetProperty().SetLineWidth(2.0)
    return actor
