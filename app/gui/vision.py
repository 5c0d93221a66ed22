"""The colour map as the colour-blind see it: a preview, no part of the session. Knows no Qt."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from psygnal import Signal

from app.gui import display
from app.scene import ColorScale, Surface
from lutcore.arrays import FloatArray

if TYPE_CHECKING:
    from app.composition import Composition
    from app.gui.controller import Controller
    from app.render import Panel

KINDS = {
    "protanopia": "Protanomaly",
    "deuteranopia": "Deuteranomaly",
    "tritanopia": "Tritanomaly",
}
"""What can be previewed: no red, green or blue cones; colour-science's name, at full strength."""


class Vision:
    """Shows the colours of a scale as somebody else sees them.

    Parameters
    ----------
    controller : Controller
        Of the window.
    """

    changed = Signal()
    """Emitted when other colours are to be shown."""

    def __init__(self, controller: "Controller") -> None:
        self._controller = controller
        self.kind = ""
        """A key of `KINDS`, empty for colours as they are."""
        self._matrix: FloatArray | None = None

    def choose(self, kind: str) -> None:
        """Preview a deficiency, or none.

        Parameters
        ----------
        kind : str
            A key of `KINDS`, or empty.
        """
        self.kind = kind
        # The first time a large package is imported.
        self._controller.run("vision", lambda _: matrix(kind) if kind else None, self._take)

    def seen(self, made: "Composition") -> "Composition":
        """Return a composition in the colours that are seen.

        Parameters
        ----------
        made : Composition
            What to show.

        Returns
        -------
        Composition
            The same where nothing is previewed; shading stays as it is.
        """
        found = self._matrix
        if found is None:
            return made
        return replace(made, panels=tuple(_panel(one, found) for one in made.panels))

    def _take(self, found: FloatArray | None) -> None:
        self._matrix = found
        self.changed.emit()


def matrix(kind: str) -> FloatArray:
    """Return how a deficiency mixes linear RGB.

    Parameters
    ----------
    kind : str
        A key of `KINDS`.

    Returns
    -------
    ndarray, shape=(3, 3)
        Of Machado et al. 2009, at full strength.
    """
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that its tritanomaly is an approximation
        from colour.blindness import matrix_cvd_Machado2009

        return np.asarray(matrix_cvd_Machado2009(KINDS[kind], 1.0), dtype=np.float64)


def simulated(encoded: FloatArray, found: FloatArray) -> FloatArray:
    """Return colours as they are seen.

    Parameters
    ----------
    encoded : ndarray, shape=(n, 3)
        sRGB-encoded, 0 to 1.
    found : ndarray, shape=(3, 3)
        Of `matrix`.

    Returns
    -------
    ndarray, shape=(n, 3)
        sRGB-encoded, 0 to 1.
    """
    from lutcore.color import srgb_decode

    return display.encoded(np.clip(srgb_decode(encoded) @ found.T, 0.0, 1.0))


def _panel(panel: "Panel", found: FloatArray) -> "Panel":
    content = panel.content
    if isinstance(content, ColorScale):
        return replace(panel, content=_scale(content, found))
    if content.scale is None:
        return panel
    return replace(panel, content=_surface(content, found))


def _surface(surface: Surface, found: FloatArray) -> Surface:
    rgb, scale, wipe = surface.rgb, surface.scale, surface.wipe
    if rgb is not None:
        rgb = np.rint(255.0 * simulated(rgb / 255.0, found)).astype(np.uint8)
    if wipe is not None:
        wipe = replace(wipe, surface=_surface(wipe.surface, found))
    scale = None if scale is None else _scale(scale, found)
    return replace(surface, rgb=rgb, scale=scale, wipe=wipe)


def _scale(scale: ColorScale, found: FloatArray) -> ColorScale:
    return replace(scale, colors=simulated(scale.colors, found))
