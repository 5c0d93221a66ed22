"""Three numbers in a row: a place or a direction."""

from qtpy.QtCore import Signal
from qtpy.QtWidgets import QHBoxLayout, QWidget

from app.gui.slider import Number
from app.session import Vector

_FAR = 1e9


class Triple(QWidget):
    """Three numbers in a row.

    Parameters
    ----------
    name : str
        What they are.
    doc : str
        One sentence.
    """

    changed = Signal(object)
    """Emitted with the three numbers when a person changes one."""

    def __init__(self, name: str, doc: str) -> None:
        super().__init__()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        self.numbers = [Number(self) for _ in range(3)]
        for axis, number in zip("xyz", self.numbers, strict=True):
            number.setRange(-_FAR, _FAR)
            number.setAccessibleName(f"{name} {axis}")
            number.setToolTip(doc)
            number.setButtonSymbols(Number.ButtonSymbols.NoButtons)
            number.valueChanged.connect(self._tell)
            row.addWidget(number, 1)

    def follow(self, value: Vector) -> None:
        """Show numbers, without telling anybody.

        Parameters
        ----------
        value : tuple of 3 floats
            The numbers.
        """
        for number, one in zip(self.numbers, value, strict=True):
            number.blockSignals(True)
            number.setValue(one)
            number.blockSignals(False)

    def _tell(self) -> None:
        x, y, z = (number.value() for number in self.numbers)
        self.changed.emit((x, y, z))
