"""Save, copy, leave: what goes out of the window, and what is asked before."""

import runpy
import shlex
from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace
from qtpy.QtCore import QEvent, Qt
from qtpy.QtGui import QCloseEvent, QGuiApplication, QImage
from qtpy.QtWidgets import QColorDialog, QDialogButtonBox, QFileDialog, QMessageBox

from app import session as state
from app.cli.main import main
from app.gui.outputs import save_screenshot
from app.gui.picture_dialog import PictureDialog
from app.gui.saving import save_data
from app.picture import render
from app.pipeline import Pipeline
from app.provenance import read_pixels
from app.session import Camera, Method, Session
from app.transparency import checks
from tests.app.gui.conftest import pixels, settled
from tests.app.gui.hands import (
    LEFT,
    answered,
    click_menu,
    colored,
    dismissed,
    named,
    pressed,
    tick,
    undo,
)

Button = QMessageBox.StandardButton


@pytest.fixture
def small(open_window):
    return open_window(Session(mesh="sample:sphere", size=(200, 160)), size=(600, 420))


CONTROL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier


def _flip(qtbot, window) -> None:
    click_menu(qtbot, window, "Curvature", "Flip colours")
    settled(qtbot, window)


def test_a_session_is_saved_under_its_name_and_opens_again(small, qtbot, tmp_path) -> None:
    controller = small.controller
    qtbot.keyClick(small, Qt.Key.Key_F3)
    path = tmp_path / "mine.json"
    with named(tmp_path / "mine"):
        qtbot.keyClick(small, Qt.Key.Key_S, CONTROL)
    assert state.read(path) == controller.session
    assert not controller.document.dirty
    assert small.windowTitle().startswith("mine.json")
    _flip(qtbot, small)
    assert controller.document.dirty
    qtbot.keyClick(small, Qt.Key.Key_S, CONTROL)  # it is not asked again
    assert state.read(path).flip
    other = tmp_path / "other.json"
    with named(other):
        qtbot.keyClick(small, Qt.Key.Key_S, CONTROL | SHIFT)
    assert state.read(other) == state.read(path)
    _flip(qtbot, small)
    # A session takes the place of what was done, so that is asked about first.
    with pressed(Button.Discard), named(path):
        qtbot.keyClick(small, Qt.Key.Key_O, CONTROL)
    settled(qtbot, small)
    assert controller.session.flip
    assert not controller.document.dirty


def test_a_session_that_cannot_be_written_is_told_and_stays_unsaved(small, qtbot, tmp_path) -> None:
    _flip(qtbot, small)
    # No dialog leads there; but a folder may be gone by the time it is written.
    assert not small.controller.save(tmp_path / "missing" / "mine.json")
    assert "missing" in small.banner.label.text()
    assert small.controller.document.dirty


@pytest.mark.parametrize(
    ("answer", "goes", "saved"),
    [("Save", True, True), ("Discard", True, False), ("Cancel", False, False)],
)
def test_unsaved_changes_are_asked_about(small, qtbot, tmp_path, answer, goes, saved) -> None:
    path = tmp_path / "mine.json"
    with named(path):
        qtbot.keyClick(small, Qt.Key.Key_S, CONTROL)
    _flip(qtbot, small)
    with pressed(Button[answer]):
        qtbot.keyClick(small, Qt.Key.Key_Q, CONTROL)
    assert small.isVisible() is not goes
    assert state.read(path).flip is saved


def test_nothing_is_asked_where_nothing_is_lost(small, qtbot, tmp_path) -> None:
    with named(tmp_path / "mine.json"):
        qtbot.keyClick(small, Qt.Key.Key_S, CONTROL)
    qtbot.keyClick(small, Qt.Key.Key_Q, CONTROL)
    assert not small.isVisible()


def test_saving_that_was_given_up_keeps_the_window(small, qtbot) -> None:
    _flip(qtbot, small)
    with pressed(Button.Save), dismissed(QFileDialog):
        qtbot.keyClick(small, Qt.Key.Key_Q, CONTROL)
    assert small.isVisible()


class _ByPerson(QCloseEvent):
    """What the screen sends when a person closes a window."""

    def spontaneous(self) -> bool:
        return True


def test_a_person_who_cancels_keeps_the_window(small, qtbot) -> None:
    _flip(qtbot, small)
    event = _ByPerson()
    with pressed(Button.Cancel):
        small.closeEvent(event)
    assert event.type() == QEvent.Type.Close
    assert not event.isAccepted()
    assert small.isVisible()


def test_a_mesh_that_was_only_looked_at_needs_no_saving(small, qtbot) -> None:
    click_menu(qtbot, small, "File", "Sample meshes", "saddle")
    settled(qtbot, small)
    assert small.controller.session.mesh == "sample:saddle"
    assert not small.controller.document.dirty
    _flip(qtbot, small)
    click_menu(qtbot, small, "File", "Sample meshes", "torus")
    settled(qtbot, small)
    assert small.controller.document.dirty


def test_a_size_is_typed_and_the_picture_written(small, qtbot, tmp_path) -> None:
    picture, session = tmp_path / "mine.png", tmp_path / "mine.json"

    def sized(dialog) -> None:
        for box, number in ((dialog.width_box, "150"), (dialog.height_box, "120")):
            box.setFocus()
            box.selectAll()
            qtbot.keyClicks(box, number)
        qtbot.mouseClick(dialog.buttons.button(QDialogButtonBox.StandardButton.Ok), LEFT)

    with answered(PictureDialog, sized), named(tmp_path / "mine"):
        click_menu(qtbot, small, "File", "Save picture")
    settled(qtbot, small)
    assert small.controller.session.size == (150, 120)
    with named(session):
        qtbot.keyClick(small, Qt.Key.Key_S, CONTROL)
    other = tmp_path / "other.png"
    assert main(["shade", "--session", str(session), "-o", str(other), "--quiet"]) == 0
    assert picture.read_bytes() == other.read_bytes()


def test_the_size_of_the_view_is_one_click_away(small, qtbot) -> None:
    dialog = PictureDialog(small, (200, 160), (641, 480), False)
    qtbot.addWidget(dialog)
    assert dialog.chosen == (200, 160)
    qtbot.mouseClick(dialog.twice, Qt.MouseButton.LeftButton)
    assert dialog.chosen == (1282, 960)


def test_the_copied_picture_is_the_session_in_the_size_of_the_view(small, qtbot) -> None:
    qtbot.keyClick(small, Qt.Key.Key_C, CONTROL | SHIFT)
    settled(qtbot, small)
    image = QGuiApplication.clipboard().image().convertToFormat(QImage.Format.Format_RGB888)
    size = tuple(small.canvas.window_.GetSize())
    assert (image.width(), image.height()) == size
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(size[1], image.bytesPerLine())
    copied = rows[:, : 3 * size[0]].reshape(size[1], size[0], 3)
    session = replace(small.controller.session, size=size)
    np.testing.assert_array_equal(copied, render(session, Pipeline()).image)


def test_a_transparent_picture_is_asked_for_by_hand_and_is_the_command_lines(
    small, qtbot, tmp_path
) -> None:
    picture, session, other = (tmp_path / one for one in ("mine.png", "mine.json", "other.png"))

    def clear(dialog) -> None:
        tick(qtbot, dialog.clear)
        qtbot.keyClick(dialog, Qt.Key.Key_Return)

    with answered(PictureDialog, clear), named(picture):
        qtbot.keyClick(small, Qt.Key.Key_E, CONTROL)
    settled(qtbot, small)
    assert read_pixels(picture).shape[2] == 4
    with named(session):
        qtbot.keyClick(small, Qt.Key.Key_S, CONTROL)
    assert main(["draw", "--session", str(session), "-o", str(other), "--quiet"]) == 0
    assert picture.read_bytes() == other.read_bytes()
    # The view shows checks where nothing is, and undo brings the colour back.
    before = pixels(small)
    np.testing.assert_array_equal(np.unique(before[:20, :20]), np.unique(checks(1, 30)))
    undo(qtbot, small)
    settled(qtbot, small)
    assert pixels(small)[2, 2].tolist() == [0x20, 0x24, 0x2A]


def test_the_copied_picture_keeps_its_transparency(small, qtbot) -> None:
    click_menu(qtbot, small, "View", "Transparent background")
    settled(qtbot, small)
    qtbot.keyClick(small, Qt.Key.Key_C, CONTROL | SHIFT)
    settled(qtbot, small)
    image = QGuiApplication.clipboard().image().convertToFormat(QImage.Format.Format_RGBA8888)
    size = tuple(small.canvas.window_.GetSize())
    copied = np.frombuffer(image.constBits(), np.uint8).reshape(size[1], size[0], 4)
    session = replace(small.controller.session, size=size)
    assert session.background == "transparent"
    np.testing.assert_array_equal(copied, render(session, Pipeline()).image)
    click_menu(qtbot, small, "View", "Transparent background")
    assert small.controller.session.background == Session().background


def test_a_background_colour_is_chosen_and_comes_back_after_transparency(small, qtbot) -> None:
    with colored("#446688"):
        click_menu(qtbot, small, "View", "Background colour")
    settled(qtbot, small)
    assert pixels(small)[2, 2].tolist() == [0x44, 0x66, 0x88]
    for _ in range(2):
        click_menu(qtbot, small, "View", "Transparent background")
    assert small.controller.session.background == "#446688"
    with dismissed(QColorDialog):
        click_menu(qtbot, small, "View", "Background colour")
    assert small.controller.session.background == "#446688"


def test_the_next_frame_after_a_picture_is_whole(small, qtbot, tmp_path) -> None:
    before = pixels(small)
    with colored("#446688"):
        click_menu(qtbot, small, "View", "Background colour")
    qtbot.keyClick(small, Qt.Key.Key_C, CONTROL | SHIFT)
    settled(qtbot, small)
    after = pixels(small)
    assert after[2, 2].tolist() == [0x44, 0x66, 0x88]
    mesh = (before != np.uint8((0x20, 0x24, 0x2A))).any(axis=2)
    np.testing.assert_array_equal(after[mesh][:1000], before[mesh][:1000])


def test_a_screenshot_is_what_the_view_shows(small, qtbot, tmp_path) -> None:
    path = tmp_path / "view.png"
    with named(path):
        qtbot.keyClick(small, Qt.Key.Key_F12)
    np.testing.assert_array_equal(read_pixels(path), pixels(small))
    save_screenshot(small, tmp_path / "missing" / "view.png")
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
    qtbot.keyClick(small, Qt.Key.Key_F2 if kind == "curvature" else Qt.Key.Key_F3)
    with named(mine):
        click_menu(qtbot, small, "File", f"Save {kind} data")
    settled(qtbot, small)
    session = tmp_path / "mine.json"
    with named(session):
        qtbot.keyClick(small, Qt.Key.Key_S, CONTROL)
    assert main([command, "--session", str(session), "-o", str(theirs), "--quiet"]) == 0
    assert mine.read_bytes() == theirs.read_bytes()


def test_data_of_another_format_and_over_the_mesh_are_refused(small, qtbot, tmp_path) -> None:
    with named(tmp_path / "mine.xyz"):
        click_menu(qtbot, small, "File", "Save curvature data")
    settled(qtbot, small)
    assert ".csv" in small.banner.label.text()
    mesh = tmp_path / "mesh.ply"
    with named(mesh):
        click_menu(qtbot, small, "File", "Save curvature data")
    settled(qtbot, small)
    before = mesh.read_bytes()
    with named(mesh):
        qtbot.keyClick(small, Qt.Key.Key_O, CONTROL)
    settled(qtbot, small)
    save_data(small.controller, mesh, "curvature")  # after the dialog's own question
    settled(qtbot, small)
    assert "the mesh itself" in small.banner.label.text()
    assert mesh.read_bytes() == before


def test_what_is_copied_draws_the_picture(small, qtbot, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    qtbot.keyClick(small, Qt.Key.Key_F4)
    _flip(qtbot, small)
    click_menu(qtbot, small, "File", "Copy as command line")
    words = shlex.split(QGuiApplication.clipboard().text())
    assert words[:3] == ["curvelight", "figure", "sample:sphere"]
    assert main([*words[1:], "--quiet"]) == 0
    by_command = Path("sphere.png").read_bytes()
    click_menu(qtbot, small, "File", "Copy as Python script")
    Path("drawing.py").write_text(QGuiApplication.clipboard().text())
    Path("sphere.png").unlink()
    runpy.run_path("drawing.py")
    assert Path("sphere.png").read_bytes() == by_command


def test_what_flags_cannot_say_is_copied_with_its_file(small, qtbot, tmp_path) -> None:
    noted = []
    small.controller.noted.connect(noted.append)
    QGuiApplication.clipboard().setText("before")
    camera = Camera((0.0, 0.0, 90.0), (0.0, 0.0, 0.0), height=40.0)
    small.controller.look(camera)
    click_menu(qtbot, small, "File", "Copy as command line")
    assert QGuiApplication.clipboard().text() == "before"
    assert "save it" in noted[-1]
    path = tmp_path / "with space.json"
    with named(path):
        qtbot.keyClick(small, Qt.Key.Key_S, CONTROL)
    click_menu(qtbot, small, "File", "Copy as command line")
    words = shlex.split(QGuiApplication.clipboard().text())
    assert words[1:4] == ["shade", "--session", str(path)]
    # A camera that moved is no unsaved change, but another picture.
    qtbot.keyClick(small, Qt.Key.Key_1)
    small.controller.change("model", model=Method("lambert"), compared=(Method("wrap"),))
    click_menu(qtbot, small, "File", "Copy as command line")
    assert "save it" in noted[-1]
