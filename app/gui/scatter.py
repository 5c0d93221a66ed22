"""A chart of points on two logarithmic axes, to look at and to click."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from qtpy.QtCore import QPointF, QRectF, QSize, Qt, Signal
from qtpy.QtGui import QColor, QMouseEvent, QPainter, QPaintEvent, QPalette, QPen
from qtpy.QtWidgets import QToolTip, QWidget

_REACH = 12.0  # pixels from a point that still count as on it


@dataclass(frozen=True)
class Dot:
    """One point of the chart.

    Parameters
    ----------
    label : str
        What it is.
    x, y : float
        Where, both positive; `y` nan draws it hollow at the upper edge.
    middle : float
        Where the line ends that begins at `y`: its spread.
    good : bool
        Whether it is on the good side of the line.
    chosen : bool
        Whether it is the recommended one.
    current : bool
        Whether it is in use now.
    front : bool
        Whether nothing beats it in both.
    words : str
        What a tool tip says.
    """

    label: str
    x: float
    y: float
    middle: float
    good: bool = True
    chosen: bool = False
    current: bool = False
    front: bool = False
    words: str = ""


class Scatter(QWidget):
    """Draws dots, their front and a line, and tells which dot is clicked.

    Parameters
    ----------
    parent : QWidget
        Where it lies.
    x_title, y_title : str
        What the axes are, with units.
    """

    picked = Signal(int)
    """Emitted with the index of the dot that was clicked."""

    def __init__(self, parent: QWidget, x_title: str, y_title: str) -> None:
        super().__init__(parent)
        self._titles = x_title, y_title
        self.dots: Sequence[Dot] = ()
        self._line: float | None = None
        self.setMouseTracking(True)
        self.setMinimumSize(QSize(220, 160))

    def sizeHint(self) -> QSize:  # noqa: N802
        """Return room in which dots and their names stand apart."""
        return QSize(480, 270)

    def show_dots(self, dots: Sequence[Dot], line: float | None) -> None:
        """Show other dots.

        Parameters
        ----------
        dots : sequence of Dot
            What to show.
        line : float or None
            Where a dashed line lies, on the vertical axis.
        """
        self.dots, self._line = tuple(dots), line
        self.setAccessibleDescription("; ".join(dot.words or dot.label for dot in dots))
        self.update()

    def place(self, index: int) -> QPointF:
        """Return where a dot is.

        Parameters
        ----------
        index : int
            Of the dot.

        Returns
        -------
        QPointF
            In the widget.
        """
        return self._at(self.dots[index], self._frame(), *self._ends())

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Draw the chart in the colours of the palette."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        ink = self.palette().color(QPalette.ColorRole.WindowText)
        faint = QColor(ink)
        faint.setAlphaF(0.25)
        frame = self._frame()
        painter.setPen(ink)
        if not self.dots:
            painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, "nothing to show yet")
            return
        ends = self._ends()
        self._draw_axes(painter, frame, *ends, ink, faint)
        self._draw_front(painter, frame, ends, ink)
        for dot in self.dots:
            self._draw_dot(painter, dot, frame, ends, ink)
        places = [self._at(dot, frame, *ends) for dot in self.dots]
        taken = [QRectF(at.x() - 6.0, at.y() - 6.0, 12.0, 12.0) for at in places]
        # What matters most gets its label first.
        order = sorted(
            range(len(self.dots)),
            key=lambda i: (
                not self.dots[i].chosen,
                not self.dots[i].current,
                not self.dots[i].front,
            ),
        )
        for index in order:
            self._draw_label(painter, self.dots[index].label, places[index], frame, taken)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Say what is under the mouse."""
        index = self._under(event.position())
        over = index is not None
        self.setCursor(Qt.CursorShape.PointingHandCursor if over else Qt.CursorShape.ArrowCursor)
        if index is not None:
            QToolTip.showText(event.globalPosition().toPoint(), self.dots[index].words, self)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Tell which dot was clicked."""
        index = self._under(event.position())
        if index is not None and event.button() == Qt.MouseButton.LeftButton:
            self.picked.emit(index)

    def _under(self, at: QPointF) -> int | None:
        away = [
            (math.hypot(at.x() - place.x(), at.y() - place.y()), index)
            for index, place in ((i, self.place(i)) for i in range(len(self.dots)))
        ]
        distance, index = min(away, default=(math.inf, 0))
        return index if distance <= _REACH else None

    def _frame(self) -> QRectF:
        letters = self.fontMetrics()
        left = letters.horizontalAdvance("0.0001") + letters.height() * 1.6
        below = letters.height() * 2.6
        return QRectF(
            left,
            letters.height(),
            self.width() - left - 10.0,
            self.height() - below - letters.height(),
        )

    def _ends(self) -> tuple[tuple[float, float], tuple[float, float]]:
        x = [math.log10(dot.x) for dot in self.dots]
        y = [math.log10(end) for dot in self.dots for end in (dot.y, dot.middle) if end > 0.0]
        if self._line is not None:
            y.append(math.log10(self._line))
        room = 0.08 * (max(x) - min(x)) + 0.1
        above = 0.1 * (max(y, default=0.0) - min(y, default=0.0)) + 0.1
        return (min(x) - room, max(x) + 3.0 * room), (
            min(y, default=0.0) - above,
            max(y, default=0.0) + 1.5 * above,
        )

    def _at(
        self, dot: Dot, frame: QRectF, x: tuple[float, float], y: tuple[float, float]
    ) -> QPointF:
        right = (math.log10(dot.x) - x[0]) / (x[1] - x[0])
        up = (math.log10(dot.y) - y[0]) / (y[1] - y[0]) if dot.y > 0.0 else 1.0
        return QPointF(frame.left() + right * frame.width(), frame.bottom() - up * frame.height())

    def _draw_axes(
        self,
        painter: QPainter,
        frame: QRectF,
        x: tuple[float, float],
        y: tuple[float, float],
        ink: QColor,
        faint: QColor,
    ) -> None:
        height = float(self.fontMetrics().height())
        for value in _ticks(*x):
            at = frame.left() + (math.log10(value) - x[0]) / (x[1] - x[0]) * frame.width()
            painter.setPen(faint)
            painter.drawLine(QPointF(at, frame.top()), QPointF(at, frame.bottom()))
            painter.setPen(ink)
            box = QRectF(at - 40.0, frame.bottom() + 1.0, 80.0, height)
            painter.drawText(box, Qt.AlignmentFlag.AlignHCenter, f"{value:g}")
        for value in _ticks(*y):
            at = frame.bottom() - (math.log10(value) - y[0]) / (y[1] - y[0]) * frame.height()
            painter.setPen(faint)
            painter.drawLine(QPointF(frame.left(), at), QPointF(frame.right(), at))
            painter.setPen(ink)
            box = QRectF(0.0, at - height / 2.0, frame.left() - 4.0, height)
            painter.drawText(box, Qt.AlignmentFlag.AlignRight, f"{value:g}")
        below = QRectF(frame.left(), frame.bottom() + height + 2.0, frame.width(), height + 2.0)
        painter.drawText(below, Qt.AlignmentFlag.AlignHCenter, self._titles[0])
        painter.save()
        painter.rotate(-90.0)
        # All of the height there is: the frame alone may be shorter than the words.
        beside = QRectF(-float(self.height()), 1.0, float(self.height()), height)
        painter.drawText(beside, Qt.AlignmentFlag.AlignHCenter, self._titles[1])
        painter.restore()
        if self._line is not None:
            up = (math.log10(self._line) - y[0]) / (y[1] - y[0])
            at = frame.bottom() - up * frame.height()
            painter.setPen(QPen(ink, 1.0, Qt.PenStyle.DashLine))
            painter.drawLine(QPointF(frame.left(), at), QPointF(frame.right(), at))

    def _draw_front(
        self,
        painter: QPainter,
        frame: QRectF,
        ends: tuple[tuple[float, float], tuple[float, float]],
        ink: QColor,
    ) -> None:
        front = sorted((dot for dot in self.dots if dot.front), key=lambda dot: dot.x)
        painter.setPen(QPen(ink, 1.0, Qt.PenStyle.DotLine))
        places = [self._at(dot, frame, *ends) for dot in front]
        for one, other in pairwise(places):
            corner = QPointF(other.x(), one.y())
            painter.drawLine(one, corner)
            painter.drawLine(corner, other)

    def _draw_dot(
        self,
        painter: QPainter,
        dot: Dot,
        frame: QRectF,
        ends: tuple[tuple[float, float], tuple[float, float]],
        ink: QColor,
    ) -> None:
        at = self._at(dot, frame, *ends)
        color = QColor(0, 158, 115) if dot.good else QColor(213, 94, 0)
        if dot.middle > 0.0:
            painter.setPen(QPen(color, 1.0))
            middle = min(self._at(replace(dot, y=dot.middle), frame, *ends).y(), frame.bottom())
            painter.drawLine(at, QPointF(at.x(), middle))
        painter.setPen(QPen(color, 2.0))
        painter.setBrush(color if dot.y > 0.0 else Qt.BrushStyle.NoBrush)
        painter.drawEllipse(at, 4.0, 4.0)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(ink, 1.5))
        if dot.chosen:
            painter.drawEllipse(at, 9.0, 9.0)
        if dot.current:
            painter.drawRect(QRectF(at.x() - 7.0, at.y() - 7.0, 14.0, 14.0))

    def _draw_label(
        self, painter: QPainter, label: str, at: QPointF, frame: QRectF, taken: list[QRectF]
    ) -> None:
        """Write a label where there is room for it, else not."""
        letters = self.fontMetrics()
        width, height = letters.horizontalAdvance(label), letters.height()
        for right, up in (
            (9.0, -height / 2.0),
            (9.0, -height),
            (9.0, 0.0),
            (-width - 9.0, -height),
        ):
            box = QRectF(at.x() + right, at.y() + up, width, height)
            inside = box.left() > frame.left() and box.right() < self.width()
            if inside and not any(box.intersects(other) for other in taken):
                ground = self.palette().color(QPalette.ColorRole.Window)
                ground.setAlphaF(0.8)  # lines below go on, but do not strike it out
                painter.fillRect(box, ground)
                painter.drawText(box, 0, label)
                taken.append(box)
                return


def _ticks(low: float, high: float) -> list[float]:
    """Return round numbers between two powers of ten."""
    steps = (1.0, 2.0, 5.0) if high - low < 2.5 else (1.0,)
    found = [
        step * 10.0**power
        for power in range(math.floor(low), math.ceil(high) + 1)
        for step in steps
        if low <= math.log10(step) + power <= high
    ]
    # Beyond five decades not every one has room.
    return found[:: -(-len(found) // 8)] if len(found) > 8 else found
