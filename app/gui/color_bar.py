"""A colour bar with the values' histogram in it and ends that can be dragged."""

import numpy as np
from qtpy.QtCore import QPointF, QRectF, QSize, Qt, Signal
from qtpy.QtGui import (
    QColor,
    QLinearGradient,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPolygonF,
)
from qtpy.QtWidgets import QSizePolicy, QWidget

from app.gui.distribution import Distribution
from lutcore.arrays import FloatArray

# In letters' heights: the whole, the strip of plain colours, a grip, and how near is on it.
_HEIGHT, _STRIP, _GRIP, _NEAR = 6.0, 0.9, 0.55, 0.9
_STOPS = 32
_DIM = 70  # of 255: the map behind the columns
_MARGIN = 0.06  # beyond both ends, to drag them outwards
_LEAST_WIDTH = 0.005  # of the span, between the ends


class ColorBar(QWidget):
    """Shows how values become colours, and lets the ends be dragged.

    Parameters
    ----------
    parent : QWidget, optional
        Where it lies.
    """

    ranged = Signal(float, float)
    """Emitted with the ends while one is dragged."""
    pressed = Signal()
    """Emitted when a drag begins."""
    released = Signal()
    """Emitted when a drag ends."""
    automatic = Signal()
    """Emitted at a double click."""
    pointed = Signal(object)
    """Emitted with the value under the mouse, None when it leaves."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._found: Distribution | None = None
        self._colors: FloatArray = np.zeros((2, 3))
        self._ends = (0.0, 1.0)
        self._span = (0.0, 1.0)
        self._held: int | None = None
        self._words = ""
        self.setMouseTracking(True)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setAccessibleName("Colour bar")
        self.setAccessibleDescription("Histogram of the values; the ends of its range are dragged")
        self.setToolTip("Drag the ends of the range; double click for the automatic one")

    @property
    def ends(self) -> tuple[float, float]:
        """The range that is shown."""
        return self._ends

    def show_nothing(self, words: str) -> None:
        """Show words instead of a bar.

        Parameters
        ----------
        words : str
            Why there is none.
        """
        self._found, self._words = None, words
        self.update()

    def follow(self, found: Distribution, colors: FloatArray, ends: tuple[float, float]) -> None:
        """Show values, a map and a range, without telling anybody.

        Parameters
        ----------
        found : Distribution
            The values.
        colors : ndarray, shape=(entries, 3)
            From the low end to the high end, 0 to 1.
        ends : tuple of 2 floats
            The range.
        """
        self._found, self._colors, self._ends = found, colors, ends
        if self._held is None:  # what is dragged must not move away from under the mouse
            edges = found.histogram.edges
            low, high = min(edges[0], ends[0]), max(edges[-1], ends[1])
            beyond = _MARGIN * (high - low)
            self._span = float(low - beyond), float(high + beyond)
        self.update()

    def sizeHint(self) -> QSize:  # noqa: N802
        """Ask for some letters' heights."""
        return QSize(12 * self.fontMetrics().height(), round(_HEIGHT * self.fontMetrics().height()))

    def x_of(self, value: float) -> float:
        """Return where a value lies, in the widget's own units.

        Parameters
        ----------
        value : float
            In the values' unit.

        Returns
        -------
        float
            From the left.
        """
        low, high = self._span
        return (value - low) / (high - low) * self.width()

    def _value_at(self, x: float) -> float:
        low, high = self._span
        return low + min(max(x / self.width(), 0.0), 1.0) * (high - low)

    # What Qt calls.

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Take the nearer end, if one is near."""
        self._held = self._near(event.position().x())
        if event.button() == Qt.MouseButton.LeftButton and self._held is not None:
            self.pressed.emit()
        else:
            self._held = None

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Drag an end, or tell the value."""
        if self._found is None:
            return
        value = self._value_at(event.position().x())
        self.pointed.emit(value)
        if self._held is None:
            near = self._near(event.position().x()) is not None
            self.setCursor(Qt.CursorShape.SizeHorCursor if near else Qt.CursorShape.ArrowCursor)
            return
        least = _LEAST_WIDTH * (self._span[1] - self._span[0])
        low, high = self._ends
        if self._held == 0:
            low = min(value, high - least)
        else:
            high = max(value, low + least)
        self._ends = low, high
        self.update()
        self.ranged.emit(low, high)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """End a drag."""
        if self._held is not None:
            self._held = None
            if self._found is not None:
                self.follow(self._found, self._colors, self._ends)
            self.released.emit()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Ask for the automatic range."""
        if self._found is not None:
            self.automatic.emit()

    def leaveEvent(self, event: object) -> None:  # noqa: N802
        """Tell that the mouse is gone."""
        self.pointed.emit(None)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Draw the map, the columns and the ends."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self._found is None:
            painter.setPen(self.palette().placeholderText().color())
            flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
            painter.drawText(QRectF(self.rect()), flags, self._words)
            return
        letter = float(self.fontMetrics().height())
        bottom = self.height() - _GRIP * letter
        bar = QRectF(0.0, 0.0, float(self.width()), bottom)
        painter.fillRect(bar, self.palette().base())
        painter.fillRect(bar, self._gradient(_DIM))
        self._paint_columns(painter, bottom - _STRIP * letter)
        strip = QRectF(0.0, bottom - _STRIP * letter, float(self.width()), _STRIP * letter)
        painter.fillRect(strip, self._gradient(255))
        for value in self._ends:
            self._paint_end(painter, self.x_of(value), bottom, _GRIP * letter)

    def _paint_columns(self, painter: QPainter, base: float) -> None:
        assert self._found is not None
        counted = self._found.histogram
        most = max(int(counted.counts.max()), 1)
        middles = 0.5 * (counted.edges[1:] + counted.edges[:-1])
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        for left, right, middle, count in zip(
            counted.edges[:-1], counted.edges[1:], middles, counted.counts, strict=True
        ):
            height = base * float(count) / most
            x = self.x_of(float(left))
            column = QRectF(x, base - height, self.x_of(float(right)) - x, height)
            painter.fillRect(column, self._color(float(middle)))
        painter.restore()

    def _paint_end(self, painter: QPainter, x: float, bottom: float, grip: float) -> None:
        ink = self.palette().windowText().color()
        painter.setPen(QPen(self.palette().window().color(), 3.0))
        painter.drawLine(QPointF(x, 0.0), QPointF(x, bottom))
        painter.setPen(QPen(ink, 1.0))
        painter.drawLine(QPointF(x, 0.0), QPointF(x, bottom))
        painter.setBrush(ink)
        corners = [
            QPointF(x, bottom - grip),
            QPointF(x + grip, bottom + grip),
            QPointF(x - grip, bottom + grip),
        ]
        painter.drawPolygon(QPolygonF(corners))

    def _gradient(self, alpha: int) -> QLinearGradient:
        low, high = self._ends
        gradient = QLinearGradient(self.x_of(low), 0.0, self.x_of(high), 0.0)
        for share in np.linspace(0.0, 1.0, _STOPS):
            color = self._color(low + share * (high - low))
            color.setAlpha(alpha)
            gradient.setColorAt(float(share), color)
        return gradient

    def _color(self, value: float) -> QColor:
        low, high = self._ends
        share = min(max((value - low) / (high - low), 0.0), 1.0)
        red, green, blue = self._colors[round(share * (len(self._colors) - 1))]
        return QColor.fromRgbF(float(red), float(green), float(blue))

    def _near(self, x: float) -> int | None:
        if self._found is None:
            return None
        away = [abs(self.x_of(end) - x) for end in self._ends]
        nearest = 0 if away[0] < away[1] else 1
        # Where both lie on one another the one is taken that can go this way.
        if away[0] == away[1]:
            nearest = 0 if x < self.x_of(self._ends[0]) else 1
        near = away[nearest] <= _NEAR * self.fontMetrics().height()
        return nearest if near else None
