"""A texture on a surface: its picture times the light, at each pixel of the screen.

The light is computed at vertices and varies slowly, the picture does not. So the light goes to the
graphics card as it is, linear, and is multiplied there with the decoded picture and encoded.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (
    vtkCellArray,
    vtkDataObject,
    vtkImageData,
    vtkPolyData,
)
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkTexture

from app import wipe_shader
from app.loading.texture import Texture
from app.loading.texture_wrap import CLAMP, MIRROR, REPEAT

_LIGHT, _BEYOND = "light", "lightBeyond"
# IEC 61966-2-1, as in lutcore.color; the sampler has decoded the texture.
_MULTIPLY = """
vec3 albedo = {albedo};
vec3 shone = clamp({light} * albedo, 0.0, 1.0);
vec3 power = 1.055 * pow(shone, vec3(1.0 / 2.4)) - 0.055;
gl_FragData[0] = vec4(mix(12.92 * shone, power, step(0.0031308, shone)), 1.0);
"""
_PLACE = "tcoordVCVSOutput"
# Half a pixel inside, where nothing of the other edge is mixed in.
_BEYOND_EDGE = {
    REPEAT: "{place}",
    CLAMP: "clamp({place}, {half}, 1.0 - {half})",
    MIRROR: "clamp(1.0 - abs(mod({place}, 2.0) - 1.0), {half}, 1.0 - {half})",
}


@dataclass(frozen=True, eq=False)
class Coat:
    """A texture, and the light that falls through it.

    Parameters
    ----------
    texture : Texture
        The picture.
    light : ndarray of float32, shape=(n, 3)
        At the mesh's vertices: linear, exposed, without the picture's albedo.
    """

    texture: Texture
    light: NDArray[np.float32]


def coated(coat: Coat, shape: vtkPolyData, beyond: Coat | None = None) -> vtkActor:
    """Return a textured surface as VTK draws it.

    Parameters
    ----------
    coat : Coat
        Texture and light.
    shape : vtkPolyData
        The mesh's geometry; see `app.scene.shape_of`.
    beyond : Coat, optional
        The same texture under the light that is shown right of a wipe's divider.

    Returns
    -------
    vtkActor
        In no renderer yet.
    """
    seams = coat.texture.seams
    points, cells = vtkPoints(), vtkCellArray()
    around = vtk_to_numpy(shape.GetPoints().GetData())[seams.vertices]
    points.SetData(numpy_to_vtk(around, deep=True))
    cells.SetData(3, numpy_to_vtk(seams.faces.ravel(), deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    data.GetPointData().SetTCoords(numpy_to_vtk(seams.uv, deep=True))
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    relight(actor, coat, beyond)
    actor.SetTexture(_picture(coat.texture))
    light = _passed(actor, _LIGHT, "Normal")
    if beyond is not None:
        light = wipe_shader.either(actor, light, _passed(actor, _BEYOND, "Clip"))
    # In place of VTK's own multiplication.
    code = _MULTIPLY.format(light=light, albedo=_albedo(coat.texture))
    actor.GetShaderProperty().AddFragmentShaderReplacement("//VTK::TCoord::Impl", True, code, False)
    return actor


def relight(actor: vtkActor, coat: Coat, beyond: Coat | None = None) -> None:
    """Give a textured surface that is drawn other light.

    Parameters
    ----------
    actor : vtkActor
        Of `coated`.
    coat : Coat
        The same texture under other light.
    beyond : Coat, optional
        See `coated`.
    """
    data = actor.GetMapper().GetInput()
    for name, one in ((_LIGHT, coat), (_BEYOND, beyond)):
        if one is not None:
            light = numpy_to_vtk(one.light[one.texture.seams.vertices], deep=True)
            light.SetName(name)
            data.GetPointData().AddArray(light)
    data.Modified()


def _albedo(texture: Texture) -> str:
    """Return the picture's colour in GLSL; the sampler itself can only repeat."""
    if texture.wrap == (REPEAT, REPEAT):
        return f"texture(actortexture, {_PLACE}.st).rgb"
    height, width = texture.image.shape[:2]
    inside = ", ".join(
        _BEYOND_EDGE[wrap].format(place=f"{_PLACE}.{axis}", half=f"{0.5 / size:.9f}")
        for wrap, axis, size in zip(texture.wrap, "st", (width, height), strict=True)
    )
    # The picture is seen as small as before it was folded.
    size = f"dFdx({_PLACE}.st), dFdy({_PLACE}.st)"
    return f"textureGrad(actortexture, vec2({inside}), {size}).rgb"


def _passed(actor: vtkActor, name: str, tag: str) -> str:
    """Let the shader have an array of the vertices; return what it is called there.

    Each tag of VTK's shaders takes one replacement only.
    """
    actor.GetMapper().MapDataArrayToVertexAttribute(
        name, name, vtkDataObject.FIELD_ASSOCIATION_POINTS, -1
    )
    style, out = actor.GetShaderProperty(), f"{name}VSOutput"
    declare, fill = f"//VTK::{tag}::Dec", f"//VTK::{tag}::Impl"
    style.AddVertexShaderReplacement(
        declare, True, f"in vec3 {name};\nout vec3 {out};\n{declare}", False
    )
    style.AddVertexShaderReplacement(fill, True, f"{out} = {name};\n{fill}", False)
    style.AddFragmentShaderReplacement(declare, True, f"in vec3 {out};\n{declare}", False)
    return out


def _picture(texture: Texture) -> vtkTexture:
    height, width = texture.image.shape[:2]
    image = vtkImageData()
    image.SetDimensions(width, height, 1)
    # VTK's first row is the lowest.
    rows = np.ascontiguousarray(texture.image[::-1]).reshape(-1, 3)
    image.GetPointData().SetScalars(numpy_to_vtk(rows, deep=True))
    made = vtkTexture()
    made.SetInputData(image)
    made.SetColorModeToDirectScalars()
    made.UseSRGBColorSpaceOn()
    made.InterpolateOn()
    made.MipmapOn()
    # One for both axes: where they differ, the shader folds one of them.
    made.SetWrap(vtkTexture.Repeat if REPEAT in texture.wrap else vtkTexture.ClampToEdge)
    return made
