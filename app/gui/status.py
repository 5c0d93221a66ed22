"""What draws the view and how fast, at the end of the status bar."""

from collections.abc import Callable

from qtpy.QtWidgets import QLabel

from app.gui.canvas import Canvas

_SHARE = 0.2  # weight of the newest frame in the figure shown


class Status(QLabel):
    """Says how colours come to the screen, who draws, and the time of a frame.

    Parameters
    ----------
    canvas : Canvas
        The view.
    reason : callable
        Says why colours come from the vertices, if they do.
    """

    def __init__(self, canvas: Canvas, reason: Callable[[], str]) -> None:
        super().__init__(canvas)
        self._reason = reason
        self._canvas = canvas
        self._seconds = 0.0
        self.setAccessibleName("What draws, and the time of a frame")
        canvas.drew.connect(self._on_drew)

    def _on_drew(self, seconds: float) -> None:
        backend = self._canvas.backend
        if backend is None:
            return
        first = self._seconds == 0.0
        self._seconds = seconds if first else (1.0 - _SHARE) * self._seconds + _SHARE * seconds
        name = backend.renderer.partition(" (")[0]
        path = "per vertex" if self._canvas.by_pixel is None else "per pixel"
        self.setText(f"{path}, {name}, {1e3 * self._seconds:.0f} ms")
        self.setToolTip("\n".join(filter(None, (backend.label, self._reason()))))
