"""Which estimators are asked how far they are apart."""

from typing import TYPE_CHECKING

from qtpy.QtWidgets import QMenu, QToolButton

from app.session import Method

if TYPE_CHECKING:
    from app.gui.controller import Controller

_LEAST = 3


class PeersButton(QToolButton):
    """A button with a list of estimators to tick.

    Parameters
    ----------
    controller : Controller
        Of the window.
    """

    def __init__(self, controller: "Controller") -> None:
        super().__init__()
        self._controller = controller
        self.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.setAccessibleName("Estimators whose disagreement is shown")
        self.setToolTip("Estimators whose disagreement is shown, three or more")
        self.list = QMenu(self)
        self.setMenu(self.list)
        self.list.aboutToShow.connect(self._fill)

    def follow(self, peers: tuple[Method, ...]) -> None:
        """Show how many are chosen.

        Parameters
        ----------
        peers : tuple of Method
            The session's.
        """
        self.setText(f"{len(peers)} estimators" if peers else "No disagreement")

    def _fill(self) -> None:
        from lutcore.estimation import estimators

        self.list.clear()
        chosen = {one.name for one in self._controller.session.peers}
        for name in estimators():
            action = self.list.addAction(name)
            action.setCheckable(True)
            action.setChecked(name in chosen)
            action.triggered.connect(lambda on, name=name: self._choose(name, on))

    def _choose(self, name: str, on: bool) -> None:
        session = self._controller.session
        kept = tuple(one for one in session.peers if one.name != name)
        peers = (*kept, Method(name)) if on else kept
        if len(peers) < _LEAST:
            self._controller.noted.emit(f"a disagreement needs {_LEAST} estimators")
            if session.quantity == "disagreement":
                return
        self._controller.change("estimators that disagree", peers=peers)
