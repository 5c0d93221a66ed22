"""Faults of the program, wherever they are raised: told in the window, none is swallowed.

What a slot, an event or VTK's observer raises is given to `sys.excepthook`, what a thread raises to
`threading.excepthook`, what a destructor raises to `sys.unraisablehook`; what a job of the worker
raises comes from the controller.
"""

import platform
import sys
import threading
import traceback
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from types import TracebackType
from typing import TYPE_CHECKING, Any

from psygnal import EmitLoopError, Signal
from qtpy.QtGui import QGuiApplication

from app.gui.controller import message_of
from lutcore.errors import CurvelightError

if TYPE_CHECKING:
    from app.gui.window import Window

_PACKAGES = ("curvelight", "PySide6", "vtk", "numpy", "numba")
_ADVICE = (
    "The window goes on; save the session (Ctrl+S), and if it happens again report it with the "
    "details"
)


class Faults:
    """Shows in a window's banner what went wrong, with its details to copy.

    Parameters
    ----------
    window : Window
        Has its controller, its journal and its banner.
    """

    told = Signal(str)
    """Emitted with the details of each fault."""

    def __init__(self, window: "Window") -> None:
        self._window = window
        self._busy = False
        self._before: tuple[Any, Any, Any] | None = None
        window.controller.faulted.connect(self.tell)

    def install(self) -> None:
        """Be told of what nothing else caught in this process, until `remove`."""
        self._before = sys.excepthook, threading.excepthook, sys.unraisablehook
        sys.excepthook = self._on_exception
        threading.excepthook = lambda args: self._from_anywhere(args.exc_value, args.thread)
        sys.unraisablehook = lambda args: self._from_anywhere(args.exc_value, args.object)

    def remove(self) -> None:
        """Give the hooks back."""
        if self._before is not None:
            sys.excepthook, threading.excepthook, sys.unraisablehook = self._before
            self._before = None

    def tell(self, error: BaseException) -> None:
        """Show an error; on the window's thread.

        Parameters
        ----------
        error : Exception
            What was raised.
        """
        if self._busy:  # showing it raised, too: the terminal has both
            return
        self._busy = True
        try:
            cause = cause_of(error)
            controller = self._window.controller
            if isinstance(cause, CurvelightError | MemoryError):
                controller.failed.emit(message_of(cause))
                return
            text, details = f"{message_of(cause)}. {_ADVICE}", details_of(error)
            self._window.journal.add(text)
            self._window.banner.warn(text, lambda: self._copy(details))
            self.told.emit(details)
        finally:
            self._busy = False

    def _copy(self, details: str) -> None:
        QGuiApplication.clipboard().setText(details)
        self._window.controller.noted.emit("copied the details of the fault")

    def _on_exception(
        self, kind: type[BaseException], error: BaseException, trace: TracebackType | None
    ) -> None:
        sys.__excepthook__(kind, error, trace)
        if issubclass(kind, Exception):  # an interrupt ends the program
            self._later(error)

    def _from_anywhere(self, error: BaseException | None, where: object) -> None:
        if error is not None:
            sys.stderr.write(f"raised in {where!r}:\n")
            sys.__excepthook__(type(error), error, error.__traceback__)
            self._later(error)

    def _later(self, error: BaseException) -> None:
        """Show it soon: whatever raised may be in the midst of something, or in a thread."""
        call: Callable[[], None] = lambda: self.tell(error)  # noqa: E731
        self._window.controller.worker.post(call)


def cause_of(error: BaseException) -> Exception:
    """Return what was raised first: signals wrap what their slots raise.

    Parameters
    ----------
    error : BaseException
        What was caught.

    Returns
    -------
    Exception
        What it was raised from.
    """
    while isinstance(error, EmitLoopError) and error.__cause__ is not None:
        error = error.__cause__
    return error if isinstance(error, Exception) else RuntimeError(repr(error))


def details_of(error: BaseException) -> str:
    """Return what who mends the program needs to know.

    Parameters
    ----------
    error : BaseException
        What was raised.

    Returns
    -------
    str
        Where it was raised, and the versions; nothing of the session or the mesh.
    """
    lines = [f"Python {platform.python_version()} on {platform.platform()}"]
    for package in _PACKAGES:
        try:
            lines.append(f"{package} {version(package)}")
        except PackageNotFoundError:
            lines.append(f"{package}: not installed")
    return "".join(traceback.format_exception(error)) + "\n" + "\n".join(lines) + "\n"
