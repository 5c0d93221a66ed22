"""Save, copy, leave: what goes out of the window, and what is asked before."""

import runpy
import shlex
from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace
from qtpy.QtCore import QEvent, QPoint, Qt, QTimer
from qtpy.QtGui import QCloseEvent, QColor, QGuiApplication, QImage
from qtpy.QtWidgets import QApplication, QColorDialog, QDialog, QFileDialog

from app import session as state
from app.cli.main import main
from app.gui.outputs import save_screenshot
from app.gui.picture_dialog import PictureDialog
from app.gui.saving import save_data
from app.gui.unsaved import Answer, may_leave
from app.picture import render
from app.pipeline import Pipeline
from app.provenance import read_pixels
from app.session import Camera, Method, Session
from app.transparency import checks
from tests.app.gui.conftest import pixels, settled


@pytest.fixture
def small(open_window):
    return open_window(Session(mesh="sample:sphere", size=(200, 160)), size=(600, 420))


@pytest.fixture
def named(monkeypatch, tmp_path):
    """Answer the next question for a file."""

    def answer(name: str) -> Path:
        path = tmp_path / name if name else Path()
        chosen = (str(path) if name else "", "")
        monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: chosen)
        return path

    return answer


def _act(window, name: str) -> None:
    window.act(window.actions_[name])


def test_a_session_is_saved_under_its_name_and_opens_again(small, qtbot, named) -> None:
    controller = small.controller
    controller.change("view", view="curvature")
    path = named("mine")
    qtbot.keyClick(small, Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    path = path.with_suffix(".json")
    assert state.read(path) == controller.session
    assert not controller.document.dirty
    assert small.windowTitle().startswith("mine.json")
    controller.change("flip", flip=True)
    assert controller.document.dirty
    named("")  # it is not asked again
    qtbot.keyClick(small, Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    assert state.read(path).flip
    other = named("other.json")
    keys = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
    qtbot.keyClick(small, Qt.Key.Key_S, keys)
    assert state.read(other) == state.read(path)
    controller.change("flip", flip=False)
    controller.open(path)
    settled(qtbot, small)
    assert controller.session.flip
    assert not controller.document.dirty


def test_a_session_that_cannot_be_written_is_told_and_stays_unsaved(small, tmp_path) -> None:
    small.controller.change("flip", flip=True)
    assert not small.controller.save(tmp_path / "missing" / "mine.json")
    assert "missing" in small.banner.label.text()
    assert small.controller.document.dirty


@pytest.mark.parametrize(
    ("answer", "goes", "saved"),
    [(Answer.SAVE, True, True), (Answer.DISCARD, True, False), (Answer.CANCEL, False, False)],
)
def test_unsaved_changes_are_asked_about(small, tmp_path, answer, goes, saved) -> None:
    path, asked = tmp_path / "mine.json", []
    small.ask_unsaved = lambda window: asked.append(window) or answer
    assert may_leave(small)
    assert small.controller.save(path)
    assert may_leave(small)
    assert not asked  # nothing to lose
    small.controller.change("flip", flip=True)
    assert may_leave(small) is goes
    assert asked == [small]
    assert state.read(path).flip is saved


def test_saving_that_was_given_up_keeps_the_window(small, named) -> None:
    named("")
    small.ask_unsaved = lambda _: Answer.SAVE
    small.controller.change("flip", flip=True)
    assert not may_leave(small)


class _ByPerson(QCloseEvent):
    """What the screen sends when a person closes a window."""

    def spontaneous(self) -> bool:
        return True


def test_a_person_who_cancels_keeps_the_window(small) -> None:
    small.ask_unsaved = lambda _: Answer.CANCEL
    small.controller.change("flip", flip=True)
    event = _ByPerson()
    small.closeEvent(event)
    assert event.type() == QEvent.Type.Close
    assert not event.isAccepted()
    _act(small, "file.quit")
    assert small.isVisible()
    small.ask_unsaved = lambda _: Answer.DISCARD
    _act(small, "file.quit")
    assert not small.isVisible()


def test_a_mesh_that_was_only_looked_at_needs_no_saving(small, qtbot) -> None:
    small.controller.open("sample:saddle")
    settled(qtbot, small)
    assert small.controller.session.mesh == "sample:saddle"
    assert not small.controller.document.dirty
    small.controller.change("flip", flip=True)
    small.controller.open("sample:torus")
    settled(qtbot, small)
    assert small.controller.document.dirty


def test_the_menu_asks_for_a_size_and_writes_the_picture(
    small, qtbot, named, tmp_path, monkeypatch
) -> None:
    def accept(dialog) -> int:
        dialog.width_box.setValue(150)
        dialog.height_box.setValue(120)
        return QDialog.DialogCode.Accepted

    monkeypatch.setattr(PictureDialog, "exec", accept)
    picture, session = named("mine"), tmp_path / "mine.json"
    _act(small, "file.save_picture")
    settled(qtbot, small)
    assert small.controller.session.size == (150, 120)
    assert small.controller.save(session)
    other = tmp_path / "other.png"
    assert main(["shade", "--session", str(session), "-o", str(other), "--quiet"]) == 0
    assert picture.with_suffix(".png").read_bytes() == other.read_bytes()


def test_the_size_of_the_view_is_one_click_away(small, qtbot) -> None:
    dialog = PictureDialog(small, (200, 160), (641, 480), False)
    qtbot.addWidget(dialog)
    assert dialog.chosen == (200, 160)
    qtbot.mouseClick(dialog.twice, Qt.MouseButton.LeftButton)
    assert dialog.chosen == (1282, 960)


def test_the_copied_picture_is_the_session_in_the_size_of_the_view(small, qtbot) -> None:
    _act(small, "file.copy_picture")
    settled(qtbot, small)
    image = QGuiApplication.clipboard().image().convertToFormat(QImage.Format.Format_RGB888)
    size = tuple(small.canvas.window_.GetSize())
    assert (image.width(), image.height()) == size
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(size[1], image.bytesPerLine())
    copied = rows[:, : 3 * size[0]].reshape(size[1], size[0], 3)
    session = replace(small.controller.session, size=size)
    np.testing.assert_array_equal(copied, render(session, Pipeline()).image)


def test_a_transparent_picture_is_asked_for_by_hand_and_is_the_command_lines(
    small, qtbot, named, tmp_path
) -> None:
    picture, session, other = named("mine"), tmp_path / "mine.json", tmp_path / "other.png"

    def answer() -> None:
        dialog = QApplication.activeModalWidget()
        assert isinstance(dialog, PictureDialog)
        box = dialog.clear
        qtbot.mouseClick(box, Qt.MouseButton.LeftButton, pos=QPoint(8, box.height() // 2))
        qtbot.keyClick(dialog, Qt.Key.Key_Return)

    QTimer.singleShot(200, answer)
    qtbot.keyClick(small, Qt.Key.Key_E, Qt.KeyboardModifier.ControlModifier)
    settled(qtbot, small)
    picture = picture.with_suffix(".png")
    assert read_pixels(picture).shape[2] == 4
    assert small.controller.save(session)
    assert main(["draw", "--session", str(session), "-o", str(other), "--quiet"]) == 0
    assert picture.read_bytes() == other.read_bytes()
    # The view shows checks where nothing is, and undo brings the colour back.
    before = pixels(small)
    np.testing.assert_array_equal(np.unique(before[:20, :20]), np.unique(checks(1, 30)))
    small.activateWindow()  # no window manager gives it the keyboard back
    qtbot.waitUntil(small.isActiveWindow)
    qtbot.keyClick(small, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    settled(qtbot, small)
    assert pixels(small)[2, 2].tolist() == [0x20, 0x24, 0x2A]


def test_the_copied_picture_keeps_its_transparency(small, qtbot) -> None:
    _act(small, "view.transparent")
    settled(qtbot, small)
    _act(small, "file.copy_picture")
    settled(qtbot, small)
    image = QGuiApplication.clipboard().image().convertToFormat(QImage.Format.Format_RGBA8888)
    size = tuple(small.canvas.window_.GetSize())
    copied = np.frombuffer(image.constBits(), np.uint8).reshape(size[1], size[0], 4)
    session = replace(small.controller.session, size=size)
    assert session.background == "transparent"
    np.testing.assert_array_equal(copied, render(session, Pipeline()).image)
    _act(small, "view.transparent")
    assert small.controller.session.background == Session().background


def test_a_background_colour_is_chosen_and_comes_back_after_transparency(
    small, qtbot, monkeypatch
) -> None:
    chosen = QColor("#446688")
    monkeypatch.setattr(QColorDialog, "getColor", lambda *_: chosen)
    _act(small, "view.background")
    settled(qtbot, small)
    assert pixels(small)[2, 2].tolist() == [0x44, 0x66, 0x88]
    for _ in range(2):
        _act(small, "view.transparent")
    assert small.controller.session.background == "#446688"
    chosen = QColor()  # the dialog was dismissed
    _act(small, "view.background")
    assert small.controller.session.background == "#446688"


def test_the_next_frame_after_a_picture_is_whole(small, qtbot, tmp_path) -> None:
    before = pixels(small)
    small.controller.change("background", background="#446688")
    _act(small, "file.copy_picture")
    settled(qtbot, small)
    after = pixels(small)
    assert after[2, 2].tolist() == [0x44, 0x66, 0x88]
    mesh = (before != np.uint8((0x20, 0x24, 0x2A))).any(axis=2)
    np.testing.assert_array_equal(after[mesh][:1000], before[mesh][:1000])


def test_a_screenshot_is_what_the_view_shows(small, named) -> None:
    path = named("view.png")
    _act(small, "file.screenshot")
    np.testing.assert_array_equal(read_pixels(path), pixels(small))
    save_screenshot(small, path.parent / "missing" / "view.png")
    assert "missing" in small.banner.label.text()


@pytest.mark.parametrize(
    ("kind", "command", "suffix"),
    [
        ("curvature", "curvature", ".csv"),
        ("curvature", "curvature", ".ply"),
        ("curvature", "curvature", ".npz"),
        ("shading", "shade", ".vtp"),
        ("shading", "shade", ".ply"),
    ],
)
def test_saved_data_are_those_of_the_command(small, qtbot, tmp_path, kind, command, suffix) -> None:
    mine, theirs = tmp_path / f"mine{suffix}", tmp_path / f"theirs{suffix}"
    # Whatever is shown: curvature is smoothed otherwise for shading than for measuring.
    small.controller.change("view", view="shade" if kind == "curvature" else "curvature")
    save_data(small.controller, mine, kind)
    settled(qtbot, small)
    session = tmp_path / "mine.json"
    assert small.controller.save(session)
    assert main([command, "--session", str(session), "-o", str(theirs), "--quiet"]) == 0
    assert mine.read_bytes() == theirs.read_bytes()


def test_data_of_another_format_and_over_the_mesh_are_refused(small, qtbot, tmp_path) -> None:
    save_data(small.controller, tmp_path / "mine.xyz", "curvature")
    settled(qtbot, small)
    assert ".csv" in small.banner.label.text()
    mesh = tmp_path / "mesh.ply"
    save_data(small.controller, mesh, "curvature")
    settled(qtbot, small)
    before = mesh.read_bytes()
    small.controller.open(mesh)
    settled(qtbot, small)
    save_data(small.controller, mesh, "curvature")
    settled(qtbot, small)
    assert "the mesh itself" in small.banner.label.text()
    assert mesh.read_bytes() == before


def test_what_is_copied_draws_the_picture(small, qtbot, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    small.controller.change("view", view="figure", flip=True)
    settled(qtbot, small)
    _act(small, "file.copy_command")
    words = shlex.split(QGuiApplication.clipboard().text())
    assert words[:3] == ["curvelight", "figure", "sample:sphere"]
    assert main([*words[1:], "--quiet"]) == 0
    by_command = Path("sphere.png").read_bytes()
    _act(small, "file.copy_script")
    Path("drawing.py").write_text(QGuiApplication.clipboard().text())
    Path("sphere.png").unlink()
    runpy.run_path("drawing.py")
    assert Path("sphere.png").read_bytes() == by_command


def test_what_flags_cannot_say_is_copied_with_its_file(small, tmp_path) -> None:
    noted = []
    small.controller.noted.connect(noted.append)
    QGuiApplication.clipboard().setText("before")
    camera = Camera((0.0, 0.0, 90.0), (0.0, 0.0, 0.0), height=40.0)
    small.controller.look(camera)
    _act(small, "file.copy_command")
    assert QGuiApplication.clipboard().text() == "before"
    assert "save it" in noted[-1]
    path = tmp_path / "with space.json"
    assert small.controller.save(path)
    _act(small, "file.copy_command")
    words = shlex.split(QGuiApplication.clipboard().text())
    assert words[1:4] == ["shade", "--session", str(path)]
    # A camera that moved is no unsaved change, but another picture.
    small.controller.look("front")
    small.controller.change("model", model=Method("lambert"), compared=(Method("wrap"),))
    _act(small, "file.copy_command")
    assert "save it" in noted[-1]
