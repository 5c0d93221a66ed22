"""A question above the view: in which unit a file is."""

from qtpy.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QSizePolicy,
    QToolButton,
    QWidget,
)

from app.gui.units import UNITS, Units


class UnitBar(QFrame):
    """Asks without stopping the person.

    Parameters
    ----------
    parent : QWidget
        Where it lies.
    units : Units
        Says when to ask, and gets the answer.
    """

    def __init__(self, parent: QWidget, units: Units) -> None:
        super().__init__(parent)
        self.setFrameShape(QFrame.Shape.StyledPanel)
        self.setAutoFillBackground(True)
        self.label = QLabel(self)
        self.label.setWordWrap(True)
        self.label.setAccessibleName("Question about the unit")
        self.label.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Minimum)
        row = QHBoxLayout(self)
        row.addWidget(self.label, 1)
        self.buttons: dict[str, QToolButton] = {}
        for unit, size in UNITS.items():
            button = self.buttons[unit] = QToolButton(self)  # as narrow as its word
            button.setText(unit)
            button.setAccessibleName(f"Its unit is {unit}")
            button.clicked.connect(lambda _=False, size=size: units.answer(size))
            row.addWidget(button)
        self.close_ = QToolButton(self)
        self.close_.setText("\N{MULTIPLICATION SIGN}")
        self.close_.setAutoRaise(True)
        self.close_.setAccessibleName("Leave the unit open")
        self.close_.setToolTip("Leave it open: a unit counts as 1 mm; this file is not asked again")
        self.close_.clicked.connect(lambda: units.answer(None))
        row.addWidget(self.close_)
        units.asked.connect(self._on_asked)
        self.hide()

    def _on_asked(self, diagonal: float | None) -> None:
        self.setVisible(diagonal is not None)
        if diagonal is None:
            return
        self.label.setText(f"This mesh would be {diagonal:.3g} mm large. Its unit is:")
        for unit, button in self.buttons.items():
            button.setToolTip(f"It is {diagonal * UNITS[unit]:.3g} mm large")
