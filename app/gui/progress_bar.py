"""Where long work stands, with a way to stop it."""

from collections.abc import Callable

from qtpy.QtWidgets import QHBoxLayout, QLabel, QProgressBar, QToolButton, QWidget

from app.gui.worker import Standing

_PATIENCE = 0.3  # shorter work shows nothing


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
        self.hide()

    def tell(self, standing: Standing | None) -> None:
        """Show where the work stands.

        Parameters
        ----------
        standing : Standing or None
            None hides the bar.
        """
        if standing is None:
            self.hide()
        elif standing.seconds > _PATIENCE:
            self.label.setText(f"{standing.step}, {standing.seconds:.1f} s")
            self.bar.setValue(round(100.0 * standing.share))
            self.show()
