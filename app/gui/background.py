"""What lies behind the mesh: a colour, or nothing, which the view shows as grey checks."""

from typing import TYPE_CHECKING

import numpy as np
from qtpy.QtGui import QColor
from qtpy.QtWidgets import QColorDialog
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkRenderingCore import vtkTexture

from app.ground import TRANSPARENT, ground
from app.gui.controller import Controller
from app.session import Session
from app.transparency import checks
from lutcore.errors import ParameterError

if TYPE_CHECKING:
    from qtpy.QtWidgets import QWidget
    from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow

_CHECK = 12
"""Side of a check, pixels of a screen at 100 %."""
_BEHIND = "#262626"


class Background:
    """Switches the session's background between a colour and none.

    Parameters
    ----------
    controller : Controller
        Of the window.
    """

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._color = Session().background
        controller.document.changed.connect(lambda *_: self._follow())
        self._follow()

    @property
    def transparent(self) -> bool:
        """Whether there is none."""
        return self._controller.session.background.lower() == TRANSPARENT

    def named(self, transparent: bool) -> str:
        """Return what a session says of it.

        Parameters
        ----------
        transparent : bool
            Whether there shall be none; else it is the last colour there was.

        Returns
        -------
        str
            For `Session.background`.
        """
        return TRANSPARENT if transparent else self._color

    def toggle(self) -> None:
        """Take the background away, or bring its last colour back."""
        self._controller.change("background", background=self.named(not self.transparent))

    def choose(self, parent: "QWidget") -> None:
        """Ask for a colour and take it.

        Parameters
        ----------
        parent : QWidget
            What the dialog belongs to.
        """
        try:
            now = QColor.fromRgbF(*ground(self._color).color)
        except ParameterError:  # a session may say what is no colour
            now = QColor(Session().background)
        chosen = QColorDialog.getColor(now, parent, "Background colour")
        if chosen.isValid():
            self._controller.change("background", background=chosen.name())

    def _follow(self) -> None:
        if not self.transparent:
            self._color = self._controller.session.background


def on_screen(background: str) -> str:
    """Return the colour that stands for a background in a window.

    Parameters
    ----------
    background : str
        Of a session.

    Returns
    -------
    str
        The same, but dark where it is transparent: lay checks before it then.
    """
    return _BEHIND if ground(background).transparent else background


def lay_checks(window: "vtkRenderWindow", scale: float) -> None:
    """Show in a window on the screen that nothing lies behind what its renderers hold.

    Parameters
    ----------
    window : vtkRenderWindow
        Filled.
    scale : float
        Pixels of the screen for each of a screen at 100 %.
    """
    for renderer in window.GetRenderers():
        (width, height), (left, bottom) = renderer.GetSize(), renderer.GetOrigin()
        if width > 0 and height > 0:
            _lay(renderer, checks(height, width, left, bottom, round(_CHECK * scale)))


def _lay(renderer: "vtkRenderer", pattern: np.ndarray) -> None:
    height, width, _ = pattern.shape
    image = vtkImageData()
    image.SetDimensions(width, height, 1)
    rows = np.ascontiguousarray(pattern[::-1]).reshape(-1, 3)
    image.GetPointData().SetScalars(numpy_to_vtk(rows, deep=True))
    texture = vtkTexture()
    texture.SetInputData(image)
    texture.SetColorModeToDirectScalars()
    texture.InterpolateOff()
    renderer.SetBackgroundTexture(texture)
    renderer.TexturedBackgroundOn()
