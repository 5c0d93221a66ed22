"""The material: one that was measured, or its coefficients on sliders."""

from collections.abc import Callable
from dataclasses import replace

from qtpy.QtWidgets import QCheckBox, QComboBox, QFormLayout, QGridLayout, QLabel, QWidget

from app.gui.slider import Slider
from app.session import Substance
from app.steps.substance import material_of
from lutcore.errors import ParameterError
from lutcore.materials import Material, material, materials

CHANGED = ", changed"
_CHANNELS = ("red", "green", "blue")
_PER_MM = " /mm"


class MaterialForm(QWidget):
    """Presets, and sliders for the coefficients of each channel.

    Parameters
    ----------
    changed : callable
        Gets a material's name, or a `Substance`, when a person changes something.
    begin, end : callable
        Called when a slider's drag begins and ends.
    """

    def __init__(
        self,
        changed: Callable[[str | Substance], object],
        begin: Callable[[], None],
        end: Callable[[], None],
    ) -> None:
        super().__init__()
        self._changed = changed
        self._shown: Material | None = None
        self.preset = QComboBox(self)
        self.preset.setAccessibleName("Material")
        self.preset.setToolTip("Materials that were measured by Jensen et al. 2001")
        self.preset.addItems(materials())
        self.preset.activated.connect(self._on_preset)
        self.scattering = [
            Slider(
                f"Scattering, {channel}",
                f"Reduced scattering coefficient sigma_s' of {channel} light, 1/mm",
                0.001,
                100.0,
                suffix=_PER_MM,
                logarithmic=True,
            )
            for channel in _CHANNELS
        ]
        self.absorption = [
            Slider(
                f"Absorption, {channel}",
                f"Absorption coefficient sigma_a of {channel} light, 1/mm; 0 at the left end",
                0.0001,
                10.0,
                suffix=_PER_MM,
                logarithmic=True,
                zero=True,
            )
            for channel in _CHANNELS
        ]
        self.eta = [
            Slider(
                f"Refractive index, {channel}",
                f"Refractive index eta of {channel} light against the air outside, 1 to 3",
                1.0,
                3.0,
            )
            for channel in _CHANNELS
        ]
        self.linked = QCheckBox("One index for all colours", self)
        self.linked.setToolTip("The three refractive indices move together")
        self.linked.setChecked(True)
        self.linked.clicked.connect(self._on_linked)
        rows = QFormLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        rows.addRow("Material", self.preset)
        for symbol, sliders in (
            ("\u03c3s\u2032", self.scattering),
            ("\u03c3a", self.absorption),
            ("\u03b7", self.eta),
        ):
            for channel, slider in zip(_CHANNELS, sliders, strict=True):
                rows.addRow(f"{symbol} {channel}", slider)
        rows.addRow(self.linked)
        self.facts = _Facts()
        rows.addRow(self.facts)
        for slider in self.eta:
            slider.changed.connect(self._on_eta)
        for slider in (*self.scattering, *self.absorption):
            slider.changed.connect(lambda _: self._on_slider())
        for slider in (*self.scattering, *self.absorption, *self.eta):
            slider.pressed.connect(begin)
            slider.released.connect(end)

    def follow(self, chosen: str | Substance) -> None:
        """Show a material, without telling anybody.

        Parameters
        ----------
        chosen : str or Substance
            `Session.material`.
        """
        try:
            found = material_of(chosen)
        except ParameterError:
            return  # what draws the picture says so
        self._shown = found
        while self.preset.count() > len(materials()):
            self.preset.removeItem(self.preset.count() - 1)
        if self.preset.findText(found.name) < 0 or isinstance(chosen, Substance):
            self.preset.addItem(found.name)
            self.preset.setCurrentIndex(self.preset.count() - 1)
        else:
            self.preset.setCurrentText(found.name)
        for sliders, values in (
            (self.scattering, found.scattering),
            (self.absorption, found.absorption),
            (self.eta, found.eta),
        ):
            for slider, value in zip(sliders, values, strict=True):
                slider.follow(value)
        if len(set(found.eta)) > 1:
            self.linked.setChecked(False)

    def _on_preset(self, index: int) -> None:
        if index < len(materials()):
            self._changed(self.preset.itemText(index))

    def _on_eta(self, value: float) -> None:
        if self.linked.isChecked():
            self._link(value)
        self._on_slider()

    def _on_linked(self, linked: bool) -> None:
        red = self.eta[0].value
        if linked and any(slider.value != red for slider in self.eta):
            self._link(red)
            self._on_slider()

    def _link(self, value: float) -> None:
        for slider in self.eta:
            slider.follow(value)

    def _on_slider(self) -> None:
        name = self._shown.name if self._shown else ""
        base = name.removesuffix(CHANGED)
        s_red, s_green, s_blue = (slider.value for slider in self.scattering)
        a_red, a_green, a_blue = (slider.value for slider in self.absorption)
        n_red, n_green, n_blue = (slider.value for slider in self.eta)
        made = Substance(
            base + CHANGED,
            (s_red, s_green, s_blue),
            (a_red, a_green, a_blue),
            (n_red, n_green, n_blue),
        )
        self._changed(base if _same(base, made) else made)


class _Facts(QWidget):
    """What follows from the coefficients, by channel."""

    def __init__(self) -> None:
        super().__init__()
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        self.cells: dict[tuple[str, int], QLabel] = {}
        for row, (key, title, doc) in enumerate(
            (
                ("length", "l_d, mm", "Diffuse mean free path: how far light spreads"),
                ("total", "R_d", "Diffuse reflectance of a flat surface"),
            )
        ):
            label = QLabel(title, self)
            label.setToolTip(doc)
            grid.addWidget(label, row, 0)
            for channel, name in enumerate(_CHANNELS):
                cell = QLabel("", self)
                cell.setToolTip(f"{doc}, {name}")
                cell.setAccessibleName(f"{title}, {name}")
                grid.addWidget(cell, row, channel + 1)
                self.cells[key, channel] = cell

    def tell(self, lengths: list[float], totals: list[float]) -> None:
        """Show the figures.

        Parameters
        ----------
        lengths, totals : list of float
            l_d in mm, infinite without absorption, and R_d.
        """
        for channel, (length, total) in enumerate(zip(lengths, totals, strict=True)):
            self.cells["length", channel].setText(f"{length:.3g}".replace("inf", "\u221e"))
            self.cells["total", channel].setText(f"{total:.3f}")


def _same(name: str, made: Substance) -> bool:
    """Tell whether sliders are back at the values of the named material."""
    if name not in materials():
        return False
    return material_of(made) == replace(material(name), name=made.name)
