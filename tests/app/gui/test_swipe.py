"""Swipe and flicker: which half shows what, and what a drag leaves behind."""

import numpy as np
import pytest
from qtpy.QtCore import QPoint, Qt

from app.scene import Surface
from app.session import Method, Session
from app.wiping import column, line
from tests.app.gui.conftest import pixels, settled
from tests.app.gui.hands import undo
from tests.app.gui.mouse import move

PAIRS = {
    "model": (Method("lambert"), Method("wrap")),
    "estimator": (Method("vtk"), Method("rusinkiewicz2004")),
    "material": (Method("skin1"), Method("marble")),
}


def _session(kind="model", **fields):
    fields = {"wipe": 0.5} | fields
    return Session(
        mesh="sample:sphere", view="compare", compared_by=kind, compared=PAIRS[kind], **fields
    )


def _surface_rows(window):
    """Rows and columns of the wiped surface in `pixels`, without letters and handle."""
    left, bottom, width, height = window.comparing.swipe.drawn.box
    top = window.canvas.window_.GetSize()[1] - bottom - height
    return slice(top + 40, top + height // 2 - 20), left, width


def _at(window, x, share_of_height=0.25):
    scale = window.canvas.devicePixelRatioF()
    return QPoint(round(x / scale), round(share_of_height * window.canvas.height()))


@pytest.mark.parametrize(
    ("kind", "fields"),
    [*((kind, {}) for kind in PAIRS), ("estimator", {"strokes": True, "fade": True})],
)
def test_left_is_the_first_and_right_the_second(open_window, qtbot, kind, fields) -> None:
    window = open_window(_session(kind, **fields))
    swipe = window.comparing.swipe
    rows, left, width = _surface_rows(window)
    seen = {}
    for shown in ("both", "first", "second"):
        swipe.show(shown)
        seen[shown] = pixels(window)[rows, left : left + width].astype(int)
    middle = column(swipe.drawn.box, 0.5) - left
    start, stop = (one - left for one in line(swipe.drawn.box, 0.5))
    assert np.abs(seen["first"] - seen["second"]).max() > 5
    np.testing.assert_array_equal(seen["both"][:, :start], seen["first"][:, :start])
    np.testing.assert_array_equal(seen["both"][:, stop:], seen["second"][:, stop:])
    assert start <= middle < stop
    # What the shader chooses is what is drawn without it: 1/255 is its rounding of bytes.
    made = window.controller.outcome.composition
    alone = [made.panels[0].content, made.panels[0].content.wipe.surface]
    for shown, surface in zip(("first", "second"), alone, strict=True):
        plain = _plain(window, surface)[rows, left : left + width]
        assert np.abs(seen[shown] - plain).max() <= 1


def _plain(window, surface: Surface):
    """The surface by itself, off the screen, in the window's size and with its sampling."""
    from dataclasses import replace

    from vtkmodules.vtkRenderingCore import vtkRenderWindow

    from app import gl
    from app.render import fill, grab

    made = window.controller.outcome.composition
    size = tuple(window.canvas.window_.GetSize())
    panels = [replace(made.panels[0], content=replace(surface, wipe=None)), *made.panels[1:]]
    with gl.offscreen():
        other = vtkRenderWindow()
    other.SetOffScreenRendering(1)
    other.SetMultiSamples(0)
    other.SetSize(*size)
    fill(other, panels, size, made.session.background, made.rows, window.canvas.origin)
    other.Render()
    image = grab(other, size).astype(int)
    other.Finalize()
    return image


def test_a_drag_moves_the_divider_and_is_one_step(open_window, qtbot) -> None:
    window = open_window(_session())
    canvas, swipe, document = window.canvas, window.comparing.swipe, window.controller.document
    camera = canvas.camera
    shown = []
    window.controller.shown.connect(shown.append)
    box = swipe.drawn.box
    start, end = column(box, 0.5), column(box, 0.25)
    qtbot.mousePress(canvas, Qt.MouseButton.LeftButton, pos=_at(window, start + 3))
    for x in np.linspace(start, end, 6):
        move(qtbot, canvas, _at(window, x))
        qtbot.wait(5)
    assert swipe.at == pytest.approx(0.25, abs=0.01)
    assert window.controller.session.wipe == 0.5
    assert not shown  # nothing was computed meanwhile
    rows, left, width = _surface_rows(window)
    first = pixels(window)[rows, left : left + width]
    qtbot.mouseRelease(canvas, Qt.MouseButton.LeftButton, pos=_at(window, end))
    settled(qtbot, window)
    assert window.controller.session.wipe == pytest.approx(0.25, abs=0.01)
    np.testing.assert_array_equal(pixels(window)[rows, left : left + width], first)
    assert canvas.camera == camera
    undo(qtbot, window)
    settled(qtbot, window)
    assert window.controller.session.wipe == 0.5
    assert swipe.at == 0.5
    assert document.undo_label is None


def test_a_drag_beside_the_divider_turns_the_mesh(open_window, qtbot) -> None:
    window = open_window(_session())
    before = window.canvas.camera
    x = column(window.comparing.swipe.drawn.box, 0.5) + 60
    qtbot.mousePress(window.canvas, Qt.MouseButton.LeftButton, pos=_at(window, x))
    move(qtbot, window.canvas, _at(window, x + 40))
    qtbot.mouseRelease(window.canvas, Qt.MouseButton.LeftButton, pos=_at(window, x + 40))
    settled(qtbot, window)
    assert window.canvas.camera != before
    assert window.controller.session.wipe == 0.5


def test_comma_and_full_stop_move_the_divider(open_window, qtbot) -> None:
    window = open_window(_session())
    qtbot.keyClick(window, Qt.Key.Key_Comma)
    qtbot.keyClick(window, Qt.Key.Key_Comma)
    qtbot.keyClick(window, Qt.Key.Key_Period)
    settled(qtbot, window)
    assert window.controller.session.wipe == pytest.approx(0.48)
    assert window.comparing.swipe.at == pytest.approx(0.48)


def test_flicker_shows_one_after_the_other_with_its_letter(open_window, qtbot) -> None:
    window = open_window(_session())
    flicker, letters = window.comparing.flicker, window.comparing.letters
    flicker.set_rate(10.0)
    seen = []
    flicker.changed.connect(lambda: seen.append(window.comparing.swipe.shown))
    qtbot.keyClick(window, Qt.Key.Key_B)
    qtbot.waitUntil(lambda: len(seen) >= 4)
    assert seen[:4] == ["first", "second", "first", "second"]
    qtbot.keyClick(window, Qt.Key.Key_N)
    qtbot.keyClick(window, Qt.Key.Key_N)
    assert not flicker.running
    assert [text.GetVisibility() for text in letters.texts].count(1) == 1
    side = window.comparing.swipe.shown
    (words,) = [text.GetInput() for text in letters.texts if text.GetVisibility()]
    assert words == {"first": "A  lambert", "second": "B  wrap"}[side]
    qtbot.keyClick(window, Qt.Key.Key_B)
    assert flicker.running
    qtbot.keyClick(window, Qt.Key.Key_B)
    assert not flicker.on
    assert window.comparing.mode == "swipe"
    assert all(text.GetVisibility() for text in letters.texts)


def test_the_coarse_stand_in_is_wiped_as_well(open_window, qtbot) -> None:
    from app.gui.coarse import coarse

    window = open_window(_session())
    canvas, swipe = window.canvas, window.comparing.swipe
    canvas.give_coarse(coarse(window.controller.outcome.subject.mesh, 1500))
    canvas._stand_in.show(canvas.drawn, True)
    rows, left, width = _surface_rows(window)
    seen = {}
    for shown in ("both", "first", "second"):
        swipe.show(shown)
        seen[shown] = pixels(window)[rows, left : left + width]
    start, stop = (one - left for one in line(swipe.drawn.box, 0.5))
    assert (seen["first"] != seen["second"]).any()
    np.testing.assert_array_equal(seen["both"][:, :start], seen["first"][:, :start])
    np.testing.assert_array_equal(seen["both"][:, stop:], seen["second"][:, stop:])
