"""Two ways to show one surface in turn: what differs between them moves."""

from qtpy.QtCore import QObject, QTimer, Signal

from app.gui.swipe import Swipe

SLOWEST, FASTEST, FIRST = 0.5, 10.0, 2.0
"""Pictures in a second."""


class Flicker(QObject):
    """Shows the first and the second in turn, by a clock or by hand.

    Parameters
    ----------
    swipe : Swipe
        Of the view.
    """

    changed = Signal()
    """Emitted when it starts, stops or shows the other."""

    def __init__(self, swipe: Swipe) -> None:
        super().__init__(swipe)
        self._swipe = swipe
        self._clock = QTimer(self)
        self._clock.timeout.connect(self.turn)
        self.set_rate(FIRST)

    @property
    def on(self) -> bool:
        """Whether one is shown alone, turned by the clock or by hand."""
        return self._swipe.shown != "both"

    @property
    def running(self) -> bool:
        """Whether the clock turns."""
        return self._clock.isActive()

    @property
    def rate(self) -> float:
        """Pictures in a second."""
        return 1000.0 / self._clock.interval()

    def set_rate(self, rate: float) -> None:
        """Set how fast the clock turns.

        Parameters
        ----------
        rate : float
            Pictures in a second, `SLOWEST` to `FASTEST`.
        """
        self._clock.setInterval(round(1000.0 / min(max(rate, SLOWEST), FASTEST)))

    def start(self) -> None:
        """Show the first, and go on by the clock."""
        self._swipe.show("first")
        self._clock.start()
        self.changed.emit()

    def stop(self) -> None:
        """Show both again."""
        if not self.on:
            return
        self._clock.stop()
        self._swipe.show("both")
        self.changed.emit()

    def turn(self) -> None:
        """Show the other one."""
        self._swipe.show("second" if self._swipe.shown == "first" else "first")
        self.changed.emit()

    def turn_by_hand(self) -> None:
        """Show the other one, and stay there."""
        self._clock.stop()
        self.turn()
