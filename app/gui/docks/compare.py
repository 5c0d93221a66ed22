"""What is compared, how it is shown, and how far apart it is."""

from functools import partial
from typing import TYPE_CHECKING

from qtpy.QtWidgets import (
    QButtonGroup,
    QCheckBox,
    QComboBox,
    QFormLayout,
    QHBoxLayout,
    QPushButton,
    QRadioButton,
    QVBoxLayout,
    QWidget,
)

from app.gui import flicker, versus
from app.gui.apart import Apart
from app.gui.side_picker import SidePicker
from app.gui.slider import Slider
from app.session import ComparedBy, Method, Session

if TYPE_CHECKING:
    from app.gui.comparing import Mode
    from app.gui.window import Window

TITLE, AREA, ORDER, SHOWN = "Compare", "right", 4, True
_KINDS: dict[ComparedBy, str] = {
    "model": "Shading models",
    "estimator": "Curvature estimators",
    "material": "Materials",
}
_MODES: dict["Mode", tuple[str, str]] = {
    "side": ("Side by side", "Each in a view of its own, all with one camera (F6)"),
    "swipe": ("Swipe", "A left and B right of a divider that is dragged over the surface (F7)"),
    "flicker": ("Flicker", "A and B in turn, in one place: what differs moves (B)"),
}


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
    return ComparePanel(window)


class ComparePanel(QWidget):
    """The controls of a comparison.

    Parameters
    ----------
    window : Window
        What it is about.
    """

    def __init__(self, window: "Window") -> None:
        super().__init__(window)
        self._window = window
        self._comparing = window.comparing
        column = QVBoxLayout(self)
        column.addLayout(self._what())
        column.addLayout(self._sides())
        column.addLayout(self._how())
        self.apart = Apart(self)
        self.apart.asked.connect(self._comparing.face_worst)
        column.addWidget(self.apart)
        column.addStretch(1)
        window.controller.document.changed.connect(lambda session, _: self._follow(session))
        window.controller.shown.connect(self.apart.follow)
        self._comparing.flicker.changed.connect(self._follow_mode)
        self._follow(window.controller.session)
        if window.controller.outcome is not None:
            self.apart.follow(window.controller.outcome)

    def _what(self) -> QFormLayout:
        self.kind = QComboBox(self)
        for by, words in _KINDS.items():
            self.kind.addItem(words, by)
        self.kind.setAccessibleName("What is compared")
        self.kind.setToolTip(
            "Models and materials are shaded under one exposure; estimators show the quantity "
            "that is chosen for curvature, in one range"
        )
        self.kind.currentIndexChanged.connect(
            lambda index: self._comparing.compare_by(self.kind.itemData(index))
        )
        form = QFormLayout()
        form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        form.addRow("Compare", self.kind)
        return form

    def _sides(self) -> QVBoxLayout:
        column = QVBoxLayout()
        self.sides: list[SidePicker] = []
        document = self._window.controller.document
        for index in range(versus.MOST):
            picker = SidePicker(index, self)
            picker.picked.connect(partial(self._on_picked, index))
            picker.pressed.connect(document.begin_drag)
            picker.released.connect(document.end_drag)
            column.addWidget(picker)
            self.sides.append(picker)
        self.swap = QPushButton("Swap A and B", self)
        self.swap.setAccessibleName("Swap A and B")
        self.swap.setToolTip("Exchange the first and the second (X)")
        self.swap.clicked.connect(self._comparing.swap)
        column.addWidget(self.swap)
        return column

    def _how(self) -> QVBoxLayout:
        column = QVBoxLayout()
        self.modes: dict[str, QRadioButton] = {}
        group = QButtonGroup(self)
        for mode, (words, doc) in _MODES.items():
            button = QRadioButton(words, self)
            button.setAccessibleName(words)
            button.setToolTip(doc)
            button.clicked.connect(partial(self._on_mode, mode))
            group.addButton(button)
            column.addWidget(button)
            self.modes[mode] = button
        self.rate = Slider(
            "Flicker rate", "Pictures in a second", flicker.SLOWEST, flicker.FASTEST, suffix=" /s"
        )
        self.rate.follow(self._comparing.flicker.rate)
        self.rate.changed.connect(self._comparing.flicker.set_rate)
        self.other = QPushButton("Show the other", self)
        self.other.setAccessibleName("Show the other")
        self.other.setToolTip("Stop the clock, and show B instead of A or A instead of B (N)")
        self.other.clicked.connect(self._comparing.turn)
        row = QHBoxLayout()
        row.addWidget(self.rate, 1)
        column.addLayout(row)
        column.addWidget(self.other)
        self.difference = QCheckBox("Map of the difference", self)
        self.difference.setAccessibleName("Map of the difference")
        self.difference.setToolTip(
            "Show on the surface how far the others are from A: CIEDE2000, where 1 is just "
            "visible, or for estimators the quantity in its unit (D)"
        )
        self.difference.clicked.connect(self._comparing.show_difference)
        column.addWidget(self.difference)
        return column

    def _on_picked(self, index: int, method: Method | None) -> None:
        self._comparing.put(index, method)

    def _on_mode(self, mode: "Mode") -> None:
        self._comparing.enter(mode)

    def _follow(self, session: Session) -> None:
        self.kind.blockSignals(True)
        self.kind.setCurrentIndex(self.kind.findData(session.compared_by))
        self.kind.blockSignals(False)
        for picker in self.sides:
            picker.follow(session)
        self.difference.setChecked(session.difference)
        self._follow_mode()

    def _follow_mode(self) -> None:
        mode = self._comparing.mode
        self.modes[mode].setChecked(True)
        for widget in (self.rate, self.other):
            widget.setEnabled(mode == "flicker")
