"""Runs functions on the window's thread, whoever asks."""

from collections.abc import Callable

from qtpy.QtCore import QObject, Qt, Signal


class Poster(QObject):
    """Runs functions on the thread that it was made in."""

    _posted = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self._posted.connect(self._run, Qt.ConnectionType.QueuedConnection)

    def post(self, call: Callable[[], None]) -> None:
        """Run a function soon.

        Parameters
        ----------
        call : callable
            Takes nothing.
        """
        self._posted.emit(call)

    def _run(self, call: Callable[[], None]) -> None:
        call()
