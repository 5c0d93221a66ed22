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
    from app.render import Panel

KINDS = {
    "protanopia": (
        (0.152286, 1.052583, -0.204868),
        (0.114503, 0.786281, 0.099216),
        (-0.003882, -0.048116, 1.051998),
    ),
    "deuteranopia": (
        (0.367322, 0.860646, -0.227968),
        (0.280085, 0.672501, 0.047413),
        (-0.011820, 0.042940, 0.968881),
    ),
    "tritanopia": (
        (1.255528, -0.076749, -0.178779),
        (-0.078411, 0.930809, 0.147602),
        (0.004733, 0.691367, 0.303900),
    ),
}
"""What can be previewed: no red, green or blue cones, and how it mixes linear RGB.

Machado, Oliveira and Fernandes, A Physiologically-based Model for Simulation of Color Vision
Deficiency, 2009, table of severity 1; for tritanopia an approximation."""


class Vision:
    """Shows the colours of a scale as somebody else sees them."""

    changed = Signal()
    """Emitted when other colours are to be shown."""

    def __init__(self) -> None:
        self.kind = ""
        """A key of `KINDS`, empty for colours as they are."""

    def choose(self, kind: str) -> None:
        """Preview a deficiency, or none.

        Parameters
        ----------
        kind : str
            A key of `KINDS`, or empty.
        """
        self.kind = kind
        self.changed.emit()

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
        if not self.kind:
            return made
        found = matrix(self.kind)
        return replace(made, panels=tuple(_panel(one, found) for one in made.panels))


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
    return np.array(KINDS[kind])


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
