"""A shaded ball on which each directional light is a dot to drag."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from qtpy.QtCore import QPointF, QRectF, QSize, Qt, Signal
from qtpy.QtGui import QColor, QImage, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from qtpy.QtWidgets import QSizePolicy, QWidget

from app.gui.aiming import from_ball, on_ball, turned
from app.gui.display import encoded
from app.gui.lights import displayed
from app.session import Vector

_LINES = 11  # its least height, in lines of text
_MARGIN = 0.86  # radius of the ball over half the widget: dots on the rim stay inside
_DOT = 0.35  # radius of a dot in lines of text
_NUDGE = 1.0 / 36.0  # of half a turn: 5 degrees
_KEYS = {
    Qt.Key.Key_Left: (-_NUDGE, 0.0),
    Qt.Key.Key_Right: (_NUDGE, 0.0),
    Qt.Key.Key_Up: (0.0, _NUDGE),
    Qt.Key.Key_Down: (0.0, -_NUDGE),
}


class Ball(QWidget):
    """Shows where directional lights come from, seen as the mesh is, and lets them be dragged."""

    grabbed = Signal(int)
    """Emitted with a light's number when its dot is pressed."""
    aimed = Signal(object)
    """Emitted with the direction, in the camera's axes, while a dot is dragged."""
    released = Signal()
    """Emitted when the drag ends."""

    def __init__(self) -> None:
        super().__init__()
        self._lights: list[tuple[int, Vector, Vector]] = []
        self._chosen = -1
        self._dragged = False
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        self.setAccessibleName("Ball of lights")
        self.setToolTip(
            "Drag a dot to turn a directional light; beyond the rim it goes to the far side. "
            "The arrow keys turn the chosen one by 5\N{DEGREE SIGN}."
        )

    def show_lights(self, lights: Sequence[tuple[int, Vector, Vector]], chosen: int) -> None:
        """Show these lights.

        Parameters
        ----------
        lights : sequence of (int, direction, rgb)
            Number, direction to the light in the camera's axes, linear irradiance.
        chosen : int
            The number of the one that is chosen.
        """
        self._lights, self._chosen = list(lights), chosen
        self.update()

    def sizeHint(self) -> QSize:  # noqa: N802
        """Return a square of some lines of text."""
        side = _LINES * self.fontMetrics().height()
        return QSize(side, side)

    def minimumSizeHint(self) -> QSize:  # noqa: N802
        """Return the same."""
        return self.sizeHint()

    def place(self, direction: Vector) -> QPointF:
        """Return where a direction's dot is.

        Parameters
        ----------
        direction : tuple of 3 floats
            In the camera's axes.

        Returns
        -------
        QPointF
            In the widget.
        """
        x, y, _ = on_ball(direction)
        radius = self._radius()
        return QPointF(self.width() / 2.0 + radius * x, self.height() / 2.0 - radius * y)

    def paintEvent(self, event: QPaintEvent | None) -> None:  # noqa: N802
        """Draw the ball as the lights show it, and a dot for each: a ring on the far side."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        radius = self._radius()
        middle = QPointF(self.width() / 2.0, self.height() / 2.0)
        box = QRectF(middle.x() - radius, middle.y() - radius, 2.0 * radius, 2.0 * radius)
        pixels = _shaded(max(round(2.0 * radius * self.devicePixelRatioF()), 2), self._lights)
        side = len(pixels)
        image = QImage(pixels.data, side, side, 4 * side, QImage.Format.Format_RGBA8888)
        painter.drawImage(box, image)
        size = _DOT * self.fontMetrics().height()
        for number, direction, rgb in self._lights:
            at = self.place(direction)
            chosen = number == self._chosen
            accent = self.palette().highlight().color()
            painter.setPen(QPen(QColor("black"), size / 2.5))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawEllipse(at, size, size)
            painter.setPen(QPen(accent if chosen else QColor("white"), size / 4.0))
            if direction[2] >= 0.0:
                painter.setBrush(QColor.fromRgbF(*displayed(rgb)))
            painter.drawEllipse(at, size, size)
            if chosen:
                painter.setBrush(Qt.BrushStyle.NoBrush)
                painter.drawEllipse(at, 1.6 * size, 1.6 * size)
        if self.hasFocus():
            painter.setPen(QPen(self.palette().highlight().color(), 1.0, Qt.PenStyle.DotLine))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawEllipse(middle, 1.06 * radius, 1.06 * radius)
        painter.end()

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Take the nearest dot; elsewhere on the ball the chosen light jumps there."""
        at = event.position()
        near = [
            (float(np.hypot(*_step(self.place(direction), at))), number)
            for number, direction, _ in self._lights
        ]
        if not near:
            return
        distance, number = min(near)
        hit = distance <= 2.0 * _DOT * self.fontMetrics().height()
        if not hit and all(self._chosen != found for _, found in near):
            return
        self._dragged = True
        self.grabbed.emit(number if hit else self._chosen)
        if not hit:
            self._aim(at)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Turn the light that is dragged."""
        if self._dragged:
            self._aim(event.position())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """End the drag."""
        if self._dragged:
            self._dragged = False
            self.released.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802
        """Turn the chosen light by the arrow keys."""
        way = _KEYS.get(Qt.Key(event.key()))
        found = [direction for number, direction, _ in self._lights if number == self._chosen]
        if way is None or not found:
            event.ignore()
            return
        self.aimed.emit(turned(found[0], *way))

    def _aim(self, at: QPointF) -> None:
        right, down = _step(QPointF(self.width() / 2.0, self.height() / 2.0), at)
        self.aimed.emit(from_ball(right / self._radius(), -down / self._radius()))

    def _radius(self) -> float:
        return _MARGIN * min(self.width(), self.height()) / 2.0


def _step(start: QPointF, end: QPointF) -> tuple[float, float]:
    return end.x() - start.x(), end.y() - start.y()


def _shaded(side: int, lights: Sequence[tuple[int, Vector, Vector]]) -> NDArray[np.uint8]:
    """Return a matt ball under the lights, RGBA."""
    line = (2.0 * np.arange(side) + 1.0) / side - 1.0
    x, y = np.meshgrid(line, -line)
    inside = x * x + y * y <= 1.0
    z = np.sqrt(np.maximum(1.0 - x * x - y * y, 0.0))
    normals = np.stack([x, y, z], axis=-1)
    light = np.full((side, side, 3), 0.03)
    for _, direction, rgb in lights:
        towards = np.asarray(direction) / np.linalg.norm(direction)
        light += np.maximum(normals @ towards, 0.0)[..., None] * np.asarray(rgb)
    exposure = 0.8 / max(1.0, *(max(rgb) for *_, rgb in lights)) if lights else 0.8
    pixels = np.zeros((side, side, 4), dtype=np.uint8)
    pixels[..., :3] = np.rint(255.0 * encoded(exposure * light))
    pixels[..., 3] = np.where(inside, 255, 0)
    return pixels
