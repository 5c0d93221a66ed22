"""psi over its argument, with the mesh's vertices as density, and a brush."""

import math

import numpy as np
from qtpy.QtCore import QPointF, QRectF, Qt, Signal
from qtpy.QtGui import QColor, QMouseEvent, QPainter, QPainterPath, QPaintEvent, QPalette, QPen
from qtpy.QtWidgets import QWidget

from lutcore.arrays import FloatArray

_BINS = 96
_INKS = (QColor(213, 60, 50), QColor(0, 150, 90), QColor(60, 110, 220))
_TICKS = (0.0, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0)


class PsiPlot(QWidget):
    """Draws the table and what lies where in it.

    Parameters
    ----------
    parent : QWidget
        Where it lies.
    """

    brushed = Signal(object)
    """Emitted with the two ends of the brush as arguments of psi, None when it is taken away."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setMinimumSize(240, 150)
        self.setAccessibleName("Table of psi, and where the vertices lie in it")
        self._curves: list[tuple[FloatArray, FloatArray]] = []
        self._density: list[FloatArray] = []
        self._reach = 1.0
        self.channel = 0
        self.brush: tuple[float, float] | None = None
        """Ends of the brush, as arguments of psi."""
        self.marks: tuple[float, ...] = ()
        """Arguments of the vertex under the mouse, by channel."""
        self._from: float | None = None

    def show_table(self, curves: list[tuple[FloatArray, FloatArray]], reach: float) -> None:
        """Show another table.

        Parameters
        ----------
        curves : list of tuple of ndarray
            For each channel asinh of the argument, and psi.
        reach : float
            The largest asinh of an argument.
        """
        self._curves, self._reach = curves, reach
        self.update()

    def show_vertices(self, arguments: FloatArray) -> None:
        """Show where the vertices lie.

        Parameters
        ----------
        arguments : ndarray, shape=(3, n)
            See `app.tabulated.table_arguments`.
        """
        edges = np.linspace(0.0, self._reach, _BINS + 1)
        # What lies beyond the table counts in its last bin: psi is 0 there.
        places = np.minimum(np.arcsinh(arguments), self._reach)
        self._density = [np.histogram(row, edges)[0].astype(float) for row in places]
        self.update()

    def show_marks(self, arguments: tuple[float, ...]) -> None:
        """Mark the arguments of one vertex.

        Parameters
        ----------
        arguments : tuple of float
            By channel; none takes the marks away.
        """
        self.marks = arguments
        self.update()

    def across(self, argument: float) -> float:
        """Return where an argument lies.

        Parameters
        ----------
        argument : float
            Of psi.

        Returns
        -------
        float
            Pixels from the left edge.
        """
        frame = self._frame()
        share = min(math.asinh(min(argument, 1e12)) / self._reach, 1.0)
        return frame.left() + share * frame.width()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Draw in the colours of the palette."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        ink = self.palette().color(QPalette.ColorRole.WindowText)
        frame = self._frame()
        painter.setPen(ink)
        if not self._curves:
            painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, "nothing to show yet")
            return
        self._draw_density(painter, frame)
        self._draw_brush(painter, frame)
        self._draw_axes(painter, frame, ink)
        for (t, psi), color in zip(self._curves, _INKS, strict=True):
            top = max(float(curve.max()) for _, curve in self._curves)
            path = QPainterPath()
            for index, (x, y) in enumerate(zip(t, psi, strict=True)):
                at = QPointF(
                    frame.left() + float(x) / self._reach * frame.width(),
                    frame.bottom() - 0.95 * float(y) / top * frame.height(),
                )
                path.moveTo(at) if index == 0 else path.lineTo(at)
            painter.setPen(QPen(color, 2.0))
            painter.drawPath(path)
        for argument, color in zip(self.marks, _INKS, strict=False):
            painter.setPen(QPen(color, 1.5, Qt.PenStyle.DashLine))
            at_x = self.across(argument)
            painter.drawLine(QPointF(at_x, frame.top()), QPointF(at_x, frame.bottom()))

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Begin to brush."""
        self._from = self._argument(event.position().x())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Brush."""
        if self._from is not None:
            ends = sorted((self._from, self._argument(event.position().x())))
            self.brush = ends[0], ends[1]
            self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Tell what was brushed; a click takes the brush away."""
        if self._from == self._argument(event.position().x()):
            self.brush = None
        self._from = None
        self.update()
        self.brushed.emit(self.brush)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Take the brush away."""
        self._from = self.brush = None
        self.update()
        self.brushed.emit(None)

    def _argument(self, x: float) -> float:
        frame = self._frame()
        share = (x - frame.left()) / frame.width()
        if share >= 1.0:
            return math.inf  # all that lies beyond the table
        return math.sinh(max(share, 0.0) * self._reach)

    def _frame(self) -> QRectF:
        letters = self.fontMetrics()
        left, below = letters.height() * 1.6, letters.height() * 2.4
        return QRectF(left, 6.0, self.width() - left - 10.0, self.height() - below - 6.0)

    def _draw_density(self, painter: QPainter, frame: QRectF) -> None:
        if not self._density:
            return
        counts = np.log1p(self._density[self.channel])
        most = max(float(counts.max()), 1e-9)
        color = QColor(_INKS[self.channel])
        color.setAlphaF(0.25)
        width = frame.width() / _BINS
        for index, count in enumerate(counts):
            height = 0.95 * float(count) / most * frame.height()
            left = frame.left() + index * width
            painter.fillRect(QRectF(left, frame.bottom() - height, width, height), color)

    def _draw_brush(self, painter: QPainter, frame: QRectF) -> None:
        if self.brush is None:
            return
        low, high = (self.across(end) for end in self.brush)
        color = self.palette().color(QPalette.ColorRole.Highlight)
        color.setAlphaF(0.35)
        painter.fillRect(QRectF(low, frame.top(), max(high - low, 2.0), frame.height()), color)

    def _draw_axes(self, painter: QPainter, frame: QRectF, ink: QColor) -> None:
        painter.setPen(ink)
        painter.drawLine(frame.bottomLeft(), frame.bottomRight())
        letters = self.fontMetrics()
        height, last = float(letters.height()), -100.0
        for value in _TICKS:
            if math.asinh(value) > self._reach:
                break
            at, words = self.across(value), f"{value:g}"
            if at - last < letters.horizontalAdvance(words) + 8.0:
                continue
            last = at
            painter.drawLine(QPointF(at, frame.bottom()), QPointF(at, frame.bottom() + 4.0))
            box = QRectF(at - 40.0, frame.bottom() + 4.0, 80.0, height)
            painter.drawText(box, Qt.AlignmentFlag.AlignHCenter, words)
        below = QRectF(frame.left(), frame.bottom() + height + 4.0, frame.width(), height)
        title = "|N.w| / (l_u |S+ w|); bars: vertices, logarithmic"
        painter.drawText(below, Qt.AlignmentFlag.AlignHCenter, title)
        painter.save()
        painter.rotate(-90.0)
        beside = QRectF(-frame.bottom(), 2.0, frame.height(), height)
        painter.drawText(beside, Qt.AlignmentFlag.AlignHCenter, "psi")
        painter.restore()
