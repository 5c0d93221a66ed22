"""Takes the README's pictures of the window: ``python -m tests.screenshots``."""

import os
import sys
import tempfile
from pathlib import Path

from tests.screen import start_screen

_DOCS = Path(__file__).parents[1] / "docs"
_CALM = 10  # looks in a row at which nothing is being computed


def main() -> None:
    """Open the window on a virtual screen, do what a person does, and take pictures."""
    start_screen()
    with tempfile.TemporaryDirectory() as folder:
        os.environ["CURVELIGHT_CONFIG_DIR"] = folder
        _take()


def _take() -> None:
    from qtpy.QtCore import QEventLoop, QTimer
    from qtpy.QtWidgets import QApplication

    from app.gui.window import Window
    from app.session import Session

    application = QApplication(sys.argv[:1])
    window = Window(Session())
    window.resize(1280, 800)
    window.show()
    window.start()

    def wait() -> None:
        # QTest.qWait keeps Python's lock, and so the window's workers waiting.
        loop, timer, calm = QEventLoop(), QTimer(), []

        def look() -> None:
            calm.append(not (window.controller.worker.busy or window.controller.aside.busy))
            if len(calm) > _CALM and all(calm[-_CALM:]):
                loop.quit()

        timer.timeout.connect(look)
        timer.start(100)
        loop.exec()

    def take(name: str) -> None:
        wait()
        screen = application.primaryScreen()
        assert screen.grabWindow(0).save(str(_DOCS / f"{name}.png"))

    wait()
    window.controller.change("view", view="figure")
    take("window")
    window.controller.change("view", view="shade")
    window.act(window.actions_["window.choose"])
    panel = window.docks["choose"].fill()
    wait()
    panel.map.click()
    take("window-choose")
    window.close()


if __name__ == "__main__":
    main()
