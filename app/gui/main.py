"""Starts the window."""

import os
import sys

from app import gl


def run(argument: str | None) -> int:
    """Open the window and stay until it is closed.

    Parameters
    ----------
    argument : str or None
        A mesh, ``sample:NAME``, a session file, or nothing: the scanned marble face.

    Returns
    -------
    int
        Exit code.

    Raises
    ------
    DrawingError
        If there is no OpenGL or no screen.
    SessionError
        If the session file cannot be read.
    """
    gl.require()
    _require_screen()
    from qtpy.QtWidgets import QApplication

    from app.gui import theme
    from app.gui.window import Window

    application = QApplication.instance() or QApplication(sys.argv[:1])
    application.setApplicationName("Curvelight")
    window = Window()
    window.faults.install()
    theme.apply(theme.chosen(window.settings))
    window.show()
    window.rescue.offer()
    # Asked for once the window is there, so that a broken file is told in it.
    if argument is None:
        window.start()
    else:
        window.controller.open(argument)
    return int(application.exec())


def _require_screen() -> None:
    linux = sys.platform.startswith("linux")
    if linux and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise gl.DrawingError(
            "there is no screen to open a window on (DISPLAY is not set); "
            "use curvelight figure, shade or curvature, which need none"
        )
    if linux:
        # VTK draws into windows of X; Wayland's own have no such handle.
        os.environ.setdefault("QT_QPA_PLATFORM", "xcb")
