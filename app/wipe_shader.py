"""The second of two ways to show a surface, in the same actor: a window moves the divider fast.

The actor carries both as attributes of its vertices, and the shader takes one or the other by the
column of the pixel. A picture off the screen does without: see `app.render.draw`.
"""

from typing import TYPE_CHECKING

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer

from lutcore.arrays import AnyArray

if TYPE_CHECKING:
    from app.scene import Surface

_COLUMN = "wipeColumn"
_COLOR, _PLACE, _NORMAL = "wipeColor", "wipePlace", "wipeNormal"
_LEFT = f"(gl_FragCoord.x < {_COLUMN})"
# More than any window is wide: the first is shown everywhere until the divider is placed.
_FAR = 1e6


def attach(actor: vtkActor, second: "Surface") -> None:
    """Give an actor a second way to show its surface; it shows the first until `place` is called.

    Parameters
    ----------
    actor : vtkActor
        Of `app.scene.actor_of`.
    second : Surface
        See `app.scene.Wipe`.
    """
    recolor(actor, second)
    place(actor, _FAR)
    if second.rgb is not None:
        _pass(actor, _COLOR, "vec3", f"{_COLOR} / 255.0")
        _choose(actor, "vertexColorVSOutput.rgb", f"{_COLOR}VSOutput")
    else:
        _pass(actor, _PLACE, "vec2", _PLACE)
        _choose(actor, "colorTCoordVCVSOutput.st", f"{_PLACE}VSOutput")
    if second.lit:
        _pass(actor, _NORMAL, "vec3", f"normalMatrix * {_NORMAL}", "Normal")
        found, other = "normalize(normalVCVSOutput)", f"{_NORMAL}VSOutput"
        _replace(actor, found, f"normalize({_LEFT} ? normalVCVSOutput : {other})")


def recolor(actor: vtkActor, second: "Surface") -> None:
    """Send the second way's colours.

    Parameters
    ----------
    actor : vtkActor
        Of `attach`.
    second : Surface
        Of the same kind as before.
    """
    if second.rgb is not None:
        _give(actor, _COLOR, second.rgb)
    else:
        _give(actor, _PLACE, _places(actor.GetMapper(), second))
    if second.lit:
        _give(actor, _NORMAL, second.normals.astype(np.float32))


def place(actor: vtkActor, column: float) -> None:
    """Move the divider.

    Parameters
    ----------
    actor : vtkActor
        Of `attach`.
    column : float
        The first column of the window's pixels that shows the second.
    """
    actor.GetShaderProperty().GetFragmentCustomUniforms().SetUniformf(_COLUMN, column)


def place_all(renderer: vtkRenderer, column: float) -> None:
    """Move the divider of all that has one: mesh, coarse mesh and strokes.

    Parameters
    ----------
    renderer : vtkRenderer
        Where they are.
    column : float
        See `place`.
    """
    for actor in renderer.GetActors():
        uniforms = actor.GetShaderProperty().GetFragmentCustomUniforms()
        names = map(uniforms.GetNthUniformName, range(uniforms.GetNumberOfUniforms()))
        if _COLUMN in names:
            place(actor, column)


def confine(actor: vtkActor, left: bool) -> None:
    """Draw an actor on one side of the divider only.

    Parameters
    ----------
    actor : vtkActor
        One that has no second way to be shown.
    left : bool
        Which side.
    """
    tag, other = "//VTK::Color::Impl", f"!{_LEFT}" if left else _LEFT
    actor.GetShaderProperty().AddFragmentShaderReplacement(
        tag, True, f"if ({other}) discard;\n{tag}", False
    )
    place(actor, _FAR)


def either(actor: vtkActor, first: str, second: str) -> str:
    """Return the code that takes one of two values by the column of the pixel.

    Parameters
    ----------
    actor : vtkActor
        One whose divider `place` will move; it shows the first until then.
    first, second : str
        Expressions of the fragment shader, left and right of the divider.

    Returns
    -------
    str
        An expression.
    """
    place(actor, _FAR)
    return f"({_LEFT} ? {first} : {second})"


def _give(actor: vtkActor, name: str, values: AnyArray) -> None:
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    mapper = actor.GetMapper()
    mapper.GetInput().GetPointData().AddArray(array)
    mapper.MapDataArrayToVertexAttribute(name, name, vtkDataObject.FIELD_ASSOCIATION_POINTS, -1)


def _places(mapper: vtkPolyDataMapper, second: "Surface") -> AnyArray:
    """Return where values lie in the texture of the colour map, as VTK itself computes it."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    other, data = vtkPolyDataMapper(), vtkPolyData()
    data.SetPoints(mapper.GetInput().GetPoints())
    data.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(second.values), deep=True))
    other.SetInputData(data)
    other.SetLookupTable(mapper.GetLookupTable())
    other.UseLookupTableScalarRangeOn()
    other.InterpolateScalarsBeforeMappingOn()
    other.MapScalars(1.0)
    return vtk_to_numpy(other.GetColorCoordinates()).copy()


def _pass(actor: vtkActor, name: str, kind: str, value: str, tag: str = "Color") -> None:
    """Pass an attribute on from the vertices to the pixels; each tag takes only one."""
    shader = actor.GetShaderProperty()
    declared, done = f"//VTK::{tag}::Dec", f"//VTK::{tag}::Impl"
    shader.AddVertexShaderReplacement(
        declared, True, f"{declared}\nin {kind} {name};\nout {kind} {name}VSOutput;", False
    )
    shader.AddVertexShaderReplacement(done, True, f"{done}\n  {name}VSOutput = {value};", False)
    shader.AddFragmentShaderReplacement(
        declared, True, f"{declared}\nin {kind} {name}VSOutput;", False
    )


def _choose(actor: vtkActor, first: str, second: str) -> None:
    _replace(actor, first, f"({_LEFT} ? {first} : {second})")


def _replace(actor: vtkActor, found: str, by: str) -> None:
    # After VTK has put its own code in.
    actor.GetShaderProperty().AddFragmentShaderReplacement(found, False, by, True)
