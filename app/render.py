"""From panels to pixels: the only way to a picture."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app import gl
from app.scene import ColorScale, Surface, color, fill_bar, fill_surface
from app.session import Camera

Image = NDArray[np.uint8]
_SAMPLES = 4


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
            renderer.SetViewport(left, 0.0, left + panel.width, 1.0)
            left += panel.width
            window.AddRenderer(renderer)
            _fill(panel)(renderer, size[1])
        window.Render()
        return _grab(window, size)
    finally:
        window.Finalize()


def _fill(panel: Panel) -> Callable[..., None]:
    content, camera = panel.content, panel.camera
    if isinstance(content, ColorScale):
        return lambda renderer, height: fill_bar(renderer, content, height)
    if camera is None:
        raise ValueError("a panel with a mesh needs a camera")
    return lambda renderer, height: fill_surface(renderer, content, camera, height)


def _grab(window: object, size: tuple[int, int]) -> Image:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

    width, height = size
    pixels = vtkUnsignedCharArray()
    window.GetPixelData(0, 0, width - 1, height - 1, 0, pixels, 0)  # type: ignore[attr-defined]
    rows = vtk_to_numpy(pixels).reshape(height, width, 3)
    return np.ascontiguousarray(rows[::-1])
