"""A plug-in chosen by name, with the form of its parameters."""

from collections.abc import Callable
from typing import Any

from qtpy.QtWidgets import QComboBox, QVBoxLayout, QWidget

from app.gui.form import ParameterForm
from app.session import Method
from lutcore.parameters import Parameters


class PluginForm(QWidget):
    """Names, and below them the chosen one's parameters.

    Parameters
    ----------
    name : str
        What is chosen: ``"Model"``.
    changed : callable
        Gets the `Method` when a person changes something.
    begin, end : callable
        Called when a slider's drag begins and ends.
    """

    def __init__(
        self,
        name: str,
        changed: Callable[[Method], object],
        begin: Callable[[], None],
        end: Callable[[], None],
    ) -> None:
        super().__init__()
        self._changed, self._begin, self._end = changed, begin, end
        self._get: Callable[[str], type[Parameters]] | None = None
        self.names = QComboBox(self)
        self.names.setAccessibleName(name)
        self.names.activated.connect(self._on_name)
        self.form: ParameterForm | None = None
        self._formed = ""
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.addWidget(self.names)

    def offer(self, names: list[str], get: Callable[[str], Any]) -> None:
        """Give the plug-ins; before that the form is empty, as finding them takes a while.

        Parameters
        ----------
        names : list of str
            In the order of the list.
        get : callable
            Returns the class of a name.
        """
        self._get = get
        self.names.addItems(names)

    def follow(self, method: Method) -> None:
        """Show a method, without telling anybody.

        Parameters
        ----------
        method : Method
            A plug-in and its parameters.
        """
        if self._get is None:
            return
        self.names.setCurrentIndex(self.names.findText(method.name))
        if self.names.currentIndex() < 0:
            return  # what draws the picture says that there is none
        plugin = self._get(method.name)
        doc = (plugin.__doc__ or "").strip().split("\n")[0]
        self.names.setToolTip(doc)
        if method.name == self._formed and self.form is not None:
            self.form.follow(method.parameters)
            return
        if self.form is not None:
            self._column.removeWidget(self.form)
            self.form.hide()  # it is deleted later, and would lie below the new one until then
            self.form.deleteLater()
        self._formed = method.name
        self.form = ParameterForm(plugin, method.parameters, self._on_parameters)
        self.form.pressed.connect(self._begin)
        self.form.released.connect(self._end)
        self._column.addWidget(self.form)

    def _on_name(self, index: int) -> None:
        self._changed(Method(self.names.itemText(index)))

    def _on_parameters(self, values: dict[str, float | str]) -> None:
        self._changed(Method(self._formed, values))
