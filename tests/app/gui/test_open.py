"""Open a file in each of the ways there are, wait for it, or do not."""

import re
import threading
import time

import numpy as np
import pytest
from qtpy.QtCore import QMimeData, QPointF, Qt, QTimer, QUrl
from qtpy.QtGui import QDragEnterEvent, QDropEvent
from qtpy.QtWidgets import QApplication, QFileDialog, QLabel

from app.gui.open_menus import RECENT
from app.loading import load_mesh
from app.samples import sample
from app.session import Session, write
from sample_meshes.ply import write_ply
from tests.app.gui.conftest import pixels, settled
from tests.app.gui.hands import click_menu, click_tab, dismissed, named, tick
from tests.app.test_texture import glb
from tests.app.test_texture import obj as obj

LEFT, NONE = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
CONTROL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture
def meshes(tmp_path):
    """Two meshes in a folder, a.ply and b.ply."""
    for name, of in (("a", "saddle"), ("b", "torus")):
        mesh = load_mesh(sample(of).path).mesh
        write_ply(tmp_path / f"{name}.ply", mesh.vertices, mesh.faces)
    return tmp_path


def mesh_shown(window) -> int:
    return len(window.controller.outcome.subject.mesh.vertices)


def test_the_dialog_opens_a_mesh(window, qtbot, meshes) -> None:
    before = pixels(window)
    with named(meshes / "a.ply"):
        qtbot.keyClick(window, Qt.Key.Key_O, CONTROL)
    settled(qtbot, window)
    assert window.controller.session.mesh == str(meshes / "a.ply")
    assert mesh_shown(window) == len(load_mesh(meshes / "a.ply").mesh.vertices)
    assert (pixels(window) != before).any()
    # A dialog that is dismissed changes nothing.
    with dismissed(QFileDialog):
        click_menu(qtbot, window, "File", "Open")
    settled(qtbot, window)
    assert window.controller.session.mesh == str(meshes / "a.ply")


def test_a_recent_file_and_a_sample_are_opened_from_the_menu(window, qtbot) -> None:
    click_menu(qtbot, window, "File", "Sample meshes", "saddle")
    settled(qtbot, window)
    assert window.controller.session.mesh == "sample:saddle"
    assert mesh_shown(window) == len(load_mesh(sample("saddle").path).mesh.vertices)
    click_menu(qtbot, window, "File", "Open recent", "sample:sphere")
    settled(qtbot, window)
    assert window.controller.session.mesh == "sample:sphere"
    click_menu(qtbot, window, "File", "Open recent")
    listed = [one.text() for one in window.menus[RECENT].actions()]
    assert listed == ["sample:sphere", "sample:saddle"]
    for menu in (RECENT, "File"):
        qtbot.keyClick(window.menus[menu], Qt.Key.Key_Escape)


def _drop(qtbot, window, file) -> None:
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(file))])
    copy = Qt.DropAction.CopyAction
    enter = QDragEnterEvent(window.rect().center(), copy, data, LEFT, NONE)
    QApplication.sendEvent(window, enter)
    assert enter.isAccepted()
    QApplication.sendEvent(window, QDropEvent(QPointF(300, 300), copy, data, LEFT, NONE))
    settled(qtbot, window)


def test_a_mesh_is_dropped_on_the_window(window, qtbot, meshes) -> None:
    _drop(qtbot, window, meshes / "b.ply")
    assert window.controller.session.mesh == str(meshes / "b.ply")
    assert mesh_shown(window) == len(load_mesh(meshes / "b.ply").mesh.vertices)


def test_a_session_that_is_dropped_opens(window, qtbot, tmp_path) -> None:
    file = tmp_path / "kept.json"
    write(Session(mesh="sample:saddle", view="curvature"), file)
    _drop(qtbot, window, file)
    assert window.controller.session.mesh == "sample:saddle"
    assert window.controller.document.path == file
    assert window.controller.outcome.session.view == "curvature"


def test_a_broken_file_gives_a_message_and_the_old_picture_stays(window, qtbot, tmp_path) -> None:
    before, session = pixels(window), window.controller.session
    bad = tmp_path / "bad.ply"
    bad.write_bytes(b"ply\nformat ascii 1.0\nelement vertex 9\n")
    _drop(qtbot, window, bad)
    assert window.banner.isVisible()
    assert "bad.ply" in window.banner.label.text()
    assert window.controller.session == session
    qtbot.mouseClick(window.banner.close_, LEFT)
    assert not window.banner.isVisible()
    qtbot.wait(50)
    settled(qtbot, window)
    np.testing.assert_array_equal(pixels(window), before)


def test_arrows_go_through_the_folder_and_round(open_window, qtbot, meshes) -> None:
    (meshes / "c.txt").write_text("no mesh")
    window = open_window(Session(mesh=str(meshes / "a.ply")))
    for key, name in ((Qt.Key.Key_Right, "b"), (Qt.Key.Key_Left, "a")):
        qtbot.keyClick(window.canvas, key)
        settled(qtbot, window)
        assert window.controller.session.mesh == str(meshes / f"{name}.ply")
        assert window.windowTitle().startswith(f"{name}.ply")


def test_long_work_shows_its_time_leaves_the_window_free_and_is_cancelled_by_a_click(
    window, qtbot
) -> None:
    before, session = pixels(window), window.controller.session
    beats: list[float] = []
    timer = QTimer(window)
    timer.timeout.connect(lambda: beats.append(time.perf_counter()))
    timer.start(20)

    heard = threading.Event()

    def long(progress) -> None:
        start = time.monotonic()
        while time.monotonic() - start < 60.0:
            time.sleep(0.005)
            # Silent at first, as a step is that cannot say how far it is.
            if heard.is_set() and not progress(0.4, "thinking"):
                from lutcore.errors import CancelledError

                raise CancelledError

    done = []
    window.controller.run("long", long, done.append)
    bar = window.progress

    def seconds(step: str) -> float:
        said = re.fullmatch(rf"{step}, (\d+\.\d) s", bar.label.text())
        return float(said[1]) if said else -1.0

    qtbot.waitUntil(bar.isVisible)
    begun = seconds("computing")
    assert begun > 0.0
    qtbot.waitUntil(lambda: seconds("computing") > begun)  # it goes on though nothing is said
    silent = seconds("computing")
    heard.set()
    qtbot.waitUntil(lambda: seconds("thinking") >= silent)
    qtbot.waitUntil(lambda: seconds("thinking") > silent)
    assert bar.bar.value() == 40
    np.testing.assert_array_equal(pixels(window), before)
    qtbot.mouseClick(bar.button, LEFT)
    qtbot.waitUntil(lambda: not window.controller.worker.busy)
    qtbot.waitUntil(lambda: not bar.isVisible())
    assert done == []
    assert window.controller.session == session
    # The window's own thread went on all the time: the limit is that of a freeze.
    assert np.diff(beats).max() < 1.0
    assert len(beats) > 20


def test_the_old_picture_stays_until_the_new_one_is_there(open_window, qtbot, meshes) -> None:
    window = open_window(Session(mesh=str(meshes / "a.ply")))
    shown = pixels(window)
    fresh = []
    window.controller.shown.connect(lambda _: fresh.append(1))
    qtbot.keyClick(window.canvas, Qt.Key.Key_Right)
    while not fresh:
        np.testing.assert_array_equal(pixels(window), shown)
        qtbot.wait(5)
    settled(qtbot, window)
    assert (pixels(window) != shown).any()


def _colors(image: np.ndarray) -> set[str]:
    """Which of the texture's four colours are clearly there."""
    red, green, blue = (image[..., channel].astype(int) for channel in range(3))
    strong = {
        "red": (red > 2 * green) & (red > 2 * blue) & (red > 60),
        "green": (green > 2 * red) & (green > 2 * blue) & (green > 60),
        "blue": (blue > 2 * red) & (blue > 2 * green) & (blue > 60),
    }
    return {name for name, where in strong.items() if where.sum() > 500}


@pytest.mark.parametrize("kind", ["obj", "glb"])
def test_a_texture_is_seen_and_can_be_left_out(open_window, qtbot, tmp_path, obj, kind) -> None:
    path = obj() if kind == "obj" else glb(tmp_path)
    # Marble is white enough to see the picture's colours in its light.
    session = Session(mesh=str(path), material="marble", camera="front")
    window = open_window(session)
    assert _colors(pixels(window)) == {"red", "green", "blue"}
    panel = window.docks["shading"].fill()
    click_tab(qtbot, window, "Shading")
    assert panel.albedo.isEnabled()
    tick(qtbot, panel.albedo)
    settled(qtbot, window)
    assert not window.controller.session.albedo
    assert _colors(pixels(window)) == set()


def test_the_sheet_of_keys_opens_by_its_key(window, qtbot) -> None:
    qtbot.keyClick(window.canvas, Qt.Key.Key_H)
    sheet = QApplication.activeModalWidget()
    assert sheet is not None
    text = sheet.findChild(QLabel).text()
    for action in window.actions_:
        if action.shortcut:
            assert action.doc in text
    qtbot.keyClick(sheet, Qt.Key.Key_Escape)
    assert not sheet.isVisible()


def test_undo_and_redo_by_keys_show_the_picture_again(window, qtbot) -> None:
    first = pixels(window)
    qtbot.keyClick(window, Qt.Key.Key_F3)
    settled(qtbot, window)
    second = pixels(window)
    qtbot.keyClick(window, Qt.Key.Key_Z, CONTROL)
    settled(qtbot, window)
    np.testing.assert_array_equal(pixels(window), first)
    qtbot.keyClick(window, Qt.Key.Key_Z, CONTROL | Qt.KeyboardModifier.ShiftModifier)
    settled(qtbot, window)
    np.testing.assert_array_equal(pixels(window), second)
    assert window.controller.document.redo_label is None
