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
            " #answer { background: transparent; border: 1px solid white; padding: 1px 8px; }"
        )
        self.label = QLabel(self)
        self.label.setWordWrap(True)
        self.label.setAccessibleName("Message")
        self.label.setTextFormat(Qt.TextFormat.PlainText)
        self.label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.label.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Minimum)
        close = QToolButton(self)
        close.setText("\N{MULTIPLICATION SIGN}")
        close.setAutoRaise(True)
        close.setAccessibleName("Close the message")
        close.clicked.connect(self._on_close)
        row = QHBoxLayout(self)
        row.setContentsMargins(10, 4, 4, 4)
        self.button = QToolButton(self)
        self.button.setObjectName("answer")
        self.button.setAccessibleName("Answer to the message")
        self.button.hide()
        self.button.clicked.connect(self._on_button)
        self._answer: Callable[[], None] | None = None
        row.addWidget(self.label, 1)
        row.addWidget(self.button, 0, Qt.AlignmentFlag.AlignTop)
        row.addWidget(close, 0, Qt.AlignmentFlag.AlignTop)
        self.hide()

    @property
    def offering(self) -> bool:
        """Whether it waits for an answer."""
        return self._answer is not None

    def warn(self, text: str) -> None:
        """Show a message.

        Parameters
        ----------
        text : str
            What is wrong, where, and what to do.
        """
        self._answer = None
        self.button.hide()
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
        self.label.setText(text)
        self.button.setText(answer)
        self.button.setAccessibleName(answer)
        self._answer = call
        self.button.show()
        self.show()

    def _on_close(self) -> None:
        self._answer = None
        self.hide()

    def _on_button(self) -> None:
        answer, self._answer = self._answer, None
        self.hide()
        if answer is not None:
            answer()
