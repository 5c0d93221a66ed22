"""The range that values are shown in: dragged on their histogram, typed, or found by itself."""

from typing import TYPE_CHECKING

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QCheckBox, QComboBox, QGridLayout, QLabel, QPushButton, QWidget

from app.gui.color_bar import ColorBar
from app.gui.distribution import Distribution
from app.gui.showing import PERCENTILES
from app.gui.slider import Number

if TYPE_CHECKING:
    from app.gui.controller import Controller
    from lutcore.arrays import FloatArray

_WIDEST = 1e12
_NOTHING = " \n "  # as high as what stands there


class RangeForm(QWidget):
    """The colour bar with its ends as numbers below it.

    Parameters
    ----------
    controller : Controller
        Of the window.
    """

    def __init__(self, controller: "Controller") -> None:
        super().__init__()
        self._controller = controller
        self._found: Distribution | None = None
        self._offered: list[tuple[float, float]] = []
        self.bar = ColorBar(self)
        self.low, self.high = (self._number(name) for name in ("Low end", "High end"))
        self.pointed = QLabel(_NOTHING, self)
        self.pointed.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.pointed.setAccessibleName("Value under the mouse")
        self.percentiles = QComboBox(self)
        self.percentiles.setAccessibleName("Percentiles of the automatic range")
        self.percentiles.setToolTip(
            "Percentiles at the ends of the automatic range, %, of the values that their error "
            "bars trust"
        )
        self.automatic = QPushButton("Automatic", self)
        self.automatic.setToolTip("Let the range follow the values; a double click on the bar")
        self.lock = QCheckBox("Lock", self)
        self.lock.setAccessibleName("Lock the range")
        self.lock.setToolTip("Keep this range for other meshes, to compare them")
        rows = QGridLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.addWidget(self.bar, 0, 0, 1, 3)
        rows.addWidget(self.low, 1, 0)
        rows.addWidget(self.pointed, 1, 1)
        rows.addWidget(self.high, 1, 2)
        rows.addWidget(self.percentiles, 2, 0)
        rows.addWidget(self.automatic, 2, 1)
        rows.addWidget(self.lock, 2, 2)
        rows.setColumnStretch(1, 1)
        self.bar.ranged.connect(self._on_ranged)
        self.bar.pressed.connect(controller.begin_drag)
        self.bar.released.connect(controller.end_drag)
        self.bar.automatic.connect(self._to_automatic)
        self.bar.pointed.connect(self._on_pointed)
        self.automatic.clicked.connect(self._to_automatic)
        self.percentiles.activated.connect(self._on_percentiles)
        self.lock.clicked.connect(self._on_lock)

    def follow(
        self, found: Distribution | None, colors: "FloatArray", ends: tuple[float, float], why: str
    ) -> None:
        """Show values and their range, without telling anybody.

        Parameters
        ----------
        found : Distribution or None
            The values, if there is one quantity of them.
        colors : ndarray, shape=(entries, 3)
            Of the map.
        ends : tuple of 2 floats
            The range.
        why : str
            Why there are no values.
        """
        self._found = found
        if found is None:
            self.bar.show_nothing(why)
        else:
            self.bar.follow(found, colors, ends)
        session = self._controller.session
        for number, end in ((self.low, ends[0]), (self.high, ends[1])):
            number.blockSignals(True)
            number.setValue(end)
            number.blockSignals(False)
            number.setEnabled(found is not None)
        self._follow_percentiles(session.percentiles)
        self.automatic.setEnabled(session.range is not None)
        self.lock.setEnabled(found is not None)
        self.lock.setChecked(self._controller.range_locked)

    def _follow_percentiles(self, given: tuple[float, float]) -> None:
        offered = list(dict.fromkeys((*PERCENTILES, given)))
        if offered != self._offered:
            self._offered = offered
            self.percentiles.clear()
            for low, high in offered:
                self.percentiles.addItem(f"{low:g} to {high:g} %", (low, high))
        self.percentiles.setCurrentIndex(offered.index(given))

    def _number(self, name: str) -> Number:
        number = Number(self)
        number.setRange(-_WIDEST, _WIDEST)
        number.setAccessibleName(name)
        number.setToolTip(f"{name} of the range, in the unit of the quantity")
        number.valueChanged.connect(self._on_typed)
        return number

    def _on_ranged(self, low: float, high: float) -> None:
        if self._controller.session.symmetric:
            low, high = self._mirrored(low, high)
        self._controller.change("range", range=(low, high))

    def _mirrored(self, low: float, high: float) -> tuple[float, float]:
        """Make the end that was not moved as far from zero as the other."""
        before = self._controller.session.range or (self.low.value(), self.high.value())
        moved = low if low != before[0] else high
        return -abs(moved), abs(moved)

    def _on_typed(self) -> None:
        low, high = self.low.value(), self.high.value()
        if low < high:
            self._on_ranged(low, high)

    def _on_percentiles(self) -> None:
        low, high = self.percentiles.currentData()
        self._unlock()
        self._controller.change("percentiles", percentiles=(low, high), range=None)

    def _to_automatic(self) -> None:
        self._unlock()
        self._controller.change("automatic range", range=None)

    def _unlock(self) -> None:
        self._controller.range_locked = False
        self.lock.setChecked(False)

    def _on_lock(self, on: bool) -> None:
        self._controller.range_locked = on
        if on and self._controller.session.range is None:
            self._controller.change("range", range=self.bar.ends)

    def _on_pointed(self, value: float | None) -> None:
        if value is None or self._found is None:
            self.pointed.setText(_NOTHING)
            return
        unit = self._found.quantity.printed_unit if self._found.quantity.power else ""
        share = self._found.share_below(value)
        self.pointed.setText(f"{value:.3g} {unit}".rstrip() + f"\n{share:.0f} % below")
