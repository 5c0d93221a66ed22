"""How far apart the compared are, in numbers, and the way to where it is most."""

from functools import partial

from qtpy.QtCore import Signal
from qtpy.QtWidgets import QGroupBox, QLabel, QPushButton, QVBoxLayout, QWidget

from app.gui.controller import Outcome
from app.quantities import QUANTITIES


class Apart(QGroupBox):
    """For each that is compared with A: mean, 99th percentile, worst, and a button to go there.

    Parameters
    ----------
    parent : QWidget
        Where it lies.
    """

    asked = Signal(str)
    """Emitted with the name of the one whose worst point a person wants to see."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__("Difference", parent)
        self.setAccessibleName("Difference")
        self._rows = QVBoxLayout(self)
        self.texts: dict[str, QLabel] = {}
        self.buttons: dict[str, QPushButton] = {}
        self.hide()

    def follow(self, outcome: Outcome) -> None:
        """Show the numbers of a picture.

        Parameters
        ----------
        outcome : Outcome
            What is shown; nothing is if it holds no difference.
        """
        found = outcome.composition.difference or {}
        session = outcome.session
        if list(found) != list(self.texts):
            self._make(list(found))
        self.setVisible(bool(found))
        if not found:
            return
        unit, title = "", "Difference, CIEDE2000"
        if session.compared_by == "estimator":
            quantity = QUANTITIES[session.quantity]
            unit = f" {quantity.printed_unit}" if quantity.power else ""
            title = f"Difference of the {quantity.name}"
        self.setTitle(title)
        for label, one in found.items():
            place = ", ".join(f"{part:.4g}" for part in one["position"])
            self.texts[label].setText(
                f"{label}\nmean {one['mean']:.3g}{unit}\n99 % are below {one['p99']:.3g}{unit}\n"
                f"worst {one['max']:.3g}{unit}, vertex {one['vertex']}\nat {place}"
            )

    def _make(self, labels: list[str]) -> None:
        for widget in (*self.texts.values(), *self.buttons.values()):
            self._rows.removeWidget(widget)
            widget.hide()
            widget.deleteLater()
        self.texts, self.buttons = {}, {}
        for label in labels:
            text = QLabel(self)
            text.setWordWrap(True)
            text.setAccessibleName(f"Difference of {label}")
            button = QPushButton("Go to the worst point", self)
            button.setAccessibleName(f"Go to the worst point of {label}")
            button.setToolTip("Turn the camera to face the point where the difference is largest")
            button.clicked.connect(partial(self._ask, label))
            self._rows.addWidget(text)
            self._rows.addWidget(button)
            self.texts[label], self.buttons[label] = text, button

    def _ask(self, label: str, *_: object) -> None:
        self.asked.emit(label)
