"""A pixel look on actors that are drawn: put on, moved by uniforms alone, taken off."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData
from vtkmodules.vtkRenderingCore import vtkActor, vtkShaderProperty, vtkTexture, vtkUniforms

from app.camera import axes
from app.session import Camera, Session, Vector
from app.shader import glsl
from app.shader.look import PixelLook, packed
from lutcore.arrays import SingleArray

if TYPE_CHECKING:
    from lutcore.arrays import AnyArray

_DECLARED, _DONE = "//VTK::Normal::Dec", "//VTK::Normal::Impl"
_TEXTURES, _COLOR = "//VTK::TCoord::Dec", "//VTK::Light::Impl"
_UNSHIFTED, _AUTOMATIC = 0, 1  # vtkOpenGLVertexBufferObject's DISABLE_ and AUTO_SHIFT_SCALE


class PixelLight:
    """Shades actors of one surface by the pixel while it is on them.

    Parameters
    ----------
    look : PixelLook
        The surface and the model.
    actors : sequence of (vtkActor, ndarray of int or None)
        Of `app.scene.actor_of`, unlit and in colours, and which of the surface's vertices each
        has, None for all. They may share a shader property.
    origin : tuple of 3 floats
        What the geometry is drawn relative to.
    session, camera, exposure
        As for `move`: no frame is drawn without them.
    """

    def __init__(
        self,
        look: PixelLook,
        actors: "Sequence[tuple[vtkActor, AnyArray | None]]",
        origin: Vector,
        session: Session,
        camera: Camera,
        exposure: float,
    ) -> None:
        self.look = look
        self._actors = list(actors)
        self._origin = np.asarray(origin)
        self._texture = None if look.table is None else _texture(look.table)
        self._points: list[vtkPoints] = []
        for actor, vertices in self._actors:
            self._give(actor, vertices)
        for actor, _ in self._actors:
            self._set(actor, look.numbers)
        self._beamed: list[bool] | None = None
        self.move(session, camera, exposure)

    def move(self, session: Session, camera: Camera, exposure: float) -> None:
        """Follow lights, camera and exposure: by uniforms alone, unless lights are of other kinds.

        Parameters
        ----------
        session : Session
            Its lights are used, no more than there is room for.
        camera : Camera
            Where it is seen from.
        exposure : float
            Factor on linear light.
        """
        rows = packed(session, camera)
        beamed = rows[:, 0] != 0.0
        rows[beamed, 1:4] -= self._origin
        parallel = camera.height is not None
        eye = axes(camera)[2] if parallel else np.subtract(camera.position, self._origin)
        numbers: dict[str, tuple[float, ...]] = {
            glsl.LIGHTS: tuple(rows.ravel()),
            glsl.EYE: (*eye, 0.0 if parallel else 1.0),
        }
        for actor, _ in self._actors:
            self._set(actor, numbers)
            for uniforms in _uniforms(actor):
                uniforms.SetUniformf(glsl.EXPOSURE, exposure)
        kinds = beamed[: len(session.lights)].tolist()
        if kinds != self._beamed:
            self._beamed = kinds
            for style in self._styles():
                _clear(style)
                _replace(style, glsl.Glow(self.look, kinds))

    def remove(self) -> None:
        """Leave the actors as they were, in the colours of their vertices."""
        for style in self._styles():
            _clear(style)
        for (actor, _), points in zip(self._actors, self._points, strict=True):
            for uniforms in _uniforms(actor):
                uniforms.RemoveAllUniforms()
            mapper = actor.GetMapper()
            mapper.RemoveAllVertexAttributeMappings()
            mapper.ScalarVisibilityOn()
            mapper.SetVBOShiftScaleMethod(_AUTOMATIC)
            mapper.GetInput().SetPoints(points)
            for name in self.look.attributes:
                mapper.GetInput().GetPointData().RemoveArray(_array(name))
            actor.GetProperty().RemoveTexture(glsl.TABLE)
        self._actors = []

    def _styles(self) -> list[vtkShaderProperty]:
        """Return the shader properties, each once."""
        found = [actor.GetShaderProperty() for actor, _ in self._actors]
        return [one for at, one in enumerate(found) if one not in found[:at]]

    def _give(self, actor: vtkActor, vertices: "AnyArray | None") -> None:
        mapper = actor.GetMapper()
        points = mapper.GetInput().GetPointData()
        for name, values in self.look.attributes.items():
            chosen = values if vertices is None else values[vertices]
            array = numpy_to_vtk(chosen, deep=False)
            array.SetName(_array(name))
            points.AddArray(array)
            mapper.MapDataArrayToVertexAttribute(
                name, _array(name), vtkDataObject.FIELD_ASSOCIATION_POINTS, -1
            )
        mapper.ScalarVisibilityOff()
        data = mapper.GetInput()
        self._points.append(data.GetPoints())
        data.SetPoints(_as_they_are(data.GetPoints()))
        mapper.SetVBOShiftScaleMethod(_UNSHIFTED)
        if self._texture is not None:
            actor.GetProperty().SetTexture(glsl.TABLE, self._texture)

    @staticmethod
    def _set(actor: vtkActor, numbers: dict[str, tuple[float, ...]]) -> None:
        for uniforms in _uniforms(actor):
            for name, values in numbers.items():
                uniforms.SetUniform1fv(name, len(values), values)


def _uniforms(actor: vtkActor) -> tuple[vtkUniforms, vtkUniforms]:
    style = actor.GetShaderProperty()
    return style.GetVertexCustomUniforms(), style.GetFragmentCustomUniforms()


def _as_they_are(points: vtkPoints) -> vtkPoints:
    """Return the same points for VTK to send anew: what it sent is in a frame of its own."""
    array = points.GetData().NewInstance()
    array.ShallowCopy(points.GetData())
    made = vtkPoints()
    made.SetData(array)
    return made


def _array(name: str) -> str:
    return f"pixel {name}"


def _clear(style: vtkShaderProperty) -> None:
    style.ClearAllVertexShaderReplacements()
    style.ClearAllFragmentShaderReplacements()


def _replace(style: vtkShaderProperty, code: glsl.Glow) -> None:
    add = style.AddVertexShaderReplacement
    add(_DECLARED, True, code.vertex_functions + _DECLARED, False)
    add(_DONE, True, code.vertex_code + _DONE, False)
    add = style.AddFragmentShaderReplacement
    add(_DECLARED, True, code.pixel_inputs + _DECLARED, False)
    # Behind the sampler, which VTK declares itself.
    add(_TEXTURES, True, f"{_TEXTURES}\n{code.pixel_functions}", False)
    add(_COLOR, True, code.pixel_code, False)


def _texture(table: SingleArray) -> vtkTexture:
    rows, columns, parts = table.shape
    image = vtkImageData()
    image.SetDimensions(columns, rows, 1)
    image.GetPointData().SetScalars(numpy_to_vtk(table.reshape(-1, parts), deep=True))
    made = vtkTexture()
    made.SetInputData(image)
    made.SetColorModeToDirectScalars()
    made.InterpolateOff()
    made.MipmapOff()
    made.RepeatOff()
    return made
