"""A screen, and a window on it."""

import os
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pytest

from tests.screen import start_screen

os.environ.setdefault("QT_API", "pyside6")
_PATIENCE = 60_000  # ms


@pytest.fixture(scope="session", autouse=True)
def screen() -> None:
    """A virtual screen of our own, whatever screen there is: tests must not depend on it."""
    start_screen()
    from qtpy.QtCore import Qt
    from qtpy.QtWidgets import QApplication

    # Those of a desktop would wait for a person.
    QApplication.setAttribute(Qt.ApplicationAttribute.AA_DontUseNativeDialogs)


@pytest.fixture
def qtbot(qtbot):
    """pytest-qt's, with patience: on a busy machine what comes in the end is not wrong."""
    for name in ("waitUntil", "waitSignal", "waitExposed"):
        setattr(qtbot, name, partial(getattr(qtbot, name), timeout=_PATIENCE))
    return qtbot


@pytest.fixture(autouse=True)
def config(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of its own for what the window remembers."""
    folder = tmp_path / "config"
    monkeypatch.setenv("CURVELIGHT_CONFIG_DIR", str(folder))
    return folder


@pytest.fixture
def open_window(qtbot) -> Iterator[Callable]:
    """A function that shows a window of a session and waits for its first picture."""
    from app.gui.window import Window

    made = []

    def opened(session=None, size=(1000, 700), path="vertex") -> Window:
        window = Window(session)
        window.pixel_path.choose(path)  # which is faster would depend on the machine
        made.append(window)
        window.resize(*size)
        window.show()
        qtbot.waitExposed(window)
        # Without a window manager nothing else gives it the keyboard.
        window.activateWindow()
        qtbot.waitUntil(window.isActiveWindow)
        window.start()
        settled(qtbot, window)
        assert window.controller.outcome is not None
        return window

    yield opened
    for window in made:
        window.close()
        window.deleteLater()
    qtbot.wait(1)


@pytest.fixture
def window(open_window):
    """A window of a small mesh with its first picture."""
    from app.session import Session

    return open_window(Session(mesh="sample:sphere"))


def settled(qtbot, window, timeout: int = 240_000) -> None:
    """Wait until all that was asked for has been computed and drawn."""
    worker = window.controller.worker
    qtbot.wait(1)
    while True:
        qtbot.waitUntil(lambda: not worker.busy, timeout=timeout)
        qtbot.wait(20)  # what a job gave is taken, and may ask for another
        if not worker.busy:
            return


def pixels(window):
    """What the view shows, (height, width, 3) uint8, the first row at the top."""
    from app.render import grab

    canvas = window.canvas
    canvas.draw()
    return grab(canvas.window_, tuple(canvas.window_.GetSize()))
