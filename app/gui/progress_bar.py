"""Where long work stands, with a way to stop it."""

import time
from collections.abc import Callable

from qtpy.QtCore import QTimer
from qtpy.QtWidgets import QHBoxLayout, QLabel, QProgressBar, QToolButton, QWidget

from app.gui.worker import Standing

_PATIENCE = 0.3  # shorter work shows nothing
_TICK = 200  # ms: the time goes on where a step takes long and says nothing


class ProgressBar(QWidget):
    """A bar in the status bar, there only while work goes on.

    Parameters
    ----------
    parent : QWidget
        Where it lies.
    cancel : callable
        Stops the work.
    """

    def __init__(self, parent: QWidget, cancel: Callable[[], None]) -> None:
        super().__init__(parent)
        self.label = QLabel(self)
        self.bar = QProgressBar(self)
        self.bar.setRange(0, 100)
        self.bar.setFixedWidth(160)
        self.bar.setAccessibleName("Progress")
        self.button = QToolButton(self)
        self.button.setText("Cancel")
        self.button.setAccessibleName("Cancel the computation")
        self.button.clicked.connect(cancel)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        for part in (self.label, self.bar, self.button):
            row.addWidget(part)
        self._start = 0.0
        self._step = ""
        self._ticking = QTimer(self)
        self._ticking.setInterval(_TICK)
        self._ticking.timeout.connect(self._on_tick)
        self.hide()

    def tell(self, standing: Standing | None) -> None:
        """Show where the work stands.

        Parameters
        ----------
        standing : Standing or None
            None hides the bar.
        """
        if standing is None:
            self._ticking.stop()
            self.hide()
            return
        self._start = time.monotonic() - standing.seconds
        self._step = standing.step
        self.bar.setValue(round(100.0 * standing.share))
        self._ticking.start()
        self._show(standing.seconds)

    def _on_tick(self) -> None:
        self._show(time.monotonic() - self._start)

    def _show(self, seconds: float) -> None:
        if seconds > _PATIENCE:
            self.label.setText(f"{self._step}, {seconds:.1f} s")
            self.show()
