"""Strokes as VTK draws them."""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

from app.session import Vector
from app.strokes import Strokes


def stroke_actor(strokes: Strokes, origin: Vector) -> vtkActor:
    """Return strokes in their own colours, in no renderer yet.

    Parameters
    ----------
    strokes : Strokes
        What to draw.
    origin : tuple of 3 floats
        What the geometry is relative to.

    Returns
    -------
    vtkActor
        Not lit: black and white stay so on every side of the surface.
    """
    points = vtkPoints()
    around = (strokes.points - np.asarray(origin)).astype(np.float32)
    points.SetData(numpy_to_vtk(around, deep=True))
    cells = vtkCellArray()
    cells.SetData(4, numpy_to_vtk(strokes.quads.ravel(), deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    colors = np.rint(255.0 * strokes.colors).astype(np.uint8)
    data.GetCellData().SetScalars(numpy_to_vtk(colors, deep=True))
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    return actor
