"""The window without a screen that pictures are drawn in."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from app import gl

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderWindow

# Room for the window that is kept, in processes that keep one.
_kept: "list[list[vtkRenderWindow]]" = []


def keep_window() -> None:
    """Draw all further pictures of this process in one window, from one thread.

    Making a window, its buffers and its shaders takes as long as drawing in it. For a process
    that does nothing but draw: a window that is kept holds on to its memory and to OpenGL.
    """
    _kept[:] = [[]]


@contextmanager
def offscreen_window(size: tuple[int, int], samples: int) -> "Iterator[vtkRenderWindow]":
    """Give an empty window; the pictures in it do not depend on whether it was used before.

    Parameters
    ----------
    size : tuple of 2 ints
        Width and height, pixels.
    samples : int
        Samples of each pixel.

    Yields
    ------
    vtkRenderWindow
        Without renderers.
    """
    # Importing registers the OpenGL classes.
    import vtkmodules.vtkRenderingFreeType
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
    from vtkmodules.vtkRenderingCore import vtkRenderWindow

    if _kept and _kept[0]:
        window = _kept[0][0]
    else:
        with gl.offscreen():
            window = vtkRenderWindow()
        window.SetOffScreenRendering(1)
        window.SetMultiSamples(samples)
        # Nobody looks at it: what is read is joined from its samples then, and not before too.
        window.SwapBuffersOff()
        for room in _kept:
            room.append(window)
    window.SetSize(*size)
    try:
        yield window
    finally:
        if _kept:
            _empty(window)
        else:
            window.Finalize()


def _empty(window: "vtkRenderWindow") -> None:
    renderers = window.GetRenderers()
    while renderers.GetNumberOfItems():
        renderer = renderers.GetFirstRenderer()
        window.RemoveRenderer(renderer)
        renderer.ReleaseGraphicsResources(window)
