"""A, B, C and D over the view: which of the compared is where."""

from typing import TYPE_CHECKING, Any

from vtkmodules.vtkRenderingCore import vtkTextActor

from app.contestants import labels
from app.gui.canvas import Canvas
from app.gui.swipe import Swipe
from app.gui.versus import LETTERS
from app.render import Drawn

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer

_SIZE = 15
_EDGE = 0.02
# Width of a letter over the font's size, on the safe side.
_LETTER = 0.6


class Letters:
    """Text in the upper corners of compared surfaces; a picture that is saved has captions.

    Parameters
    ----------
    canvas : Canvas
        The view.
    swipe : Swipe
        Says which side of a wiped surface is seen.
    """

    def __init__(self, canvas: Canvas, swipe: Swipe) -> None:
        self._canvas, self._swipe = canvas, swipe
        self.texts: list[vtkTextActor] = []
        """From left to right, row by row; of a wiped surface both sides'."""
        canvas.filled.connect(self._on_filled)

    def follow(self) -> None:
        """Show the letters of what is seen."""
        if self._swipe.drawn is None:
            return
        for text, side in zip(self.texts, ("first", "second"), strict=True):
            text.SetVisibility(self._swipe.shown in ("both", side))

    @property
    def _size(self) -> float:
        return _SIZE * self._canvas.devicePixelRatioF()

    def _on_filled(self) -> None:
        self.texts = []
        made = self._canvas.composition
        if made is None or made.session.view != "compare":
            return
        named = [f"{a}  {b}" for a, b in zip(LETTERS, labels(made.session), strict=False)]
        wiped = self._swipe.drawn
        if wiped is not None:
            if not self._fit(named[0] + named[1], wiped):
                named = list(LETTERS)
            self._add(wiped.renderer, named[0], _EDGE)
            self._add(wiped.renderer, named[1], 1.0 - _EDGE)
        else:
            for drawn, name in zip(self._canvas.renderers(), named, strict=False):
                self._add(drawn.renderer, name if self._fit(name, drawn) else name[0], _EDGE)
        self.follow()

    def _fit(self, words: str, drawn: Drawn) -> bool:
        return len(words) * _LETTER * self._size < drawn.box[2]

    def _add(self, renderer: "vtkRenderer", words: str, across: float) -> None:
        text = vtkTextActor()
        text.SetInput(words)
        text.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
        text.SetPosition(across, 1.0 - _EDGE)
        style: Any = text.GetTextProperty()
        style.SetFontSize(round(self._size))
        style.SetFontFamilyToArial()
        style.SetVerticalJustificationToTop()
        if across > 0.5:
            style.SetJustificationToRight()
        dark = sum(renderer.GetBackground()) < 1.5
        style.SetColor(*((0.95,) * 3 if dark else (0.05,) * 3))
        style.SetBackgroundColor(*renderer.GetBackground())
        style.SetBackgroundOpacity(0.6)
        renderer.AddViewProp(text)
        self.texts.append(text)
