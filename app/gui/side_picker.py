"""One place of a comparison: what is put there, with its parameters."""

from typing import Any

from qtpy.QtCore import Signal
from qtpy.QtWidgets import QComboBox, QHBoxLayout, QLabel, QSizePolicy, QVBoxLayout, QWidget

from app.gui import versus
from app.gui.form import ParameterForm, Values
from app.session import ComparedBy, Method, Session

_NOBODY = "none"


class SidePicker(QWidget):
    """A letter, a list of names and, below, the parameters of the chosen one.

    Parameters
    ----------
    index : int
        Of the place, from 0 for A.
    parent : QWidget
        Where it lies.
    """

    picked = Signal(object)
    """Emitted with the `Method` that a person chose, None for none."""
    pressed = Signal()
    """Emitted when the drag of a parameter begins."""
    released = Signal()
    """Emitted when the drag of a parameter ends."""

    def __init__(self, index: int, parent: QWidget) -> None:
        super().__init__(parent)
        self._index = index
        self._by: ComparedBy | None = None
        self._shown: Method | None = None
        self.form: ParameterForm | None = None
        letter = versus.LETTERS[index]
        self.names = QComboBox(self)
        self.names.setAccessibleName(f"Compared {letter}")
        self.names.setToolTip(
            "What the others are held against" if index == 0 else f"What is shown as {letter}"
        )
        self.names.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.names.setSizeAdjustPolicy(
            QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
        )
        self.names.setMinimumContentsLength(10)
        self.names.currentTextChanged.connect(self._on_name)
        label = QLabel(letter, self)
        label.setBuddy(self.names)
        row = QHBoxLayout()
        row.addWidget(label)
        row.addWidget(self.names, 1)
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.addLayout(row)

    def follow(self, session: Session) -> None:
        """Show what a session compares here, without telling anybody.

        Parameters
        ----------
        session : Session
            Any session.
        """
        sides = versus.sides(session)
        method = sides[self._index] if self._index < len(sides) else None
        # D comes after C.
        self.setVisible(self._index <= len(sides))
        self.names.blockSignals(True)
        own = versus.names(session, session.compared_by)
        listed = [*([_NOBODY] if self._index > 1 else []), *own]
        if listed != [self.names.itemText(at) for at in range(self.names.count())]:
            self.names.clear()
            self.names.addItems(listed)
        self.names.setCurrentIndex(self.names.findText(method.name if method else _NOBODY))
        self.names.blockSignals(False)
        self._follow_form(session.compared_by, method)

    def _follow_form(self, by: ComparedBy, method: Method | None) -> None:
        name = None if method is None else method.name
        if (by, name) != (self._by, None if self._shown is None else self._shown.name):
            if self.form is not None:
                self._column.removeWidget(self.form)
                self.form.hide()  # at once; it is deleted when it is no longer at work
                self.form.deleteLater()
                self.form = None
            plugin = None if name is None else _plugin(by, name)
            if plugin is not None and method is not None:
                self.form = ParameterForm(plugin, method.parameters, self._on_values)
                self.form.pressed.connect(self.pressed)
                self.form.released.connect(self.released)
                self.form.setVisible(bool(self.form.controls))
                self._column.addWidget(self.form)
        elif self.form is not None and method is not None and method != self._shown:
            self.form.follow(method.parameters)
        self._by, self._shown = by, method

    def _on_name(self, name: str) -> None:
        self.picked.emit(None if name == _NOBODY else Method(name))

    def _on_values(self, values: Values) -> None:
        if self._shown is not None:
            self.picked.emit(Method(self._shown.name, values))


def _plugin(by: ComparedBy, name: str) -> type[Any] | None:
    """Return the class of a plug-in; materials have none."""
    from lutcore.errors import CurvelightError
    from lutcore.estimation import estimator_registry
    from lutcore.shading import model_registry

    if by == "material":
        return None
    try:
        return (model_registry if by == "model" else estimator_registry).get(name)
    except CurvelightError:
        return None  # a session's plug-in that is not installed: the picture says so
