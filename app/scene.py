"""What is drawn: meshes with their colours, a colour bar, captions. The only place that knows how.

It fills plain VTK renderers, so that a window and a picture off the screen draw the same scene.
The raw VTK classes are used because importing them takes a third of the time of pyvista.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkLight,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkTextActor,
    vtkTextProperty,
)

from app import wipe_shader
from app.ground import Ground
from app.session import Camera, Vector
from app.texturing import Coat, coated, relight
from lutcore.arrays import FloatArray
from lutcore.mesh import TriangleMesh

if TYPE_CHECKING:
    from app.strokes import Strokes

_FONT_SHARE = 0.021
_LEAST_FONT = 7
# Nothing nearer than this share of the distance to what is looked at is drawn where the scene is
# too deep for all of it; the depth buffer then still tells parts in 100,000 there.
_NEAREST = 0.02
# Width of a letter over the font's size, on the safe side.
_LETTER = 0.56
# As wide as a bar with the numbers beside it.
_LABELS = "bar -0.00123"
# Numbers beside a colour bar, and the digits that they have.
_NUMBERS = 6
_FEWEST_DIGITS, _MOST_DIGITS = 3, 9


@dataclass(frozen=True, eq=False)
class ColorScale:
    """How scalars become colours.

    Parameters
    ----------
    colors : ndarray, shape=(ENTRIES, 3)
        See `app.colormaps.table`.
    low, high : float
        Values of the first and the last colour.
    title : str
        Quantity and unit, above the bar; empty where they are said elsewhere.
    """

    colors: FloatArray
    low: float
    high: float
    title: str


@dataclass(frozen=True, eq=False)
class Surface:
    """A mesh with a colour at each vertex.

    Parameters
    ----------
    mesh : TriangleMesh
        The geometry.
    normals : ndarray, shape=(n, 3)
        Used only where `lit`.
    rgb : ndarray of uint8, shape=(n, 3), optional
        Colours as they go to the display; shown instead of `values` where there are both.
    values : ndarray, shape=(n,), optional
        Scalars, shown through `scale`.
    scale : ColorScale, optional
        How `values` become colours.
    lit : bool
        Whether a soft light at the camera shows the shape; else colours are shown as they are.
    caption : str
        One line below the surface.
    wipe : Wipe, optional
        What is shown instead on the right.
    strokes : Strokes, optional
        What is drawn on it.
    coat : Coat, optional
        A texture with its light, drawn in place of `rgb`: that is then what is seen at vertices.
    """

    mesh: TriangleMesh
    normals: FloatArray
    rgb: NDArray[np.uint8] | None = None
    values: FloatArray | None = None
    scale: ColorScale | None = None
    lit: bool = False
    caption: str = ""
    wipe: "Wipe | None" = None
    strokes: "Strokes | None" = None
    coat: Coat | None = None


@dataclass(frozen=True, eq=False)
class Wipe:
    """The other of two ways to show one surface.

    Parameters
    ----------
    surface : Surface
        The same mesh, and as the first either `rgb` or `values` with the same scale.
    at : float
        Where it begins, as a share of the surface's width in the picture: 0 shows it alone.
    """

    surface: Surface
    at: float


def shape_of(mesh: TriangleMesh, origin: Vector) -> vtkPolyData:
    """Return a mesh's geometry as VTK draws it, for all surfaces of that mesh.

    Parameters
    ----------
    mesh : TriangleMesh
        The mesh.
    origin : tuple of 3 floats
        A point near what is looked at.

    Returns
    -------
    vtkPolyData
        Points relative to the origin, and triangles.
    """
    points = vtkPoints()
    # The GPU gets single precision: around what is looked at it stays exact, however far the mesh
    # lies from the origin or stray parts lie from the mesh.
    around = (mesh.vertices - np.asarray(origin)).astype(np.float32)
    # Not copied: nobody changes them, and VTK holds what it was given.
    points.SetData(numpy_to_vtk(around, deep=False))
    cells = vtkCellArray()
    cells.SetData(3, numpy_to_vtk(mesh.faces.ravel(), deep=False))
    shape = vtkPolyData()
    shape.SetPoints(points)
    shape.SetPolys(cells)
    return shape


def fill_surface(
    renderer: vtkRenderer, surface: Surface, camera: Camera, shape: vtkPolyData, origin: Vector
) -> vtkActor:
    """Put a surface into a renderer, seen by a camera.

    Parameters
    ----------
    renderer : vtkRenderer
        An empty renderer.
    surface : Surface
        What to draw.
    camera : Camera
        Where from.
    shape : vtkPolyData
        Its geometry; see `shape_of`.
    origin : tuple of 3 floats
        What the geometry is relative to.

    Returns
    -------
    vtkActor
        What was put there.
    """
    actor = actor_of(surface, shape)
    if surface.lit:
        _light(renderer, actor)
    else:
        actor.GetProperty().LightingOff()
    renderer.AddActor(actor)
    _add_strokes(renderer, surface, origin)
    aim(renderer, camera, origin)
    return actor


def _add_strokes(renderer: vtkRenderer, surface: Surface, origin: Vector) -> None:
    second = None if surface.wipe is None else surface.wipe.surface
    for one in (surface, second):
        if one is None or one.strokes is None:
            continue
        from app.stroke_actor import stroke_actor

        actor = stroke_actor(one.strokes, origin)
        if second is not None:
            wipe_shader.confine(actor, left=one is surface)
        renderer.AddActor(actor)


def actor_of(surface: Surface, shape: vtkPolyData) -> vtkActor:
    """Return a surface as VTK draws it.

    Parameters
    ----------
    surface : Surface
        What to draw.
    shape : vtkPolyData
        Its geometry; see `shape_of`.

    Returns
    -------
    vtkActor
        In no renderer yet.
    """
    if surface.coat is not None:
        return coated(surface.coat, shape, _beyond(surface))
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(_poly_data(surface, shape))
    if surface.rgb is None and surface.scale is not None:
        mapper.SetLookupTable(_lookup(surface.scale))
        mapper.UseLookupTableScalarRangeOn()
        # Colours of the values between vertices, not mixtures of the vertices' colours.
        mapper.InterpolateScalarsBeforeMappingOn()
    actor = vtkActor()
    actor.SetMapper(mapper)
    if surface.wipe is not None:
        wipe_shader.attach(actor, surface.wipe.surface)
    return actor


def _beyond(surface: Surface) -> Coat | None:
    return None if surface.wipe is None else surface.wipe.surface.coat


def recolor(actor: vtkActor, surface: Surface) -> None:
    """Give a surface that is drawn other colours; its geometry stays where it is.

    Parameters
    ----------
    actor : vtkActor
        Of `actor_of` or `fill_surface`, for a surface of the same kind.
    surface : Surface
        The same mesh in its new colours.
    """
    if surface.coat is not None:
        relight(actor, surface.coat, _beyond(surface))
        return
    mapper = actor.GetMapper()
    _set_scalars(mapper.GetInput(), surface)
    if surface.rgb is None and surface.scale is not None:
        mapper.SetLookupTable(_lookup(surface.scale))
    if surface.wipe is not None:
        wipe_shader.recolor(actor, surface.wipe.surface)


def fill_caption(renderer: vtkRenderer, caption: str, size: int) -> None:
    """Put one line of text into a renderer; left out where it could not be read.

    Parameters
    ----------
    renderer : vtkRenderer
        An empty renderer.
    caption : str
        The line, or nothing.
    size : int
        Of its letters; see `font_size`.
    """
    if not caption or size < _LEAST_FONT:
        return
    text = _text(caption, renderer, size)
    text.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    text.SetPosition(0.5, 0.25)
    text.GetTextProperty().SetJustificationToCentered()
    renderer.AddViewProp(text)


def fill_bar(renderer: vtkRenderer, scale: ColorScale, pixels: tuple[float, float]) -> None:
    """Put a colour bar with its numbers and its title into a renderer.

    Parameters
    ----------
    renderer : vtkRenderer
        An empty renderer.
    scale : ColorScale
        What to explain.
    pixels : tuple of 2 floats
        Width that there is for it, and height of the picture.
    """
    from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor

    size = font_size(scale.title or _LABELS, pixels)
    bar = vtkScalarBarActor()
    bar.SetLookupTable(_lookup(scale))
    bar.SetMaximumNumberOfColors(256)
    bar.SetNumberOfLabels(_NUMBERS)
    digits = label_digits(scale.low, scale.high)
    bar.SetLabelFormat(f"{{:.{digits}g}}" if _new_label_format() else f"%.{digits}g")
    bar.UnconstrainedFontSizeOn()
    for style in (bar.GetLabelTextProperty(), bar.GetTitleTextProperty()):
        _style(style, renderer, size)
    bar.SetBarRatio(0.22)
    bar.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    bar.SetPosition(0.12, 0.12)
    bar.SetWidth(0.8)
    bar.SetHeight(0.72)
    renderer.AddViewProp(bar)
    if not scale.title:
        return
    title = _text(scale.title, renderer, size)
    title.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    title.SetPosition(0.5, 0.87)
    title.GetTextProperty().SetJustificationToCentered()
    renderer.AddViewProp(title)


def label_digits(low: float, high: float) -> int:
    """Return how many digits tell the numbers beside a colour bar apart.

    Parameters
    ----------
    low, high : float
        Its ends.

    Returns
    -------
    int
        Three, or as many more as it takes.
    """
    numbers = np.linspace(low, high, _NUMBERS)
    for digits in range(_FEWEST_DIGITS, _MOST_DIGITS):
        if len({f"{number:.{digits}g}" for number in numbers}) == _NUMBERS:
            return digits
    return _MOST_DIGITS


def _new_label_format() -> bool:
    # VTK 9.6 turned label formats from printf to std::format notation.
    from vtkmodules.vtkCommonCore import vtkVersion

    return (vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion()) >= (9, 6)


def _poly_data(surface: Surface, shape: vtkPolyData) -> vtkPolyData:
    data = vtkPolyData()
    data.ShallowCopy(shape)
    _set_scalars(data, surface)
    if surface.lit:
        normals = numpy_to_vtk(surface.normals.astype(np.float32), deep=True)
        data.GetPointData().SetNormals(normals)
    return data


def _set_scalars(data: vtkPolyData, surface: Surface) -> None:
    shown = surface.rgb if surface.rgb is not None else surface.values
    if shown is not None:
        # Not copied: nobody changes colours that were computed.
        data.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(shown), deep=False))


def _lookup(scale: ColorScale) -> vtkLookupTable:
    table = vtkLookupTable()
    table.SetNumberOfTableValues(len(scale.colors))
    for index, (red, green, blue) in enumerate(scale.colors):
        table.SetTableValue(index, red, green, blue, 1.0)
    table.SetTableRange(scale.low, scale.high)
    return table


def _light(renderer: vtkRenderer, actor: vtkActor) -> None:
    light = vtkLight()
    light.SetLightTypeToHeadlight()
    renderer.AddLight(light)
    # Half the brightness is independent of the light: the colours must stay readable.
    actor.GetProperty().SetAmbient(0.5)
    actor.GetProperty().SetDiffuse(0.5)
    actor.GetProperty().SetInterpolationToPhong()


def aim(renderer: vtkRenderer, camera: Camera, origin: Vector) -> None:
    """Look at what a renderer holds.

    Parameters
    ----------
    renderer : vtkRenderer
        The renderer.
    camera : Camera
        Where from.
    origin : tuple of 3 floats
        What the geometry is relative to.
    """
    view = renderer.GetActiveCamera()
    view.SetPosition(*np.subtract(camera.position, origin))
    view.SetFocalPoint(*np.subtract(camera.target, origin))
    view.SetViewUp(*camera.up)
    view.SetViewAngle(camera.angle)
    view.SetParallelProjection(camera.height is not None)
    if camera.height is not None:
        view.SetParallelScale(camera.height / 2.0)
    renderer.ResetCameraClippingRange()
    near, far = view.GetClippingRange()
    if near <= renderer.GetNearClippingPlaneTolerance() * far * 1.001:
        # Stray parts far behind drew the near plane away from the camera, past what is looked at.
        near = min(near, _NEAREST * view.GetDistance())
        view.SetClippingRange(near, far)


def font_size(words: str, pixels: tuple[float, float]) -> int:
    """Return the size of letters that fit the width and are in proportion to the height.

    Parameters
    ----------
    words : str
        One line or more.
    pixels : tuple of 2 floats
        Width that there is for them, and height of the picture.

    Returns
    -------
    int
        Pixels.
    """
    width, height = pixels
    longest = max(map(len, words.splitlines()))
    return int(min(_FONT_SHARE * height, 0.95 * width / (_LETTER * longest)))


def _text(words: str, renderer: vtkRenderer, size: int) -> vtkTextActor:
    text = vtkTextActor()
    text.SetInput(words)
    _style(text.GetTextProperty(), renderer, size)
    return text


def _style(style: vtkTextProperty, renderer: vtkRenderer, size: int) -> None:
    behind = Ground(renderer.GetBackground(), renderer.GetBackgroundAlpha() == 0.0)
    style.SetColor(*(behind.ink,) * 3)
    style.SetFontSize(max(_LEAST_FONT, size))
    style.SetFontFamilyToArial()
    style.ItalicOff()
    style.BoldOff()
    style.ShadowOff()
