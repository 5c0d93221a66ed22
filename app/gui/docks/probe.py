"""What is under the mouse, and a table of what was pinned."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from qtpy.QtCore import QTimer
from qtpy.QtGui import QColor, QGuiApplication, QIcon, QPixmap
from qtpy.QtWidgets import (
    QAbstractItemView,
    QFileDialog,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSplitter,
    QTableWidget,
    QTableWidgetItem,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.gui.canvas import Place
from app.gui.pins import Pins
from app.gui.probe import Probing
from app.probing import Probe
from app.quantities import QUANTITIES
from app.writing import WriteError, write_bytes

if TYPE_CHECKING:
    from app.gui.window import Window

TITLE, AREA, ORDER, SHOWN = "Probe", "bottom", 1, False
_REST = 40  # ms that the mouse rests before the models are asked
_PIN = (1.0, 0.85, 0.1)
_HERE = (1.0, 1.0, 1.0)


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
    return ProbePanel(window)


class ProbePanel(QSplitter):
    """Values under the mouse beside the table of pins.

    Parameters
    ----------
    window : Window
        What it is about.
    """

    def __init__(self, window: "Window") -> None:
        super().__init__(window)
        self._window = window
        self.probing = Probing(window.controller)
        self._pins = Pins(window.canvas, _PIN)
        self._here = Pins(window.canvas, _HERE, 5.0)
        self._place: Place | None = None
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(_REST)
        self._rest.timeout.connect(self._ask)
        self.values = QTreeWidget(self)
        self.values.setHeaderLabels(["Under the mouse", "", "predicted error"])
        self.values.setRootIsDecorated(False)
        self.values.setAccessibleName("Values under the mouse")
        self.addWidget(self.values)
        self.addWidget(self._pinned())
        self.setSizes([400, 600])
        self.probing.found.connect(self._on_found)
        self.probing.pins_changed.connect(self._on_pins)
        window.canvas.hovered.connect(self._on_hover)
        window.canvas.clicked.connect(self._on_click)
        self._on_found(None)
        self._on_pins()

    def _pinned(self) -> QWidget:
        side = QWidget(self)
        self.table = QTableWidget(side)
        self.table.setAccessibleName("Pins")
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        row = QHBoxLayout()
        self.buttons: dict[str, QPushButton] = {}
        for text, doc, action in (
            ("Copy", "Copy the table", self._copy),
            ("CSV\N{HORIZONTAL ELLIPSIS}", "Save the table as CSV", self._save),
            ("Remove", "Remove the selected pins", self._remove),
            ("Clear", "Remove all pins", partial(self.probing.unpin, None)),
        ):
            button = QPushButton(text, side)
            button.setToolTip(doc)
            button.setAccessibleName(doc)
            button.clicked.connect(lambda _=False, action=action: action())
            row.addWidget(button)
            self.buttons[text.strip("\N{HORIZONTAL ELLIPSIS}")] = button
        row.addWidget(QLabel("Click the mesh to pin", side), 1)
        column = QVBoxLayout(side)
        column.addLayout(row)
        column.addWidget(self.table, 1)
        return side

    def _on_hover(self, place: Place | None) -> None:
        if not self.isVisible():
            return
        self._place = place
        if place is None or place.panel is None:
            self._rest.stop()
            self.probing.leave()
        else:
            self._rest.start()

    def hideEvent(self, event: object) -> None:  # noqa: N802
        """Take the mark off the mesh: nobody follows the mouse any more."""
        self._rest.stop()
        self.probing.leave()

    def _on_click(self, place: Place) -> None:
        camera = self._window.canvas.camera
        if self.isVisible() and camera is not None and place.panel is not None:
            self.probing.pin(camera, place.right, place.up)

    def _ask(self) -> None:
        camera, place = self._window.canvas.camera, self._place
        if camera is not None and place is not None:
            self.probing.look(camera, place.right, place.up)

    def _on_found(self, found: Probe | None) -> None:
        self._here.show([found.position] if found else [])
        self.values.clear()
        if found is None:
            self._add("Point at the mesh", "")
            self._widen()
            return
        x, y, z = found.position
        self._add("vertex", str(found.vertex))
        self._add("position", f"{x:.6g}, {y:.6g}, {z:.6g}")
        for name, quantity in QUANTITIES.items():
            if name not in found.values:
                continue
            value, error = found.values[name], found.values.get(f"{name}_error")
            bar = "" if error is None else f" \N{PLUS-MINUS SIGN} {error:.2g}"
            self._add(
                quantity.name, f"{value:.4g}{bar} {quantity.printed_unit if quantity.power else ''}"
            )
        for one in found.readings:
            words = ", ".join(map(str, one.color))
            error_words = "" if one.error is None else f"{100.0 * one.error:.3g} % of R_d"
            self._add(one.model, words, error_words).setIcon(1, _swatch(one.color))
        self._widen()

    def _widen(self) -> None:
        for column in range(self.values.columnCount()):
            self.values.resizeColumnToContents(column)

    def _add(self, name: str, value: str, more: str = "") -> QTreeWidgetItem:
        item = QTreeWidgetItem([name, value.strip(), more])
        self.values.addTopLevelItem(item)
        return item

    def _on_pins(self) -> None:
        head, rows = self.probing.table()
        self.table.setColumnCount(len(head))
        self.table.setHorizontalHeaderLabels([name.replace("_", " ") for name in head])
        self.table.setRowCount(len(rows))
        for line, row in enumerate(rows):
            for column, text in enumerate(row):
                item = QTableWidgetItem(text)
                if text.startswith("#"):
                    item.setIcon(_swatch(QColor(text)))
                self.table.setItem(line, column, item)
        self.table.resizeColumnsToContents()
        self._pins.show([one.position for one in self.probing.pins])
        for button in self.buttons.values():
            button.setEnabled(bool(rows))

    def _copy(self) -> None:
        QGuiApplication.clipboard().setText(self.probing.as_csv())

    def _save(self) -> None:
        name, _ = QFileDialog.getSaveFileName(self, "Save the pins", "pins.csv", "CSV (*.csv)")
        if name:
            self.save(Path(name))

    def save(self, path: Path) -> None:
        """Write the pins as CSV.

        Parameters
        ----------
        path : Path
            Where to; what goes wrong is said in the window.
        """
        try:
            write_bytes(path, self.probing.as_csv().encode())
        except WriteError as error:
            self._window.controller.failed.emit(str(error))

    def _remove(self) -> None:
        for row in sorted({one.row() for one in self.table.selectedIndexes()}, reverse=True):
            self.probing.unpin(row)


def _swatch(color: tuple[int, int, int] | QColor) -> QIcon:
    picture = QPixmap(16, 16)
    picture.fill(color if isinstance(color, QColor) else QColor(*color))
    return QIcon(picture)
