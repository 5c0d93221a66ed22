"""From panels to pixels: the only way to a picture."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app import gl
from app.scene import ColorScale, Surface, color, fill_bar, fill_caption, fill_surface
from app.session import Camera

Image = NDArray[np.uint8]
_SAMPLES = 4
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
        Its share of the picture's width; the shares of a picture sum to 1.
    camera : Camera, optional
        Needed for a mesh.
    """

    content: Surface | ColorScale
    width: float
    camera: Camera | None = None


def draw(panels: Sequence[Panel], size: tuple[int, int], background: str) -> Image:
    """Draw panels side by side.

    Parameters
    ----------
    panels : sequence of Panel
        From left to right.
    size : tuple of 2 ints
        Width and height, pixels.
    background : str
        A CSS colour.

    Returns
    -------
    ndarray of uint8, shape=(height, width, 3)
        sRGB, the first row at the top.

    Raises
    ------
    DrawingError
        If this machine has no working OpenGL.
    ParameterError
        If the background is no colour.
    """
    shade = color(background)
    gl.require()
    import vtkmodules.vtkRenderingFreeType
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  registers the OpenGL classes
    from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow

    with gl.offscreen():
        window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    # Four samples cost 1.6 times one even on a software renderer, once per picture.
    window.SetMultiSamples(_SAMPLES)
    window.SetSize(*size)
    left = 0.0
    try:
        for panel in panels:
            renderer = vtkRenderer()
            renderer.SetBackground(*shade)
            renderer.AutomaticLightCreationOff()
            bottom = STRIP if isinstance(panel.content, Surface) else 0.0
            renderer.SetViewport(left, bottom, left + panel.width, 1.0)
            window.AddRenderer(renderer)
            _fill(panel)(renderer, (panel.width * size[0], size[1]))
            if isinstance(panel.content, Surface):
                below = vtkRenderer()
                below.SetBackground(*shade)
                below.SetViewport(left, 0.0, left + panel.width, STRIP)
                fill_caption(below, panel.content.caption, (panel.width * size[0], size[1]))
                window.AddRenderer(below)
            left += panel.width
        window.Render()
        return _grab(window, size)
    finally:
        window.Finalize()


def _fill(panel: Panel) -> Callable[..., None]:
    content, camera = panel.content, panel.camera
    if isinstance(content, ColorScale):
        return lambda renderer, pixels: fill_bar(renderer, content, pixels)
    if camera is None:
        raise ValueError("a panel with a mesh needs a camera")
    return lambda renderer, _: fill_surface(renderer, content, camera)


def _grab(window: object, size: tuple[int, int]) -> Image:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

    width, height = size
    pixels = vtkUnsignedCharArray()
    window.GetPixelData(0, 0, width - 1, height - 1, 0, pixels, 0)  # type: ignore[attr-defined]
    rows = vtk_to_numpy(pixels).reshape(height, width, 3)
    return np.ascontiguousarray(rows[::-1])
