"""A form made of the parameters that a plug-in declares."""

import dataclasses
import math
from collections.abc import Callable, Mapping
from typing import Any

from qtpy.QtCore import Qt, Signal
from qtpy.QtWidgets import QComboBox, QFormLayout, QPushButton, QWidget

from app.gui.slider import Slider, Whole
from lutcore.parameters import Choice, Number, Parameters, declared

Values = dict[str, float | str]
# Beyond this ratio of its ends a range is gone through in equal ratios.
_WIDE = 100.0
# Where such a range begins at 0, the slider's first value above it: a share of the default.
_LEAST = 0.01
_MOST_WHOLE = 2**31 - 1


class ParameterForm(QWidget):
    """One control for each parameter of a plug-in, with its unit, its meaning and its default.

    Parameters
    ----------
    plugin : type
        The plug-in's class.
    values : mapping of str to float or str
        Parameters that are not at their default, as in `app.session.Method`.
    changed : callable
        Gets such values when a person changes something.
    """

    pressed = Signal()
    """Emitted when a slider's drag begins."""
    released = Signal()
    """Emitted when a slider's drag ends."""

    def __init__(
        self,
        plugin: type[Parameters],
        values: Mapping[str, float | str],
        changed: Callable[[Values], object],
    ) -> None:
        super().__init__()
        self.plugin = plugin
        self._changed = changed
        self._defaults: dict[str, Any] = {
            field.name: field.default
            for field in dataclasses.fields(plugin)
            if field.name in declared(plugin)
        }
        self._values: Values = {}
        self.controls: dict[str, QWidget] = {}
        self._rows = QFormLayout(self)
        self._rows.setContentsMargins(0, 0, 0, 0)
        self._rows.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        self._rows.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        for name, spec in declared(plugin).items():
            self._add(name, spec)
        self.reset = QPushButton("Defaults", self)
        self.reset.setAccessibleName("Set all parameters to their defaults")
        self.reset.setToolTip("Set all parameters to their defaults")
        self.reset.clicked.connect(self._to_defaults)
        if self.controls:
            self._rows.addRow("", self.reset)
        else:
            self.reset.hide()
        self.follow(values)

    @property
    def values(self) -> Values:
        """Parameters that are not at their default."""
        return dict(self._values)

    def follow(self, values: Mapping[str, float | str]) -> None:
        """Show values, without telling anybody.

        Parameters
        ----------
        values : mapping of str to float or str
            Parameters that are not at their default.
        """
        self._values = dict(values)
        for name, control in self.controls.items():
            _show(control, values.get(name, self._defaults[name]))
        self.reset.setEnabled(bool(self._values))

    def _add(self, name: str, spec: Number | Choice) -> None:
        words = name.replace("_", " ")
        default = self._defaults[name]
        control: QWidget
        if isinstance(spec, Choice):
            control = self._choice(name, spec)
            doc = f"{spec.doc} Default: {default}."
        else:
            unit = f" {spec.unit}" if spec.unit else ""
            doc = f"{spec.doc} {spec.low:g} to {spec.high:g}{unit}, default {default:g}."
            control = self._whole(name, spec) if spec.integer else self._slider(name, spec, doc)
        control.setAccessibleName(words)
        control.setToolTip(doc)
        self._rows.addRow(words.capitalize(), control)
        self._rows.labelForField(control).setToolTip(doc)
        self.controls[name] = control

    def _choice(self, name: str, spec: Choice) -> QComboBox:
        box = QComboBox(self)
        box.addItems(spec.options)
        box.currentTextChanged.connect(lambda text: self._on_changed(name, text))
        return box

    def _whole(self, name: str, spec: Number) -> Whole:
        box = Whole(self)
        box.setRange(max(int(spec.low), -_MOST_WHOLE), min(int(spec.high), _MOST_WHOLE))
        box.setSuffix(_suffix(spec))
        box.valueChanged.connect(lambda value: self._on_changed(name, float(value)))
        return box

    def _slider(self, name: str, spec: Number, doc: str) -> Slider:
        low, zero = spec.low, False
        default = float(self._defaults[name])
        if low == 0.0 and 0.0 < default < spec.high / _WIDE:
            low, zero = default * _LEAST, True
        slider = Slider(
            name.replace("_", " "),
            doc,
            low,
            spec.high,
            suffix=_suffix(spec),
            logarithmic=low > 0.0 and spec.high / low > _WIDE,
            zero=zero,
        )
        slider.changed.connect(lambda value: self._on_changed(name, value))
        slider.pressed.connect(self.pressed)
        slider.released.connect(self.released)
        return slider

    def _on_changed(self, name: str, value: float | str) -> None:
        default = self._defaults[name]
        same = (
            math.isclose(value, default, rel_tol=1e-12)
            if isinstance(value, float)
            else value == default
        )
        self._values.pop(name, None)
        if not same:
            self._values[name] = value
        self.reset.setEnabled(bool(self._values))
        self._changed(self.values)

    def _to_defaults(self) -> None:
        self.follow({})
        self._changed({})


def _suffix(spec: Number) -> str:
    return f" {spec.unit}" if spec.unit else ""


def _show(control: QWidget, value: float | str) -> None:
    if isinstance(control, Slider):
        control.follow(float(value))
        return
    control.blockSignals(True)
    if isinstance(control, QComboBox):
        control.setCurrentIndex(control.findText(str(value), Qt.MatchFlag.MatchExactly))
    elif isinstance(control, Whole):
        control.setValue(int(value))
    control.blockSignals(False)
