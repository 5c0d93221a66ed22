"""Move the pointer of the screen, and know that the widget has heard of it."""

from collections.abc import Callable
from contextlib import suppress

from pytestqt.exceptions import TimeoutError as NotYetError
from qtpy.QtCore import QEvent, QObject, QPoint
from qtpy.QtGui import QCursor, QMouseEvent
from qtpy.QtWidgets import QWidget

_PATIENCE = 500  # ms a busy X server may take; then the move is made again
_ANSWER = 10_000  # ms that what follows from the move may take until then
_TRIES = 24


class _Ear(QObject):
    def __init__(self, widget: QWidget) -> None:
        super().__init__(widget)
        self.last: QPoint | None = None
        widget.installEventFilter(self)

    def eventFilter(self, _: QObject, event: QEvent) -> bool:  # noqa: N802
        if event.type() == QEvent.Type.MouseMove and isinstance(event, QMouseEvent):
            self.last = event.position().toPoint()
        return False


def move(qtbot, widget: QWidget, place: QPoint, until: Callable[[], bool] | None = None) -> None:
    """Move the pointer there, and wait until the widget was told, or for what follows from it.

    QTest only moves the pointer of the X server, which tells the program when it has the time. It
    tells of several moves as of one, and of none that ends where Qt saw the pointer last; and that
    the pointer left a widget whose size has changed may be told after it came. So a move without
    effect is made again, from beside it; and so is one to where the pointer is already.
    """
    ear, aside = _Ear(widget), place + QPoint(1 if place.x() < 2 else -1, 0)
    done, patience = until or (lambda: ear.last == place), _ANSWER if until else _PATIENCE
    try:
        if widget.mapFromGlobal(QCursor.pos()) == place:
            _send(qtbot, widget, aside)
            with suppress(NotYetError):
                qtbot.waitUntil(lambda: ear.last == aside, timeout=_PATIENCE)
        for _ in range(_TRIES):
            _send(qtbot, widget, place)
            try:
                qtbot.waitUntil(done, timeout=patience)
            except NotYetError:
                _send(qtbot, widget, aside)
                continue
            return
        raise AssertionError(f"no move to {place} had an effect")
    finally:
        widget.removeEventFilter(ear)
        ear.deleteLater()


def _send(qtbot, widget: QWidget, place: QPoint) -> None:
    qtbot.mouseMove(widget, place)
    QCursor.pos()  # the X server answers after the move, however busy: patience begins here
