"""Open, look, turn: what a person does first."""

import numpy as np
import pytest
from qtpy.QtCore import QPoint, Qt

from app.camera import axes
from app.gui.coarse import coarse
from app.render import grab
from app.session import Camera, Session
from tests.app.gui.conftest import pixels, settled
from tests.app.gui.mouse import move


def _drag(qtbot, widget, start: tuple[int, int], end: tuple[int, int], button) -> None:
    qtbot.mousePress(widget, button, pos=QPoint(*start))
    for share in (0.5, 1.0):
        at = [round(a + share * (b - a)) for a, b in zip(start, end, strict=True)]
        move(qtbot, widget, QPoint(*at))
        qtbot.wait(5)
    qtbot.mouseRelease(widget, button, pos=QPoint(*end))


def test_the_first_picture_shows_the_mesh(window) -> None:
    shown = pixels(window)
    background = shown[2, 2]
    assert (shown != background).any(axis=2).mean() > 0.1


def test_a_drag_turns_the_mesh_and_is_no_step_of_the_history(window, qtbot) -> None:
    before = window.canvas.camera
    _drag(qtbot, window.canvas, (300, 300), (400, 300), Qt.MouseButton.LeftButton)
    settled(qtbot, window)
    after = window.controller.session.camera
    assert isinstance(after, Camera)
    # Dragged to the right, the mesh turns its left side to the viewer: the camera goes left.
    assert np.dot(np.subtract(after.position, before.position), axes(before)[0]) < 0.0
    assert after.target == before.target
    assert window.controller.document.undo_label is None


def test_a_right_drag_moves_the_picture_with_the_mouse(window, qtbot) -> None:
    canvas = window.canvas
    rows, columns = np.nonzero((pixels(window) != pixels(window)[2, 2]).any(axis=2))
    _drag(qtbot, canvas, (300, 300), (340, 320), Qt.MouseButton.RightButton)
    settled(qtbot, window)
    shown = pixels(window)
    # Without the caption below, which stays.
    rows_after, columns_after = np.nonzero((shown[:-60] != shown[2, 2]).any(axis=2))
    assert columns_after.mean() - columns.mean() == pytest.approx(40, abs=4)
    assert rows_after.min() - rows.min() == pytest.approx(20, abs=3)


def test_keys_undo_and_views(window, qtbot) -> None:
    qtbot.keyClick(window, Qt.Key.Key_F3)
    settled(qtbot, window)
    assert window.controller.session.view == "curvature"
    assert window.controller.outcome.session.view == "curvature"
    qtbot.keyClick(window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    settled(qtbot, window)
    assert window.controller.outcome.session.view == "shade"
    qtbot.keyClick(window, Qt.Key.Key_7)
    settled(qtbot, window)
    assert axes(window.canvas.camera)[2] == pytest.approx([0.0, 1.0, 0.0])


def test_the_window_remembers_what_was_opened(open_window) -> None:
    window = open_window(Session(mesh="sample:sphere"))
    assert window.settings.recent[0] == "sample:sphere"


def test_a_slow_renderer_draws_coarsely_in_a_drag_and_refines_after_it(window, qtbot) -> None:
    canvas = window.canvas
    canvas.give_coarse(coarse(window.controller.outcome.subject.mesh, 500))
    start, rough = pixels(window), []

    def note(_) -> None:
        if canvas.coarsely:
            rough.append(grab(canvas.window_, tuple(canvas.window_.GetSize())))
        else:
            canvas._frame = 1.0  # as if it had taken so long

    canvas.drew.connect(note)
    canvas.repaint()
    qtbot.mousePress(canvas, Qt.MouseButton.LeftButton, pos=QPoint(300, 300))
    move(qtbot, canvas, QPoint(340, 300))
    # It may be fine again before anybody looks.
    qtbot.waitUntil(lambda: len(rough) > 0)
    qtbot.mouseRelease(canvas, Qt.MouseButton.LeftButton, pos=QPoint(340, 300))
    qtbot.waitUntil(lambda: not canvas.coarsely)
    settled(qtbot, window)
    fine = pixels(window)
    assert (fine != start).any() and (fine != rough[-1]).any()


def test_a_software_renderer_takes_no_samples(window) -> None:
    pixels(window)
    assert window.canvas.backend.software
    assert window.canvas.window_.GetMultiSamples() == 0
