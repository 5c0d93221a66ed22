"""The divider between two ways to show one surface: dragged over the view."""

from typing import Literal

from qtpy.QtCore import QObject, Qt, Signal

from app import wipe_shader
from app.ground import ground
from app.gui.canvas import Canvas, Place
from app.gui.divider import RADIUS, Divider
from app.render import Drawn
from app.scene import Surface, Wipe
from app.wiping import column, line_color

Shown = Literal["both", "first", "second"]
_REACH = 7.0
"""How near to the line a press grabs it, in pixels of a screen at 100 %."""
_SHARES: dict[Shown, float | None] = {"both": None, "first": 1.0, "second": 0.0}


class Swipe(QObject):
    """A tool of the view that moves the divider, and shows one side alone where it is told to.

    Only a number that the shader reads changes while the divider is dragged.

    Parameters
    ----------
    canvas : Canvas
        The view.
    """

    released = Signal(float)
    """Emitted with the divider's place, a share of the surface's width, when a drag ends."""

    def __init__(self, canvas: Canvas) -> None:
        super().__init__(canvas)
        self._canvas = canvas
        self._divider: Divider | None = None
        self._dragging = False
        self._near = False
        self.at = 0.5
        """Where the divider is."""
        self.shown: Shown = "both"
        canvas.filled.connect(self._on_filled)
        canvas.recolored.connect(self._on_recolored)
        canvas.resized.connect(lambda *_: self._place())
        canvas.tools.append(self)

    @property
    def drawn(self) -> Drawn | None:
        """The panel with two ways to show its surface, if there is one."""
        return next((one for one in self._canvas.drawn if _wipe(one) is not None), None)

    def show(self, shown: Shown) -> None:
        """Show both sides, or one of them alone.

        Parameters
        ----------
        shown : str
            Of `Shown`.
        """
        self.shown = shown
        self._place()
        self._canvas.update()

    # What the canvas calls.

    def press(self, place: Place) -> bool:
        """Tell whether the divider is grabbed."""
        if not self._reached(place) or place.button != Qt.MouseButton.LeftButton:
            return False
        self._dragging = True
        return True

    def drag(self, place: Place) -> None:
        """Move the divider."""
        drawn = self.drawn
        if drawn is None:
            return
        left, _, width, _ = drawn.box
        self.at = min(max((place.x - left) / width, 0.0), 1.0)
        self._place()
        self._canvas.stir()

    def release(self, place: Place) -> None:
        """Keep it where it is."""
        self._dragging = False
        if self.drawn is not None:
            self.released.emit(self.at)

    def hover(self, place: Place | None) -> None:
        """Show that the divider can be grabbed."""
        near = place is not None and self._reached(place)
        if near != self._near:
            self._near = near
            if near:
                self._canvas.setCursor(Qt.CursorShape.SplitHCursor)
            else:
                self._canvas.unsetCursor()

    def _reached(self, place: Place) -> bool:
        drawn = self.drawn
        if drawn is None or self.shown != "both":
            return False
        _, bottom, _, height = drawn.box
        scale = self._canvas.devicePixelRatioF()
        aside = abs(place.x - column(drawn.box, self.at))
        above = abs(place.y - bottom - height / 2.0)
        on_line = aside <= _REACH * scale and bottom <= place.y < bottom + height
        return on_line or max(aside, above) <= RADIUS * scale

    def _on_filled(self) -> None:
        self._divider = None
        drawn, made = self.drawn, self._canvas.composition
        if drawn is not None and made is not None:
            grey = line_color(ground(made.session.background))
            self._divider = Divider(grey, self._canvas.devicePixelRatioF())
            self._divider.put(drawn.renderer)
        self._on_recolored()

    def _on_recolored(self) -> None:
        made = self._canvas.composition
        wipes = [_wiped(one.content) for one in made.panels] if made is not None else []
        wipe = next((one for one in wipes if one is not None), None)
        if wipe is not None and not self._dragging:
            self.at = wipe.at
        self._place()

    def _place(self) -> None:
        drawn = self.drawn
        if drawn is None:
            return
        alone = _SHARES[self.shown]
        middle = column(drawn.box, self.at if alone is None else alone)
        wipe_shader.place_all(drawn.renderer, middle)
        if self._divider is not None:
            self._divider.place(drawn.box, self.at, alone is None)


def _wipe(drawn: Drawn) -> Wipe | None:
    return _wiped(drawn.panel.content)


def _wiped(content: object) -> Wipe | None:
    return content.wipe if isinstance(content, Surface) else None
