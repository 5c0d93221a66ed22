"""The chosen light in numbers: kind, frame, colour, strength, place and direction."""

from typing import TYPE_CHECKING, cast

from qtpy.QtCore import QSize
from qtpy.QtGui import QColor, QIcon, QPainter, QPixmap
from qtpy.QtWidgets import QColorDialog, QComboBox, QFormLayout, QLabel, QPushButton, QWidget

from app.gui.lights import KINDS, displayed, kind_of, power, powered
from app.gui.slider import Slider
from app.gui.triple import Triple
from app.session import Cone, Directional, Frame, Point, Vector

if TYPE_CHECKING:
    from app.gui.window import Window

_FRAMES = {"camera": "moves with the camera", "world": "stays with the mesh"}


class LightForm(QWidget):
    """Controls of the chosen light.

    Parameters
    ----------
    window : Window
        What it is about.
    """

    def __init__(self, window: "Window") -> None:
        super().__init__()
        self._controller, self._lights = window.controller, window.lights
        self.rows = QFormLayout(self)
        self.rows.setContentsMargins(0, 0, 0, 0)
        self.rows.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        self.rows.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        self._fill()

    def follow(self) -> None:
        """Show the light that is chosen."""
        light = self._lights.light
        self.setEnabled(light is not None)
        if light is None:
            return
        directional, cone = isinstance(light, Directional), isinstance(light, Cone)
        _choose(self.kind, kind_of(light))
        _choose(self.frame, light.frame if isinstance(light, Directional) else "world")
        self.rows.setRowVisible(self.frame, directional)
        self.rows.setRowVisible(self.position, not directional)
        self.rows.setRowVisible(self.direction, directional or cone)
        self.rows.setRowVisible(self.angle, cone)
        if isinstance(light, Cone):
            self.angle.follow(light.angle)
        if not isinstance(light, Directional):
            self.position.follow(light.position)
        if not isinstance(light, Point):
            self.direction.follow(light.direction)
        rgb = power(light)
        self.strength.follow(max(rgb))
        self.color.setIcon(swatch(self, rgb))
        name = "Irradiance" if directional else "Intensity"
        self.strong.setText(name)

    def _fill(self) -> None:
        self.kind = _combo("Kind of light", {kind: kind for kind in KINDS})
        self.kind.setToolTip("Directional: from infinitely far. Point and cone: from a place")
        self.kind.activated.connect(lambda _: self._lights.make(self.kind.currentData()))
        self.frame = _combo("Frame of the light", _FRAMES)
        self.frame.setToolTip("Whether the light turns with the camera or stays with the mesh")
        self.frame.activated.connect(
            lambda _: self._lights.fix(cast(Frame, self.frame.currentData()))
        )
        self.color = QPushButton("Choose\N{HORIZONTAL ELLIPSIS}", self)
        self.color.setAccessibleName("Colour of the light")
        self.color.setToolTip("Colour of the light, as the display shows it; its strength stays")
        self.color.clicked.connect(self._pick)
        self.strength = Slider(
            "Strength of the light",
            "Irradiance of a surface that faces a directional light; intensity of another, in "
            "irradiance times mesh unit squared. Linear, the brightest channel",
            0.001,
            1e6,
            logarithmic=True,
            zero=True,
        )
        self.strength.number.setRange(0.0, 1e15)
        self.strength.changed.connect(self._on_strength)
        self.position = Triple("Position", "World coordinates, mesh units")
        self.position.changed.connect(
            lambda xyz: self._lights.change("position of light", position=xyz)
        )
        self.direction = Triple(
            "Direction", "To a directional light; from a cone light into the scene"
        )
        self.direction.changed.connect(self._on_direction)
        self.angle = Slider(
            "Angle of the cone",
            "Between the axis and the edge of the cone, degrees",
            1.0,
            180.0,
            suffix="\N{DEGREE SIGN}",
        )
        self.angle.changed.connect(lambda value: self._lights.change("angle of cone", angle=value))
        self.strong = QLabel(self)
        rows: tuple[tuple[str | QLabel, QWidget], ...] = (
            ("Kind", self.kind),
            ("Frame", self.frame),
            ("Colour", self.color),
            (self.strong, self.strength),
            ("Position", self.position),
            ("Direction", self.direction),
            ("Angle", self.angle),
        )
        for label, widget in rows:
            self.rows.addRow(label, widget)
        for slider in (self.strength, self.angle):
            slider.pressed.connect(self._controller.begin_drag)
            slider.released.connect(self._controller.end_drag)

    def _on_strength(self, value: float) -> None:
        light = self._lights.light
        if light is None:
            return
        rgb = power(light)
        most = max(rgb)
        # One that was turned down to nothing has lost its colour: it comes back white.
        shares = tuple(one / most for one in rgb) if most > 0.0 else (1.0, 1.0, 1.0)
        red, green, blue = (value * share for share in shares)
        self._lights.change("strength of light", **powered(light, (red, green, blue)))

    def _on_direction(self, direction: Vector) -> None:
        if any(direction):
            self._lights.change("direction of light", direction=direction)
        else:
            self._controller.failed.emit("a light needs a direction other than 0, 0, 0")
            self.follow()

    def _pick(self) -> None:
        light = self._lights.light
        if light is None:
            return
        start = QColor.fromRgbF(*displayed(power(light)))
        chosen = QColorDialog.getColor(start, self, "Colour of the light")
        if chosen.isValid():
            self.paint(chosen)

    def paint(self, color: QColor) -> None:
        """Give the chosen light a colour; its brightest channel stays as strong.

        Parameters
        ----------
        color : QColor
            sRGB; black counts as white.
        """
        import numpy as np

        from lutcore.color import srgb_decode

        light = self._lights.light
        if light is None:
            return
        rgb = srgb_decode(np.array([color.redF(), color.greenF(), color.blueF()]))
        rgb = rgb / rgb.max() if rgb.max() > 0.0 else np.ones(3)
        red, green, blue = (max(power(light)) * rgb).tolist()
        self._lights.change("colour of light", **powered(light, (red, green, blue)))


def swatch(widget: QWidget, rgb: Vector) -> QIcon:
    """Return a square of a light's colour, as high as a line of text.

    Parameters
    ----------
    widget : QWidget
        Where it is shown.
    rgb : tuple of 3 floats
        Linear.

    Returns
    -------
    QIcon
        With a thin border.
    """
    side = widget.fontMetrics().height()
    square = QPixmap(QSize(side, side))
    square.fill(widget.palette().mid().color())
    painter = QPainter(square)
    painter.fillRect(1, 1, side - 2, side - 2, QColor.fromRgbF(*displayed(rgb)))
    painter.end()
    return QIcon(square)


def _choose(combo: QComboBox, data: str) -> None:
    combo.setCurrentIndex(combo.findData(data))


def _combo(name: str, entries: dict[str, str]) -> QComboBox:
    combo = QComboBox()
    combo.setAccessibleName(name)
    for data, text in entries.items():
        combo.addItem(text, data)
    return combo
