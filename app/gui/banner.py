"""A message above the view that stays until it is read."""

from collections.abc import Callable

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QFrame, QHBoxLayout, QLabel, QSizePolicy, QToolButton, QWidget


class Banner(QFrame):
    """Says what went wrong, without stopping the person.

    Parameters
    ----------
    parent : QWidget
        Where it lies.
    """

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("banner")
        self.setStyleSheet(
            "#banner { background: #8a2f24; } #banner QLabel, #banner QToolButton { color: white; }"
            " #answer, #details { background: transparent; border: 1px solid white;"
            " padding: 1px 8px; }"
        )
        self.label = QLabel(self)
        self.label.setWordWrap(True)
        self.label.setAccessibleName("Message")
        self.label.setTextFormat(Qt.TextFormat.PlainText)
        self.label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.label.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Minimum)
        self.close_ = close = QToolButton(self)
        close.setText("\N{MULTIPLICATION SIGN}")
        close.setAutoRaise(True)
        close.setAccessibleName("Close the message")
        close.clicked.connect(self._on_close)
        row = QHBoxLayout(self)
        row.setContentsMargins(10, 4, 4, 4)
        self.details = self._button("Copy details", "details")
        self.details.setToolTip("Copy where it was raised, and the versions of what runs")
        self.button = self._button("Answer to the message", "answer")
        self.details.clicked.connect(self._on_details)
        self.button.clicked.connect(self._on_button)
        self._offer: tuple[str, str, Callable[[], None]] | None = None
        self._copy: Callable[[], None] | None = None
        row.addWidget(self.label, 1)
        for one in (self.details, self.button, close):
            row.addWidget(one, 0, Qt.AlignmentFlag.AlignTop)
        self.hide()

    @property
    def offering(self) -> bool:
        """Whether it waits for an answer."""
        return self._offer is not None

    def warn(self, text: str, copy: Callable[[], None] | None = None) -> None:
        """Show a message; what is offered comes back when it is closed.

        Parameters
        ----------
        text : str
            What is wrong, where, and what to do.
        copy : callable, optional
            Copies its details.
        """
        self._copy = copy
        self.button.hide()
        self.details.setVisible(copy is not None)
        self.label.setText(text)
        self.show()

    def offer(self, text: str, answer: str, call: Callable[[], None]) -> None:
        """Show a message with a button.

        Parameters
        ----------
        text : str
            What can be done.
        answer : str
            What the button says.
        call : callable
            Does it; the message goes away.
        """
        self._offer = text, answer, call
        self.label.setText(text)
        self.button.setText(answer)
        self.button.setAccessibleName(answer)
        self.details.hide()
        self.button.show()
        self.show()

    def _button(self, text: str, name: str) -> QToolButton:
        made = QToolButton(self)
        made.setObjectName(name)
        made.setText(text)
        made.setAccessibleName(text)
        made.hide()
        return made

    def _on_close(self) -> None:
        waiting = self._offer
        if waiting is not None and self.button.isHidden():
            self.offer(*waiting)
            return
        self._offer = None
        self.hide()

    def _on_details(self) -> None:
        if self._copy is not None:
            self._copy()

    def _on_button(self) -> None:
        waiting, self._offer = self._offer, None
        self.hide()
        if waiting is not None:
            waiting[2]()
