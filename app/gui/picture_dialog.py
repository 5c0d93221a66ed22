"""Asks how large a picture is to be, and whether something lies behind."""

from qtpy.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QPushButton,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

_LEAST, _MOST = 16, 16384  # of `Session.size`


class PictureDialog(QDialog):
    """Width, height and background of a picture.

    Parameters
    ----------
    parent : QWidget
        What it belongs to.
    size : tuple of 2 ints
        What is proposed, pixels.
    view : tuple of 2 ints
        The size of the view, pixels.
    transparent : bool
        Whether no background is proposed.
    """

    def __init__(
        self, parent: QWidget, size: tuple[int, int], view: tuple[int, int], transparent: bool
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle("Save picture")
        self._view = view
        self.width_box = self._box("Width", size[0])
        self.height_box = self._box("Height", size[1])
        form = QFormLayout()
        form.addRow("&Width", self.width_box)
        form.addRow("&Height", self.height_box)
        self.once = self._preset("Size of the view", 1)
        self.twice = self._preset("Twice the size of the view", 2)
        self.clear = QCheckBox("&Transparent background", self)
        self.clear.setToolTip("Have nothing behind the mesh: the PNG gets an alpha channel")
        self.clear.setChecked(transparent)
        buttons = QDialogButtonBox.StandardButton
        self.buttons = QDialogButtonBox(buttons.Ok | buttons.Cancel, self)
        self.buttons.accepted.connect(self.accept)
        self.buttons.rejected.connect(self.reject)
        column = QVBoxLayout(self)
        column.addLayout(form)
        column.addWidget(self.once)
        column.addWidget(self.twice)
        column.addWidget(self.clear)
        column.addWidget(self.buttons)

    @property
    def chosen(self) -> tuple[int, int]:
        """Width and height, pixels."""
        return self.width_box.value(), self.height_box.value()

    def _box(self, name: str, value: int) -> QSpinBox:
        box = QSpinBox(self)
        box.setRange(_LEAST, _MOST)
        box.setValue(value)
        box.setSuffix(" px")
        box.setAccessibleName(f"{name} of the picture")
        box.setToolTip(f"{name} of the picture, pixels, {_LEAST} to {_MOST}")
        return box

    def _preset(self, text: str, factor: int) -> QPushButton:
        width, height = (min(max(factor * side, _LEAST), _MOST) for side in self._view)
        button = QPushButton(f"{text} ({width} x {height})", self)
        button.setToolTip(f"Take {width} x {height} pixels")
        button.setAutoDefault(False)

        def take() -> None:
            self.width_box.setValue(width)
            self.height_box.setValue(height)

        button.clicked.connect(take)
        return button
