"""A slider with a number beside it, evenly or logarithmically spaced."""

import math

from qtpy.QtCore import QSize, Qt, Signal
from qtpy.QtGui import QValidator
from qtpy.QtWidgets import QDoubleSpinBox, QHBoxLayout, QSizePolicy, QSlider, QSpinBox, QWidget

_STEPS = 1000


class Number(QDoubleSpinBox):
    """A number with as many digits as it needs, small ones included."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setDecimals(9)
        self.setKeyboardTracking(False)
        self.setStepType(QDoubleSpinBox.StepType.AdaptiveDecimalStepType)

    def sizeHint(self) -> QSize:  # noqa: N802
        """Return room for four digits with their unit, whatever the range."""
        metrics = self.fontMetrics()
        arrows = self.buttonSymbols() != QDoubleSpinBox.ButtonSymbols.NoButtons
        text = metrics.horizontalAdvance(f"-0.0123{self.suffix()}")
        frame = metrics.height() * (2 if arrows else 1)
        return QSize(text + frame, super().sizeHint().height())

    def minimumSizeHint(self) -> QSize:  # noqa: N802
        """Return the same: a number that is cut is a wrong one."""
        return self.sizeHint()

    def textFromValue(self, value: float) -> str:  # noqa: N802
        """Return what is shown for a value."""
        return f"{value:.4g}"

    def valueFromText(self, text: str) -> float:  # noqa: N802
        """Return the value of what is typed."""
        try:
            return float(text.removesuffix(self.suffix()).strip().replace(",", "."))
        except ValueError:
            return self.value()

    def validate(self, text: str, at: int) -> tuple[QValidator.State, str, int]:
        """Let everything be typed that may become a number."""
        bare = text.removesuffix(self.suffix()).strip().replace(",", ".")
        try:
            inside = self.minimum() <= float(bare) <= self.maximum()
        except ValueError:
            partial = not set(bare) - set("0123456789.eE+-")
            state = QValidator.State.Intermediate if partial else QValidator.State.Invalid
            return state, text, at
        state = QValidator.State.Acceptable if inside else QValidator.State.Intermediate
        return state, text, at


class Whole(QSpinBox):
    """A whole number."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setKeyboardTracking(False)
        self.setGroupSeparatorShown(True)
        self.setStepType(QSpinBox.StepType.AdaptiveDecimalStepType)


class Slider(QWidget):
    """A value from a range: dragged roughly, or typed exactly.

    Parameters
    ----------
    name : str
        What it is, for those who do not see it.
    doc : str
        One sentence with the unit.
    low, high : float
        The range. A logarithmic one begins above 0.
    suffix : str
        Unit behind the number.
    logarithmic : bool
        Whether equal ways are equal ratios.
    zero : bool
        Whether the left end of a logarithmic one is 0.
    """

    changed = Signal(float)
    """Emitted with the new value when a person changes it."""
    pressed = Signal()
    """Emitted when a drag begins."""
    released = Signal()
    """Emitted when a drag ends."""

    def __init__(
        self,
        name: str,
        doc: str,
        low: float,
        high: float,
        *,
        suffix: str = "",
        logarithmic: bool = False,
        zero: bool = False,
    ) -> None:
        super().__init__()
        self._low, self._high, self._logarithmic, self._zero = low, high, logarithmic, zero
        self.slider = QSlider(Qt.Orientation.Horizontal, self)
        self.slider.setRange(0, _STEPS)
        self.slider.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.number = Number(self)
        self.number.setRange(0.0 if zero else low, high)
        self.number.setSuffix(suffix)
        for widget in (self.slider, self.number):
            widget.setAccessibleName(name)
            widget.setToolTip(doc)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self.slider, 1)
        row.addWidget(self.number)
        self.slider.valueChanged.connect(self._on_slider)
        self.slider.sliderPressed.connect(self.pressed)
        self.slider.sliderReleased.connect(self.released)
        self.number.valueChanged.connect(self._on_number)

    @property
    def value(self) -> float:
        """The value."""
        return self.number.value()

    def follow(self, value: float) -> None:
        """Show a value, without telling anybody.

        Parameters
        ----------
        value : float
            One beyond the range is shown as it is: it may come from a file.
        """
        self.number.blockSignals(True)
        self.number.setRange(min(self.number.minimum(), value), max(self._high, value))
        self.number.setValue(value)
        self.number.blockSignals(False)
        self._place(value)

    def _place(self, value: float) -> None:
        self.slider.blockSignals(True)
        self.slider.setValue(self._position(value))
        self.slider.blockSignals(False)

    def _position(self, value: float) -> int:
        inside = min(max(value, self._low), self._high)
        if self._zero and value < self._low:
            return 0
        if self._logarithmic:
            share = math.log(inside / self._low) / math.log(self._high / self._low)
        else:
            share = (inside - self._low) / (self._high - self._low)
        return round(share * _STEPS)

    def _value_at(self, position: int) -> float:
        if self._zero and position == 0:
            return 0.0
        share = position / _STEPS
        if not self._logarithmic:
            return self._low + share * (self._high - self._low)
        exact = self._low * (self._high / self._low) ** share
        return float(f"{exact:.3g}")  # finer than the eye, and short to read

    def _on_slider(self, position: int) -> None:
        value = self._value_at(position)
        self.number.blockSignals(True)
        self.number.setValue(value)
        self.number.blockSignals(False)
        self.changed.emit(value)

    def _on_number(self, value: float) -> None:
        self._place(value)
        self.changed.emit(value)
