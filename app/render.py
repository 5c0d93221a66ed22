"""From panels to pixels: the only way to a picture."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from app import gl
from app.backend import Backend, backend_of
from app.ground import Ground, ground
from app.offscreen import offscreen_window
from app.scene import (
    ColorScale,
    Surface,
    fill_bar,
    fill_caption,
    fill_surface,
    font_size,
    shape_of,
)
from app.session import Camera, Vector
from app.transparency import straight

if TYPE_CHECKING:
    from vtkmodules.vtkCommonDataModel import vtkPolyData
    from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer, vtkRenderWindow

Image = NDArray[np.uint8]
Box = tuple[int, int, int, int]
"""Left, bottom, width and height, pixels from the lower left corner."""
Shapes = dict[tuple[int, Vector], "vtkPolyData"]
_SAMPLES = 4
_GRID_LETTERS = 1.25
# Shares of a row that is full may sum to a little more than 1.
_FULL = 1e-6
STRIP = 0.045
"""Share of the picture's height below every surface, for its caption."""


@dataclass(frozen=True, eq=False)
class Panel:
    """A part of the picture's width with one thing in it.

    Parameters
    ----------
    content : Surface or ColorScale
        A mesh, or a colour bar.
    width : float
        Its share of the picture's width; the shares of a row sum to 1.
    camera : Camera, optional
        Needed for a mesh.
    tall : bool
        Whether it goes over all rows; it is then the last one of the first row.
    """

    content: Surface | ColorScale
    width: float
    camera: Camera | None = None
    tall: bool = False


@dataclass(frozen=True, eq=False)
class Drawing:
    """Pixels, and what drew them.

    Parameters
    ----------
    image : ndarray of uint8, shape=(height, width, 3 or 4)
        sRGB, the first row at the top; with alpha where the background is transparent.
    backend : Backend
        The driver.
    """

    image: Image
    backend: Backend


def draw(panels: Sequence[Panel], size: tuple[int, int], background: str, rows: int = 1) -> Drawing:
    """Draw panels side by side.

    Parameters
    ----------
    panels : sequence of Panel
        From left to right, and row by row from the top.
    size : tuple of 2 ints
        Width and height, pixels.
    background : str
        A CSS colour, or ``transparent``.
    rows : int
        Equally high rows.

    Returns
    -------
    Drawing
        The same pixels for the same panels, bit for bit, from the same driver.

    Raises
    ------
    DrawingError
        If this machine has no working OpenGL.
    ParameterError
        If the background is no colour.
    """
    gl.require()
    made, wipes = _shot(panels, size, background, rows)
    if wipes:
        from app.wiping import composed

        # Each whole and by itself, so that either side is what its own picture shows.
        other, _ = _shot([_second(panel) for panel in panels], size, background, rows)
        image = composed(made.image, other.image, wipes, ground(background))
        made = Drawing(image, made.backend)
    return made


def _second(panel: Panel) -> Panel:
    wipe = panel.content.wipe if isinstance(panel.content, Surface) else None
    return panel if wipe is None else replace(panel, content=wipe.surface)


def _shot(
    panels: Sequence[Panel], size: tuple[int, int], background: str, rows: int
) -> "tuple[Drawing, list[tuple[Box, float]]]":
    """Draw panels, each surface as the first of its ways; tell where what is wiped lies."""
    # Four samples cost 1.6 times one even on a software renderer, once per picture.
    with offscreen_window(size, _SAMPLES) as window:
        drawn = fill(window, panels, size, background, rows)
        behind = ground(background)
        window.SetAlphaBitPlanes(behind.transparent)
        window.Render()
        wipes = [
            (one.box, one.panel.content.wipe.at)
            for one in drawn
            if isinstance(one.panel.content, Surface) and one.panel.content.wipe
        ]
        image = straight(_grab(window, size, 4)) if behind.transparent else grab(window, size)
        return Drawing(image, backend_of(window)), wipes


@dataclass(frozen=True, eq=False)
class Drawn:
    """A panel that is in a window.

    Parameters
    ----------
    panel : Panel
        What was put there.
    renderer : vtkRenderer
        Of its mesh or its colour bar.
    actor : vtkActor or None
        Of its mesh.
    """

    panel: Panel
    renderer: "vtkRenderer"
    actor: "vtkActor | None"

    @property
    def box(self) -> Box:
        """Where it lies in the window as it is now."""
        return *self.renderer.GetOrigin(), *self.renderer.GetSize()


def fill(
    window: "vtkRenderWindow",
    panels: Sequence[Panel],
    size: tuple[int, int],
    background: str,
    rows: int = 1,
    origin: Vector | None = None,
) -> list[Drawn]:
    """Put panels into a window that has no renderers yet.

    Parameters
    ----------
    window : vtkRenderWindow
        On the screen or off it.
    panels : sequence of Panel
        See `draw`.
    size : tuple of 2 ints
        Of the window, pixels.
    background : str
        A CSS colour, or ``transparent``.
    rows : int
        Equally high rows.
    origin : tuple of 3 floats, optional
        What the geometry is drawn relative to; each camera's target where it is left out.

    Returns
    -------
    list of Drawn
        In the order of the panels.

    Raises
    ------
    ParameterError
        If the background is no colour.
    """
    behind = ground(background)
    shapes: Shapes = {}
    height = _height(size, rows)
    letters = _caption_letters(panels, (size[0], height))
    made = []
    left, row = 0.0, 0
    for panel in panels:
        if left + panel.width > 1.0 + _FULL:
            left, row = 0.0, row + 1
        bottom = 0.0 if panel.tall else 1.0 - (row + 1) / rows
        right, top = left + panel.width, 1.0 if panel.tall else bottom + 1.0 / rows
        strip = bottom + STRIP if isinstance(panel.content, Surface) else bottom
        renderer = _add(window, behind, (left, strip, right, top))
        actor = None
        if isinstance(panel.content, ColorScale):
            fill_bar(renderer, panel.content, (panel.width * size[0], height))
        else:
            actor = _fill_mesh(renderer, panel, shapes, origin)
            below = _add(window, behind, (left, bottom, right, strip))
            fill_caption(below, panel.content.caption, letters)
        made.append(Drawn(panel, renderer, actor))
        left = right
    return made


def refill_bar(drawn: Drawn, scale: ColorScale, size: tuple[int, int], rows: int = 1) -> None:
    """Explain another scale where a colour bar is.

    Parameters
    ----------
    drawn : Drawn
        A colour bar that `fill` put there.
    scale : ColorScale
        What to explain now.
    size : tuple of 2 ints
        Of the window, pixels.
    rows : int
        See `fill`.
    """
    drawn.renderer.RemoveAllViewProps()
    fill_bar(drawn.renderer, scale, (drawn.panel.width * size[0], _height(size, rows)))


def _height(size: tuple[int, int], rows: int) -> float:
    """Height that letters are in proportion to: a grid is looked at from farther away."""
    return size[1] * (_GRID_LETTERS if rows > 1 else 1.0)


def _caption_letters(panels: Sequence[Panel], size: tuple[float, float]) -> int:
    """Size of letters for all captions: as large as the tightest one allows."""
    return min(
        (
            font_size(panel.content.caption, (panel.width * size[0], size[1]))
            for panel in panels
            if isinstance(panel.content, Surface) and panel.content.caption
        ),
        default=0,
    )


def _add(
    window: "vtkRenderWindow",
    behind: Ground,
    box: tuple[float, float, float, float],
) -> "vtkRenderer":
    """Return a new renderer of a part of the window: left, bottom, right, top as shares."""
    from vtkmodules.vtkRenderingCore import vtkRenderer

    renderer = vtkRenderer()
    renderer.SetBackground(*behind.color)
    renderer.SetBackgroundAlpha(0.0 if behind.transparent else 1.0)
    renderer.AutomaticLightCreationOff()
    renderer.SetViewport(*box)
    window.AddRenderer(renderer)
    return renderer


def _fill_mesh(
    renderer: "vtkRenderer", panel: Panel, shapes: Shapes, origin: Vector | None
) -> "vtkActor":
    surface, camera = panel.content, panel.camera
    if camera is None or not isinstance(surface, Surface):
        raise ValueError("a panel with a mesh needs a camera")
    around = camera.target if origin is None else origin
    key = id(surface.mesh), around
    if key not in shapes:
        shapes[key] = shape_of(surface.mesh, around)
    return fill_surface(renderer, surface, camera, shapes[key], around)


def grab(window: object, size: tuple[int, int]) -> Image:
    """Return what a window shows.

    Parameters
    ----------
    window : vtkRenderWindow
        Rendered.
    size : tuple of 2 ints
        Width and height, pixels.

    Returns
    -------
    ndarray of uint8, shape=(height, width, 3)
        sRGB, the first row at the top.
    """
    return _grab(window, size, 3)


def _grab(window: Any, size: tuple[int, int], channels: int) -> Image:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

    width, height = size
    pixels = vtkUnsignedCharArray()
    read = window.GetPixelData if channels == 3 else window.GetRGBACharPixelData
    read(0, 0, width - 1, height - 1, 0, pixels, 0)
    rows = vtk_to_numpy(pixels).reshape(height, width, channels)
    return np.ascontiguousarray(rows[::-1])
