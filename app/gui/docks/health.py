"""What is odd about the mesh, and what can be done about it."""

from typing import TYPE_CHECKING

from qtpy.QtCore import Qt
from qtpy.QtWidgets import (
    QGridLayout,
    QGroupBox,
    QHBoxLayout,
    QLabel,
    QListWidget,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.gui.repairing import Repairing
from app.gui.slider import Number, Whole
from app.repairs import KINDS
from lutcore.health import MeshHealth
from lutcore.parameters import Number as Accepted

if TYPE_CHECKING:
    from app.gui.controller import Outcome
    from app.gui.window import Window
    from app.session import Session

TITLE, AREA, ORDER, SHOWN = "Health", "right", 7, False


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
    return HealthPanel(window)


class HealthPanel(QWidget):
    """Remarks on the mesh above buttons that repair it.

    Parameters
    ----------
    window : Window
        What it is about.
    """

    def __init__(self, window: "Window") -> None:
        super().__init__(window)
        self._controller = controller = window.controller
        self.repairing = Repairing(controller)
        self.counts = QLabel(self)
        self.counts.setAccessibleName("Size of the mesh")
        self.remarks = QLabel(self)
        self.remarks.setAccessibleName("What is odd about the mesh")
        for label in (self.counts, self.remarks):
            label.setWordWrap(True)
            label.setTextFormat(Qt.TextFormat.PlainText)
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.buttons: dict[str, QPushButton] = {}
        self.numbers: dict[str, Number | Whole] = {}
        self.done = QListWidget(self)
        self.done.setAccessibleName("Repairs that were done, in order")
        self.done.setToolTip("Repairs that were done, in order; they are part of the session")
        self.leave_out = QPushButton("Leave out", self)
        self.leave_out.setToolTip("Do without the repair that is selected, or the last one")
        self.leave_out.clicked.connect(self._on_leave_out)
        self.leave_all = QPushButton("Original", self)
        self.leave_all.setToolTip("Do without all repairs: the mesh as it is in the file")
        self.leave_all.clicked.connect(lambda _: self.repairing.take_all_back())
        self._lay_out()
        self.repairing.found.connect(self._on_found)
        controller.document.changed.connect(self._follow)
        controller.shown.connect(self._on_shown)
        self._follow(controller.session)
        if controller.outcome is not None:
            self.repairing.look(controller.outcome)

    def _lay_out(self) -> None:
        repairs = QGroupBox("Repair", self)
        grid = QGridLayout(repairs)
        for row, (name, kind) in enumerate(KINDS.items()):
            button = self.buttons[name] = QPushButton(kind.words, self)
            button.setToolTip(kind.doc)
            button.clicked.connect(lambda _=False, name=name: self._on_repair(name))
            grid.addWidget(button, row, 0)
            if kind.value is None:
                continue
            self.numbers[name] = self._number(kind.value, kind.default)
            grid.addWidget(self.numbers[name], row, 1)
        row_of_two = QHBoxLayout()
        row_of_two.addWidget(self.leave_out)
        row_of_two.addWidget(self.leave_all)
        whole = QVBoxLayout(self)
        whole.addWidget(self.counts)
        whole.addWidget(self.remarks)
        whole.addWidget(repairs)
        whole.addWidget(self.done, 1)
        whole.addLayout(row_of_two)

    def _number(self, value: Accepted, default: float) -> Number | Whole:
        number: Number | Whole
        if value.integer:
            number = Whole(self)
            number.setRange(int(value.low), int(value.high))
            number.setValue(int(default))
        else:
            number = Number(self)
            number.setRange(value.low, value.high)
            number.setValue(default)
        number.setSuffix(f" {value.unit.split()[0]}")
        number.setAccessibleName(value.doc)
        number.setToolTip(f"{value.doc} In {value.unit}.")
        return number

    def showEvent(self, event: object) -> None:  # noqa: N802
        """Catch up with what happened unseen."""
        if self._controller.outcome is not None:
            self._on_shown(self._controller.outcome)

    def _on_shown(self, outcome: "Outcome") -> None:
        if self.isVisible():
            self.repairing.look(outcome)

    def _on_found(self, health: MeshHealth) -> None:
        outcome = self._controller.outcome
        mm_per_unit = outcome.mm_per_unit if outcome else 1.0
        whole = "a closed surface" if health.watertight else "an open surface"
        self.counts.setText(
            f"{health.vertices:,} vertices, {health.faces:,} faces, {whole}, diagonal "
            f"{health.diagonal * mm_per_unit:.4g} mm"
        )
        remarks = health.remarks(mm_per_unit)
        bullet = "\N{BULLET} "
        self.remarks.setText("\n".join(bullet + one for one in remarks) or "Nothing is odd.")
        needed = {
            "islands": health.islands > 1,
            "manifold": health.nonmanifold_edges + health.nonmanifold_vertices > 0,
            "holes": health.boundary_edges > 0,
            "orient": health.flipped_edges + health.inside_out_islands > 0,
        }
        for name, button in self.buttons.items():
            button.setEnabled(needed.get(name, True))

    def _follow(self, session: "Session", _: object = None) -> None:
        self.done.clear()
        self.done.addItems([f"{i}. {one.words}" for i, one in enumerate(session.repairs, 1)])
        self.leave_out.setEnabled(bool(session.repairs))
        self.leave_all.setEnabled(bool(session.repairs))

    def _on_repair(self, name: str) -> None:
        number = self.numbers.get(name)
        self.repairing.do(name, None if number is None else number.value())

    def _on_leave_out(self) -> None:
        row = self.done.currentRow()
        self.repairing.take_back(row if row >= 0 else self.done.count() - 1)
