"""The health dock and the question for the unit."""

import numpy as np
import pytest
from qtpy.QtCore import Qt

from app.gui.settings import Settings
from app.session import Method, Repair, Session
from tests.app.gui.conftest import settled
from tests.app.gui.hands import click_menu, click_tab, type_in, undo

LEFT = Qt.MouseButton.LeftButton


def _stl_of_parts(path, scale: float = 1.0):
    """An octahedron with a hole, and a small one beside it."""
    points = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
    faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    lines = []
    for size, away, some in ((10.0, 0.0, faces[:-1]), (0.5, 20.0, faces)):
        first = len([line for line in lines if line.startswith("v ")]) + 1
        lines += ["v " + " ".join(f"{scale * x:.9g}" for x in size * p + away) for p in points]
        lines += ["f " + " ".join(str(i + first) for i in face) for face in some]
    path.write_text("\n".join(lines) + "\n")
    return str(path)


def _fast(mesh: str) -> Session:
    return Session(mesh=mesh, view="curvature", estimator=Method("rusinkiewicz2004"))


@pytest.fixture
def window(open_window, tmp_path):
    return open_window(_fast(_stl_of_parts(tmp_path / "parts.obj")))


@pytest.fixture
def panel(window, qtbot):
    dock = window.docks["health"]
    click_menu(qtbot, window, "Window", "Health")
    qtbot.waitUntil(lambda: dock.content is not None and dock.content.isVisible())
    _rest(qtbot, window)
    return dock.content


def _rest(qtbot, window) -> None:
    # A repair asks for a picture, which asks for what is odd.
    for _ in range(3):
        settled(qtbot, window)


def test_it_says_what_is_odd(panel) -> None:
    assert "15 faces, an open surface" in panel.counts.text()
    assert "separate parts: 2" in panel.remarks.text()
    assert panel.buttons["holes"].isEnabled()
    assert not panel.buttons["orient"].isEnabled()


def test_repairs_are_done_undone_and_left_out(window, panel, qtbot) -> None:
    qtbot.mouseClick(panel.buttons["islands"], LEFT)
    _rest(qtbot, window)
    assert window.controller.session.repairs == (Repair("islands", 10.0),)
    assert "7 faces, an open surface" in panel.counts.text()
    qtbot.mouseClick(panel.buttons["holes"], LEFT)
    _rest(qtbot, window)
    assert "8 faces, a closed surface" in panel.counts.text()
    assert panel.remarks.text() == "Nothing is odd."
    assert panel.done.count() == 2
    assert window.controller.document.undo_label == "fill holes, 100 edges"
    undo(qtbot, window)
    _rest(qtbot, window)
    assert "7 faces" in panel.counts.text()
    keys = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
    qtbot.keyClick(window, Qt.Key.Key_Z, keys)
    _rest(qtbot, window)
    first = panel.done.visualItemRect(panel.done.item(0))
    qtbot.mouseClick(panel.done.viewport(), LEFT, pos=first.center())
    qtbot.mouseClick(panel.leave_out, LEFT)
    _rest(qtbot, window)
    assert window.controller.session.repairs == (Repair("holes", 100.0),)
    assert "16 faces" in panel.counts.text()
    qtbot.mouseClick(panel.leave_all, LEFT)
    _rest(qtbot, window)
    assert window.controller.session.repairs == ()
    assert not panel.leave_out.isEnabled()


def test_vertices_are_merged_faces_turned_and_their_number_reduced(open_window, qtbot, tmp_path):
    """Two patches that share a seam but no vertex, the second one inside out."""
    rows = 9
    x, y = (one.ravel() for one in np.meshgrid(np.arange(rows), np.arange(rows)))
    corner = np.array([i for i in range(rows * (rows - 1)) if i % rows != rows - 1])
    one = np.stack(
        [corner, corner + 1, corner + rows, corner + 1, corner + rows + 1, corner + rows]
    )
    one = one.T.reshape(-1, 3) + 1
    lines = [f"v {a} {b} {0.1 * a * b}" for a, b in zip(x, y, strict=True)]
    lines += [f"v {-a} {b} {0.1 * a * b}" for a, b in zip(x, y, strict=True)]
    faces = np.vstack([one, one + rows * rows])  # mirrored, so that the second faces down
    lines += ["f " + " ".join(map(str, face)) for face in faces]
    path = tmp_path / "seam.obj"
    path.write_text("\n".join(lines) + "\n")
    window = open_window(_fast(str(path)), size=(1200, 900))
    click_menu(qtbot, window, "Window", "Health")
    panel = window.docks["health"].fill()
    _rest(qtbot, window)
    assert "162 vertices" in panel.counts.text()
    qtbot.mouseClick(panel.buttons["merge"], LEFT)
    _rest(qtbot, window)
    assert "153 vertices" in panel.counts.text()
    assert panel.buttons["orient"].isEnabled()
    qtbot.mouseClick(panel.buttons["orient"], LEFT)
    _rest(qtbot, window)
    assert not panel.buttons["orient"].isEnabled()
    type_in(qtbot, panel.numbers["decimate"], "100")
    qtbot.mouseClick(panel.buttons["decimate"], LEFT)
    _rest(qtbot, window)
    assert len(window.controller.outcome.subject.mesh.faces) <= 100
    assert [one.kind for one in window.controller.session.repairs] == [
        "merge",
        "orient",
        "decimate",
    ]
    for _ in range(3):
        undo(qtbot, window)
        _rest(qtbot, window)
    assert "162 vertices" in panel.counts.text()


def test_a_repair_that_fails_changes_nothing(window, panel, qtbot) -> None:
    type_in(qtbot, panel.numbers["islands"], "99")
    qtbot.mouseClick(panel.buttons["islands"], LEFT)
    _rest(qtbot, window)
    assert window.banner.isVisible()
    assert "leaves no face" in window.banner.label.text()
    assert window.controller.session.repairs == ()
    assert window.controller.document.undo_label is None


def test_a_window_with_repairs_draws_what_the_command_line_draws(window, panel, qtbot) -> None:
    qtbot.mouseClick(panel.buttons["islands"], LEFT)
    _rest(qtbot, window)
    from app.pipeline import Pipeline

    mesh = Pipeline().subject(window.controller.session).mesh
    shown = window.controller.outcome.subject.mesh
    np.testing.assert_array_equal(mesh.vertices, shown.vertices)
    np.testing.assert_array_equal(mesh.faces, shown.faces)


def test_another_mesh_comes_without_these_repairs(window, panel, qtbot) -> None:
    qtbot.mouseClick(panel.buttons["islands"], LEFT)
    _rest(qtbot, window)
    click_menu(qtbot, window, "File", "Sample meshes", "sphere")
    _rest(qtbot, window)
    assert window.controller.session.repairs == ()
    assert panel.remarks.text() == "Nothing is odd."


def test_the_unit_is_asked_once_for_each_file(open_window, qtbot, tmp_path) -> None:
    tiny = _stl_of_parts(tmp_path / "tiny.obj", 1e-3)
    window = open_window(_fast(tiny))
    _rest(qtbot, window)
    bar = window.unit_bar
    assert bar.isVisible()
    assert "0.0528 mm" in bar.label.text()
    qtbot.mouseClick(bar.buttons["m"], LEFT)
    _rest(qtbot, window)
    assert not bar.isVisible()
    assert window.controller.outcome.mm_per_unit == 1000.0
    click_menu(qtbot, window, "File", "Sample meshes", "sphere")
    _rest(qtbot, window)
    assert not bar.isVisible()
    click_menu(qtbot, window, "File", "Open recent", "tiny.obj")
    _rest(qtbot, window)
    assert not bar.isVisible()
    assert window.controller.session.mm_per_unit == 1000.0
    assert list(Settings().get("units", {}).values()) == [1000.0]


def test_an_open_answer_is_remembered_too(open_window, qtbot, tmp_path) -> None:
    tiny = _stl_of_parts(tmp_path / "tiny.obj", 1e-3)
    window = open_window(_fast(tiny))
    _rest(qtbot, window)
    qtbot.mouseClick(window.unit_bar.close_, LEFT)
    click_menu(qtbot, window, "File", "Sample meshes", "sphere")
    _rest(qtbot, window)
    click_menu(qtbot, window, "File", "Open recent", "tiny.obj")
    _rest(qtbot, window)
    assert not window.unit_bar.isVisible()
    assert window.controller.session.mm_per_unit is None


def test_a_unit_given_elsewhere_ends_the_question(open_window, qtbot, tmp_path) -> None:
    window = open_window(_fast(_stl_of_parts(tmp_path / "tiny.obj", 1e-3)))
    _rest(qtbot, window)
    assert window.unit_bar.isVisible()
    click_tab(qtbot, window, "Shading")
    type_in(qtbot, window.docks["shading"].fill().unit.number, "100")
    assert window.controller.session.mm_per_unit == 100.0
    assert not window.unit_bar.isVisible()
