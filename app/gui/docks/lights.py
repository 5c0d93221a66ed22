"""The lights: a list, a ball to aim them on, and the chosen one in numbers."""

from functools import partial
from typing import TYPE_CHECKING, cast

from qtpy.QtCore import QSize, Qt
from qtpy.QtGui import QColor, QHideEvent, QIcon, QPainter, QPixmap, QShowEvent
from qtpy.QtWidgets import (
    QColorDialog,
    QComboBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QMenu,
    QPushButton,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.gui.aiming import seen_by
from app.gui.ball import Ball
from app.gui.lights import KINDS, displayed, kind_of, power, powered
from app.gui.slider import Slider
from app.gui.triple import Triple
from app.session import Cone, Directional, Frame, Point, Vector

if TYPE_CHECKING:
    from app.gui.window import Window

TITLE, AREA, ORDER, SHOWN = "Lights", "right", 2, True
_ROWS = 4
_FRAMES = {"camera": "moves with the camera", "world": "stays with the mesh"}


def build(window: "Window") -> QWidget:
    """Make the dock's content.

    Parameters
    ----------
    window : Window
        What it is about.

    Returns
    -------
    QWidget
        The content.
    """
    return LightsPanel(window)


class LightsPanel(QWidget):
    """All lights, and what can be done to the chosen one.

    Parameters
    ----------
    window : Window
        What it is about.
    """

    def __init__(self, window: "Window") -> None:
        super().__init__(window)
        self._window, self._lights = window, window.lights
        self.list = QListWidget(self)
        self.list.setAccessibleName("Lights")
        self.list.setToolTip("The session's lights; the chosen one is turned by L and a drag")
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setMinimumHeight(_ROWS * self.fontMetrics().height() * 3 // 2)
        self.list.setMaximumHeight(2 * _ROWS * self.fontMetrics().height())
        self.list.currentRowChanged.connect(self._on_row)
        self.ball = Ball()
        self.ball.grabbed.connect(self._on_grabbed)
        self.ball.aimed.connect(self._lights.aim)
        self.ball.released.connect(window.controller.end_drag)
        column = QVBoxLayout(self)
        column.addWidget(self.list)
        column.addLayout(self._buttons())
        column.addWidget(self.ball)
        self.form = QFormLayout()
        self.form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        self.form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        column.addLayout(self.form)
        column.addStretch(1)
        self._fill_form()
        window.controller.document.changed.connect(lambda *_: self.follow())
        window.canvas.moved.connect(lambda _: self._show_ball())
        window.canvas.recolored.connect(self._show_ball)
        window.canvas.filled.connect(self._show_ball)
        self._lights.chosen.connect(lambda _: self.follow())
        self.follow()

    def showEvent(self, event: QShowEvent | None) -> None:  # noqa: N802
        """Show the handles in the view."""
        self._window.light_tool.handles.show(True)

    def hideEvent(self, event: QHideEvent | None) -> None:  # noqa: N802
        """Hide the handles."""
        self._window.light_tool.handles.show(False)

    def follow(self) -> None:
        """Show what the session says."""
        self._show_list()
        light = self._lights.light
        for widget in (self.remove, self.duplicate, *self._fields()):
            widget.setEnabled(light is not None)
        if light is None:
            self._show_ball()
            return
        directional, cone = isinstance(light, Directional), isinstance(light, Cone)
        self._choose(self.kind, kind_of(light))
        self._choose(self.frame, light.frame if isinstance(light, Directional) else "world")
        self.form.setRowVisible(self.frame, directional)
        self.form.setRowVisible(self.position, not directional)
        self.form.setRowVisible(self.direction, directional or cone)
        self.form.setRowVisible(self.angle, cone)
        if isinstance(light, Cone):
            self.angle.follow(light.angle)
        if not isinstance(light, Directional):
            self.position.follow(light.position)
        if not isinstance(light, Point):
            self.direction.follow(light.direction)
        rgb = power(light)
        self.strength.follow(max(rgb))
        self.color.setIcon(self._icon(rgb))
        name = "Irradiance" if directional else "Intensity"
        self.strong.setText(name)
        self._show_ball()

    def _buttons(self) -> QHBoxLayout:
        self.add = QToolButton(self)
        self.add.setText("Add")
        self.add.setToolTip("Add a light")
        self.add.setAccessibleName("Add a light")
        self.add.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        menu = QMenu(self.add)
        for kind in KINDS:
            menu.addAction(kind.capitalize(), partial(self._lights.add, kind))
        self.add.setMenu(menu)
        self.duplicate = QPushButton("Duplicate", self)
        self.duplicate.setToolTip("Add a copy of the chosen light")
        self.duplicate.clicked.connect(self._lights.duplicate)
        self.remove = QPushButton("Remove", self)
        self.remove.setToolTip("Take the chosen light away")
        self.remove.clicked.connect(self._lights.remove)
        row = QHBoxLayout()
        for button in (self.add, self.duplicate, self.remove):
            row.addWidget(button)
        row.addStretch(1)
        return row

    def _fill_form(self) -> None:
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
            self.form.addRow(label, widget)
        for slider in (self.strength, self.angle):
            slider.pressed.connect(self._window.controller.begin_drag)
            slider.released.connect(self._window.controller.end_drag)

    def _fields(self) -> tuple[QWidget, ...]:
        return (
            self.kind,
            self.frame,
            self.color,
            self.strength,
            self.position,
            self.direction,
            self.angle,
        )

    def _show_list(self) -> None:
        self.list.blockSignals(True)
        while self.list.count() > len(self._lights.all):
            self.list.takeItem(self.list.count() - 1)
        for index, light in enumerate(self._lights.all):
            item = self.list.item(index)
            if item is None:
                item = QListWidgetItem()
                self.list.addItem(item)
            item.setText(f"{index + 1}  {kind_of(light)}, {max(power(light)):.3g}")
            item.setIcon(self._icon(power(light)))
        self.list.setCurrentRow(self._lights.index)
        self.list.blockSignals(False)

    def _show_ball(self) -> None:
        camera = self._window.canvas.camera
        if camera is None:
            return
        shown = [
            (index, seen_by(light, camera), light.irradiance)
            for index, light in enumerate(self._lights.all)
            if isinstance(light, Directional)
        ]
        self.ball.show_lights(shown, self._lights.index)

    def _icon(self, rgb: Vector) -> QIcon:
        side = self.fontMetrics().height()
        square = QPixmap(QSize(side, side))
        square.fill(self.palette().mid().color())
        painter = QPainter(square)
        painter.fillRect(1, 1, side - 2, side - 2, QColor.fromRgbF(*displayed(rgb)))
        painter.end()
        return QIcon(square)

    def _on_row(self, row: int) -> None:
        if row >= 0:
            self._lights.choose(row)

    def _on_grabbed(self, index: int) -> None:
        self._lights.choose(index)
        self._window.controller.begin_drag()

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
            self._window.controller.failed.emit("a light needs a direction other than 0, 0, 0")
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

    def _choose(self, combo: QComboBox, data: str) -> None:
        combo.setCurrentIndex(combo.findData(data))


def _combo(name: str, entries: dict[str, str]) -> QComboBox:
    combo = QComboBox()
    combo.setAccessibleName(name)
    for data, text in entries.items():
        combo.addItem(text, data)
    return combo
