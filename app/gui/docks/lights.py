"""The lights: a list, a ball to aim them on, and the chosen one in numbers."""

from functools import partial
from typing import TYPE_CHECKING

from qtpy.QtCore import Qt
from qtpy.QtGui import QHideEvent, QShowEvent
from qtpy.QtWidgets import (
    QHBoxLayout,
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
from app.gui.light_form import LightForm, swatch
from app.gui.lights import KINDS, kind_of, power
from app.session import Directional

if TYPE_CHECKING:
    from app.gui.window import Window

TITLE, AREA, ORDER, SHOWN = "Lights", "right", 2, True
_ROWS = 4


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
        self.form = LightForm(window)
        column.addWidget(self.form)
        column.addStretch(1)
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
        chosen = self._lights.light is not None
        for widget in (self.remove, self.duplicate):
            widget.setEnabled(chosen)
        self.form.follow()
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
            item.setIcon(swatch(self, power(light)))
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

    def _on_row(self, row: int) -> None:
        if row >= 0:
            self._lights.choose(row)

    def _on_grabbed(self, index: int) -> None:
        self._lights.choose(index)
        self._window.controller.begin_drag()
