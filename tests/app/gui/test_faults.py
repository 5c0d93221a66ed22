"""Whatever is raised anywhere is told in the window, with its details, and the window goes on."""

import sys
import threading

import pytest
from qtpy.QtCore import QEvent, QEventLoop, Qt, QTimer
from qtpy.QtGui import QGuiApplication
from qtpy.QtWidgets import QApplication, QPushButton, QWidget

from lutcore.errors import MeshError, ParameterError
from tests.app.gui.conftest import settled


class BrokenError(RuntimeError):
    """What the tests raise."""


def fail(*_) -> None:
    raise BrokenError("on purpose")


@pytest.fixture
def guarded(window, capsys):
    before = sys.excepthook, threading.excepthook, sys.unraisablehook
    window.faults.install()
    yield window
    window.faults.remove()
    assert (sys.excepthook, threading.excepthook, sys.unraisablehook) == before


def told(qtbot, window) -> str:
    qtbot.waitUntil(window.banner.isVisible)
    assert "fault in the program: BrokenError: on purpose. " in window.banner.label.text()
    assert "save the session" in window.banner.label.text()
    assert any("BrokenError: on purpose" in line for line in window.journal.lines)
    qtbot.mouseClick(window.banner.details, Qt.MouseButton.LeftButton)
    return QGuiApplication.clipboard().text()


def by_signal(window, qtbot) -> None:
    window.controller.document.changed.connect(fail)
    qtbot.keyClick(window, Qt.Key.Key_F3)


def by_click(window, qtbot) -> None:
    button = QPushButton("Break", window.centralWidget())
    button.clicked.connect(fail)
    button.show()
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def by_event(window, qtbot) -> None:
    class Widget(QWidget):
        def customEvent(self, event: QEvent) -> None:  # noqa: N802
            fail()

    widget = Widget(window.centralWidget())
    widget.resize(20, 20)
    widget.show()
    # Not by `qtbot`: what is raised below its functions is raised out of them.
    loop = QEventLoop()
    QTimer.singleShot(200, loop.quit)
    QApplication.postEvent(widget, QEvent(QEvent.Type.User))
    loop.exec()


def by_timer(window, qtbot) -> None:
    QTimer.singleShot(0, fail)


def by_job(window, qtbot) -> None:
    window.controller.run("break", fail, lambda _: None)


def by_result(window, qtbot) -> None:
    window.controller.run("break", lambda _: 1, fail)


def by_thread(window, qtbot) -> None:
    threading.Thread(target=fail).start()


def by_worker_thread(window, qtbot) -> None:
    window.controller.aside._do = fail
    window.controller.aside.submit("break", lambda _: 1, lambda _: None, lambda _: None)


def by_destructor(window, qtbot) -> None:
    class Heavy:
        __del__ = fail

    Heavy()


def by_observer(window, qtbot) -> None:
    window.canvas.window_.AddObserver("StartEvent", fail)
    window.canvas.update()


WAYS = (
    by_signal, by_click, by_event, by_timer, by_job, by_result, by_thread, by_worker_thread,
    by_destructor, by_observer,
)  # fmt: skip


@pytest.mark.parametrize("way", WAYS)
def test_what_is_raised_is_told_with_its_details(guarded, qtbot, capsys, way) -> None:
    way(guarded, qtbot)
    details = told(qtbot, guarded)
    assert "Traceback" in details
    assert "in fail" in details
    assert "vtk " in details
    assert str(guarded.controller.session.mesh) not in details.split("Traceback")[0]
    guarded.controller.document.changed.disconnect(fail, missing_ok=True)
    guarded.banner.hide()
    qtbot.keyClick(guarded, Qt.Key.Key_F4)
    settled(qtbot, guarded)
    assert guarded.controller.outcome.session.view == "figure"


@pytest.mark.parametrize("error", [MeshError("bad.ply: broken"), ParameterError("too much")])
def test_what_a_person_can_mend_is_no_fault_of_the_program(guarded, qtbot, capsys, error) -> None:
    def refuse(*_) -> None:
        raise error

    guarded.controller.document.changed.connect(refuse)
    qtbot.keyClick(guarded, Qt.Key.Key_F3)
    qtbot.waitUntil(guarded.banner.isVisible)
    assert guarded.banner.label.text() == str(error)
    assert guarded.banner.details.isHidden()


def test_the_terminal_has_it_too(guarded, qtbot, capsys) -> None:
    by_click(guarded, qtbot)
    told(qtbot, guarded)
    assert "BrokenError: on purpose" in capsys.readouterr().err


def test_an_interrupt_is_no_fault(guarded, qtbot, capsys) -> None:
    sys.excepthook(KeyboardInterrupt, KeyboardInterrupt(), None)
    qtbot.wait(50)
    assert not guarded.banner.isVisible()


def test_an_offer_comes_back_after_a_message(window, qtbot) -> None:
    taken = []
    window.banner.offer("something was left", "Restore", lambda: taken.append(1))
    window.controller.failed.emit("bad.ply: broken")
    assert window.banner.label.text() == "bad.ply: broken"
    assert window.banner.button.isHidden()
    (close,) = [
        one for one in window.banner.children() if "Close" in getattr(one, "accessibleName", str)()
    ]
    qtbot.mouseClick(close, Qt.MouseButton.LeftButton)
    assert window.banner.label.text() == "something was left"
    qtbot.mouseClick(window.banner.button, Qt.MouseButton.LeftButton)
    assert taken == [1]
    assert not window.banner.isVisible()
