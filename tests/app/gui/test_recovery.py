"""Kill it at any moment: the next start offers the session, and no file is half written."""

import signal
import subprocess
import sys
import time

import msgspec
import numpy as np
import pytest
from qtpy.QtCore import Qt

from app.gui.recovery import Kept, Recovery
from app.loading import load_mesh
from app.samples import sample
from app.session import Session, read
from sample_meshes.ply import write_ply
from tests.app.gui.conftest import settled
from tests.app.gui.hands import click_menu, named, undo

# Longer than any of the tests' waits.
_NEVER = 1e9
_CHILD = """
import sys
from pathlib import Path
from msgspec.structs import replace
from app.gui.recovery import Recovery
from app.session import Session, read
recovery = Recovery(Path(sys.argv[1]), print, delay=0.0)
session = Session(mesh=sys.argv[2])
print("ready", flush=True)
step = 0
while True:
    step += 1
    recovery.keep(replace(session, exposure=1.0 + 0.001 * step), None)
"""


def _killed(folder, seconds: float, mesh: str = "sample:sphere") -> None:
    """Run a process that keeps sessions without a pause, and kill it in the midst."""
    command = [sys.executable, "-c", _CHILD, str(folder), mesh]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as child:
        assert child.stdout.readline() == b"ready\n"
        while not list(folder.glob(f"{child.pid}-*.json")):
            time.sleep(0.01)
        time.sleep(seconds)
        child.send_signal(signal.SIGKILL)


def test_what_is_killed_is_offered_whole(config) -> None:
    random, folder, told = np.random.default_rng(4), config / "unfinished", []
    for kill in range(4):
        _killed(folder, 0.2 * random.random())
        found = Recovery(folder, told.append).find()
        assert len(found) == kill + 1
        assert all(one.kept.session.exposure > 1.0 for one in found)
        assert not told
        for one in found:
            one.lock.close()


def test_a_living_windows_session_is_nobody_elses(config) -> None:
    mine, told = Recovery(config, print, delay=0.0), []
    mine.keep(Session(exposure=2.0), None)
    while not mine.file.exists():
        time.sleep(0.01)
    assert Recovery(config, told.append).find() == []
    mine.close()
    assert list(config.iterdir()) == []
    assert not told


def test_what_is_forgotten_is_not_written_after_all(config) -> None:
    mine = Recovery(config, print, delay=_NEVER)
    mine.keep(Session(exposure=2.0), None)
    mine.forget()
    mine.close()
    assert not list(config.glob("*.json"))


def test_the_next_window_offers_it_and_a_click_restores_it(open_window, qtbot, config) -> None:
    folder = config / "unfinished"
    _killed(folder, 0.0, "sample:saddle")
    (folder / "1-half.json").write_bytes(b'{"mesh": ')
    window = open_window(Session(mesh="sample:sphere"))
    said = []
    window.controller.noted.connect(said.append)
    window.rescue.offer()
    qtbot.waitUntil(lambda: any("1-half.json" in one for one in said))
    window.controller.loaded.emit(window.controller.outcome.subject)
    assert window.banner.isVisible(), "the first mesh to come must not take the offer away"
    assert "sample:saddle" in window.banner.label.text()
    qtbot.mouseClick(window.banner.button, Qt.MouseButton.LeftButton)
    settled(qtbot, window)
    assert window.controller.session.exposure > 1.0
    assert window.controller.session.mesh == "sample:saddle"
    assert window.controller.document.dirty
    kept = msgspec.json.decode(window.rescue.recovery.file.read_bytes(), type=Kept)
    assert kept.session.mesh == "sample:saddle"
    window.close()
    # What the kill left of a file that was being written goes away after a minute.
    assert [one.stem for one in folder.glob("[!.]*.json")] == ["1-half"]


def _kept(window, qtbot) -> bool:
    """Whether a crash now would be followed by an offer."""
    recovery = window.rescue.recovery
    qtbot.waitUntil(lambda: not recovery.busy)  # changes are gathered, and a disk may be slow
    return recovery.file.exists()


@pytest.fixture
def folder_of_meshes(tmp_path):
    """Three meshes, the last of an odd size, so that its unit is asked."""
    mesh = load_mesh(sample("saddle").path).mesh
    for name, factor in (("a", 1.0), ("b", 1.0), ("c", 1e-5)):
        write_ply(tmp_path / f"{name}.ply", factor * mesh.vertices, mesh.faces)
    return tmp_path


def test_what_was_only_opened_is_not_offered(open_window, qtbot, folder_of_meshes) -> None:
    window = open_window(Session(mesh=str(folder_of_meshes / "a.ply")))
    qtbot.keyClick(window.canvas, Qt.Key.Key_Right)
    settled(qtbot, window)
    assert window.controller.session.mesh.endswith("b.ply")
    assert not _kept(window, qtbot)
    qtbot.keyClick(window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    settled(qtbot, window)
    assert window.controller.session.mesh.endswith("a.ply")
    assert not _kept(window, qtbot)
    assert not window.isWindowModified()
    # A change is worth it, and no more so once it is taken back.
    qtbot.keyClick(window, Qt.Key.Key_F3)
    settled(qtbot, window)
    assert _kept(window, qtbot)
    undo(qtbot, window)
    settled(qtbot, window)
    assert not _kept(window, qtbot)


def test_a_unit_that_is_remembered_is_no_loss(open_window, qtbot, folder_of_meshes) -> None:
    window = open_window(Session(mesh=str(folder_of_meshes / "a.ply")))
    for _ in range(2):
        qtbot.keyClick(window.canvas, Qt.Key.Key_Right)
        settled(qtbot, window)
    assert window.controller.session.mesh.endswith("c.ply")
    qtbot.waitUntil(window.unit_bar.isVisible)
    qtbot.mouseClick(window.unit_bar.buttons["m"], Qt.MouseButton.LeftButton)
    settled(qtbot, window)
    assert window.controller.session.mm_per_unit == 1000.0
    assert not _kept(window, qtbot)
    for key in (Qt.Key.Key_Right, Qt.Key.Key_Left):  # round to the first, and back
        qtbot.keyClick(window.canvas, key)
        settled(qtbot, window)
    assert window.controller.session.mm_per_unit == 1000.0
    assert not _kept(window, qtbot)


def test_a_mesh_opened_over_a_session_file_is_not_saved_into_it(
    open_window, qtbot, folder_of_meshes
) -> None:
    window = open_window(Session(mesh=str(folder_of_meshes / "a.ply")))
    path = folder_of_meshes / "mine.json"
    click_menu(qtbot, window, "Curvature", "Flip colours")
    with named(path):
        qtbot.keyClick(window, Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    qtbot.keyClick(window.canvas, Qt.Key.Key_Right)
    settled(qtbot, window)
    assert window.controller.document.path is None
    assert "b.ply" in window.windowTitle()
    assert window.controller.session.flip
    assert not _kept(window, qtbot)


_USED = """
import sys
from pathlib import Path
from qtpy.QtCore import QTimer
from qtpy.QtWidgets import QApplication
application = QApplication([])
from app.gui.window import Window
from app.session import Session, read
window = Window(Session(mesh="sample:saddle"))
window.show()
window.start()
step = 0
def use():
    global step
    step += 1
    window.controller.change(f"exposure {step}", exposure=1.0 + 0.01 * step)
    if step == 3:
        window.controller.save(Path(sys.argv[1]) / "saved.json")
    if window.rescue.recovery.file.exists() and step > 3:
        print("used", flush=True)
timer = QTimer()
timer.timeout.connect(use)
timer.start(40)
application.exec()
"""


def test_a_window_that_is_killed_while_it_is_used_is_offered_whole(
    open_window, qtbot, config, tmp_path
) -> None:
    random = np.random.default_rng(11)
    for _ in range(3):
        command = [sys.executable, "-c", _USED, str(tmp_path)]
        with subprocess.Popen(command, stdout=subprocess.PIPE) as child:
            assert child.stdout.readline() == b"used\n"
            time.sleep(float(random.uniform(0.0, 1.5)))
            child.send_signal(signal.SIGKILL)
        # Whole or not there; what was half written has a name that nobody reads.
        for file in (*tmp_path.glob("[!.]*.json"), *config.glob("[!.]*.json")):
            msgspec.json.decode(file.read_bytes())
        read(tmp_path / "saved.json")
    window = open_window(Session(mesh="sample:sphere"))
    window.rescue.offer()
    assert window.banner.offering
    assert "sample:saddle" in window.banner.label.text()
    qtbot.mouseClick(window.banner.button, Qt.MouseButton.LeftButton)
    settled(qtbot, window)
    assert window.controller.session.mesh == "sample:saddle"
    assert window.controller.session.exposure > 1.0
