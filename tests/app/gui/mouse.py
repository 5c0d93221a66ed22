"""Move the pointer of the screen, and know that the widget has heard of it."""

from pytestqt.exceptions import TimeoutError as NotHeardError
from qtpy.QtCore import QEvent, QObject, QPoint
from qtpy.QtGui import QMouseEvent
from qtpy.QtWidgets import QWidget

_PATIENCE = 500  # ms a busy X server may take; then the move is made again
_TRIES = 40


class _Ear(QObject):
    def __init__(self, widget: QWidget) -> None:
        super().__init__(widget)
        self.last: QPoint | None = None
        widget.installEventFilter(self)

    def eventFilter(self, _: QObject, event: QEvent) -> bool:  # noqa: N802
        if event.type() == QEvent.Type.MouseMove and isinstance(event, QMouseEvent):
            self.last = event.position().toPoint()
        return False


def move(qtbot, widget: QWidget, place: QPoint) -> None:
    """Move the pointer there, and wait until the widget was told.

    QTest only moves the pointer of the X server, which tells the program when it has the time.
    It makes one of several moves, and none of a way there and back: a pointer that is back where
    Qt saw it last has not moved. So one that is not heard of is made again from beside it.
    """
    ear = _Ear(widget)
    try:
        for _ in range(_TRIES):
            qtbot.mouseMove(widget, place)
            try:
                qtbot.waitUntil(lambda: ear.last == place, timeout=_PATIENCE)
            except NotHeardError:
                aside = 1 if place.x() < 2 else -1
                qtbot.mouseMove(widget, place + QPoint(aside, 0))
                continue
            return
        raise AssertionError(f"no move to {place} arrived")
    finally:
        widget.removeEventFilter(ear)
        ear.deleteLater()
