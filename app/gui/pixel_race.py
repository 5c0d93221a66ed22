"""Which is faster here: shading at vertices or at pixels, measured in the view itself."""

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf

from qtpy.QtCore import QObject, QTimer

from app.camera import axes
from app.composition import Composition
from app.gui.canvas import Canvas
from app.leaving import leaving
from app.pipeline import Pipeline
from app.shader.look import PixelLook

# The first of each compiles, and sends the mesh; of the others the fastest counts.
_FRAMES = 3
# Where a frame takes longer the coarse mesh is drawn for it: nobody waits for a race.
_LONG = 0.1


@dataclass(frozen=True)
class Contest:
    """Seconds from a movement to its frame.

    Parameters
    ----------
    computing : float
        Of one light at all vertices, as it is while it is dragged.
    vertex : float
        To send colours, and draw.
    pixel : float
        To set uniforms, and draw; infinite where it was not tried.
    """

    computing: float
    vertex: float
    pixel: float

    @property
    def pixels_win(self) -> bool:
        """Whether the shader is faster."""
        return self.pixel < self.computing + self.vertex

    @property
    def label(self) -> str:
        """The times in words."""
        vertex, pixel = 1e3 * (self.computing + self.vertex), 1e3 * self.pixel
        if self.pixel == inf:
            return f"at vertices: {vertex:.0f} ms for each step of a light, too slow to compare"
        return f"at vertices {vertex:.0f} ms for each step of a light, at pixels {pixel:.0f} ms"


def step_seconds(made: Composition, pipeline: Pipeline) -> float:
    """Return the seconds in which the colours for one light that moved are computed.

    Parameters
    ----------
    made : Composition
        A shaded picture.
    pipeline : Pipeline
        Where its arrays came from.

    Returns
    -------
    float
        0 where there is no light.
    """
    from lutcore.color import product_bytes
    from lutcore.exitance import exitance

    session, frame = made.session, axes(made.camera)
    if not session.lights or made.exposure is None:
        return 0.0
    model = pipeline.settled(session, session.model, frame)
    inputs = pipeline.inputs(session, frame)
    draft = pipeline.draft(session, model, frame)
    alone = replace(inputs, lights=inputs.lights[:1])
    factor = leaving(session, pipeline, made.camera)
    seconds = []
    for _ in range(_FRAMES):
        start = time.perf_counter()
        light = exitance(model, alone) if draft is None else draft.exitance(alone.lights)
        product_bytes(light, factor, made.exposure)
        seconds.append(time.perf_counter() - start)
    return min(seconds)


class PixelRace(QObject):
    """Draws the view a few times in both ways, a frame for each turn of the event loop.

    Where the mesh is slow to draw, its coarse stand-in is drawn, smaller and unseen, and the mesh
    is taken to be slower by the same factor in both ways; where there is none, the vertices win,
    unless the last frame was slow by chance.

    Parameters
    ----------
    canvas : Canvas
        Shows the picture, at vertices; so it does when the race ends.
    look : PixelLook
        The same for pixels.
    computing : float
        See `Contest`.
    move : callable
        Sets the uniforms.
    done : callable
        Gets the `Contest`, unless the race was stopped.
    """

    def __init__(
        self,
        canvas: Canvas,
        look: PixelLook,
        computing: float,
        move: Callable[[], None],
        done: Callable[[Contest], None],
    ) -> None:
        super().__init__(canvas)
        self._canvas, self._look, self._computing = canvas, look, computing
        self._move, self._done = move, done
        self._seconds: dict[bool, list[float]] = {False: [], True: []}
        self._drawn_again = 0
        self._timer = QTimer(self)
        self._timer.timeout.connect(self._frame)
        self._timer.start(0)

    def stop(self) -> None:
        """End it without a result."""
        self._timer.stop()
        self._canvas.shade_by_pixel(None)
        self.deleteLater()

    def _frame(self) -> None:
        canvas = self._canvas
        if canvas.coarsely or not canvas.isVisible():
            return  # something moves: later
        slow = canvas.seconds > _LONG
        if slow and not canvas.has_coarse:
            # It may have been the first, or held up by others.
            if self._drawn_again < _FRAMES:
                self._drawn_again += 1
                canvas.repaint()
            else:
                self._end(canvas.seconds, inf)
            return
        by_pixel = len(self._seconds[False]) == _FRAMES
        if by_pixel and canvas.by_pixel is None:
            canvas.shade_by_pixel(self._look)
        start = time.perf_counter()
        if by_pixel:
            self._move()
        elif not slow:
            canvas.resend()
        if slow:
            canvas.draw_unseen()
        else:
            canvas.window_.Render()
            canvas.window_.WaitForCompletion()
        self._seconds[by_pixel].append(time.perf_counter() - start)
        if len(self._seconds[True]) == _FRAMES:
            vertex, pixel = (min(self._seconds[one][1:]) for one in (False, True))
            longer = canvas.seconds / vertex if slow else 1.0
            self._end(longer * vertex, longer * pixel)

    def _end(self, vertex: float, pixel: float) -> None:
        self.stop()
        self._done(Contest(self._computing, vertex, pixel))
