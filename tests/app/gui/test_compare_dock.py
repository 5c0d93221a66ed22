"""The comparison's controls, by clicks and keys."""

import numpy as np
import pytest
from qtpy.QtCore import Qt

from app.camera import axes
from app.gui import versus
from app.gui.facing import facing
from app.scene import Surface
from app.session import Camera, Directional, Method, Session, Substance
from tests.app.gui.conftest import pixels, settled
from tests.app.gui.hands import choose, click_tab, tick, type_in, undo


@pytest.fixture
def panel(window, qtbot):
    dock = window.docks["compare"]
    click_tab(qtbot, window, "Compare")
    qtbot.waitUntil(lambda: dock.content is not None)
    return dock.content


def _names(window):
    return [one.name for one in window.controller.session.compared]


def test_entering_compares_the_model_with_the_plainest(window, qtbot) -> None:
    qtbot.keyClick(window, Qt.Key.Key_F5)
    settled(qtbot, window)
    session = window.controller.session
    assert (session.view, _names(window)) == ("compare", ["curvature-lut", "lambert"])
    assert len(window.canvas.renderers()) == 2
    assert [text.GetInput() for text in window.comparing.letters.texts] == [
        "A  curvature-lut",
        "B  lambert",
    ]
    qtbot.keyClick(window, Qt.Key.Key_F5)
    settled(qtbot, window)
    assert window.controller.session.view == "shade"
    qtbot.keyClick(window, Qt.Key.Key_F5)
    assert _names(window) == ["curvature-lut", "lambert"]


def test_names_and_parameters_are_chosen_in_the_dock(window, panel, qtbot) -> None:
    tick(qtbot, panel.modes["swipe"])
    settled(qtbot, window)
    assert window.controller.session.wipe == 0.5
    tick(qtbot, panel.modes["side"])
    settled(qtbot, window)
    assert window.controller.session.wipe is None
    choose(qtbot, panel.sides[1].names, "wrap")
    settled(qtbot, window)
    assert _names(window) == ["curvature-lut", "wrap"]
    before = window.controller.outcome.composition.panels[1].content.rgb
    width = panel.sides[1].form.controls["width"]
    type_in(qtbot, width.number, "0.7")
    settled(qtbot, window)
    assert window.controller.session.compared[1] == Method("wrap", {"width": 0.7})
    made = window.controller.outcome.composition
    assert (made.panels[1].content.rgb != before).any()
    qtbot.mouseClick(panel.swap, Qt.MouseButton.LeftButton)
    settled(qtbot, window)
    assert _names(window) == ["wrap", "curvature-lut"]
    assert panel.sides[0].names.currentText() == "wrap"
    assert panel.sides[0].form.controls["width"].number.value() == pytest.approx(0.7)


def test_four_views_have_one_camera_and_a_swipe_leaves_two(window, panel, qtbot) -> None:
    tick(qtbot, panel.modes["side"])
    assert not panel.sides[3].isVisibleTo(panel)
    choose(qtbot, panel.sides[2].names, "wrap")
    choose(qtbot, panel.sides[3].names, "kubo2010")
    settled(qtbot, window)
    assert len(window.canvas.renderers()) == 4
    qtbot.keyClick(window, Qt.Key.Key_7)
    settled(qtbot, window)
    views = [one.renderer.GetActiveCamera() for one in window.canvas.renderers()]
    assert len({view.GetPosition() for view in views}) == 1
    assert len({view.GetClippingRange() for view in views}) == 1
    choose(qtbot, panel.sides[2].names, "none")
    assert _names(window) == ["curvature-lut", "lambert", "kubo2010"]
    tick(qtbot, panel.modes["swipe"])
    settled(qtbot, window)
    assert _names(window) == ["curvature-lut", "lambert"]
    assert len(window.canvas.renderers()) == 1


@pytest.mark.parametrize("kind", ["estimator", "material"])
def test_estimators_and_materials_are_compared_as_well(window, panel, qtbot, kind) -> None:
    failures = []
    window.controller.failed.connect(failures.append)
    choose(qtbot, panel.kind, panel.kind.itemText(panel.kind.findData(kind)))
    settled(qtbot, window)
    session = window.controller.session
    assert session.compared_by == kind
    assert len(window.canvas.renderers()) == 2
    assert not failures
    while window.controller.session.compared_by != "model":
        undo(qtbot, window)
    settled(qtbot, window)
    assert window.controller.session.compared_by == "model"
    assert panel.kind.currentData() == "model"


def test_the_difference_is_told_and_its_worst_point_faced(window, panel, qtbot) -> None:
    # A light that stays where it is, or another point would be the worst from elsewhere.
    window.controller.change("lights", lights=(Directional((1.0, 0.2, 0.1)),))
    tick(qtbot, panel.difference)
    settled(qtbot, window)
    (label,) = panel.apart.texts
    (found,) = window.controller.outcome.composition.difference.values()
    text = panel.apart.texts[label].text()
    for part in (f"mean {found['mean']:.3g}", f"{found['p99']:.3g}", f"vertex {found['vertex']}"):
        assert part in text
    qtbot.mouseClick(panel.apart.buttons[label], Qt.MouseButton.LeftButton)
    settled(qtbot, window)
    camera = window.canvas.camera
    assert camera.target == pytest.approx(found["position"])
    normals = next(
        one.content.normals
        for one in window.controller.outcome.composition.panels
        if isinstance(one.content, Surface)
    )
    np.testing.assert_allclose(axes(camera)[2], normals[found["vertex"]], atol=1e-6)
    # The mark is in the middle of the map of differences.
    left, bottom, width, height = window.canvas.renderers()[2].box
    shown = pixels(window)
    middle = shown[len(shown) - 1 - (bottom + height // 2), left + width // 2].astype(int)
    assert middle[1] > 200
    assert middle[0] < 100


def test_a_mesh_far_away_is_drawn_whole_in_all_views(open_window, qtbot, tmp_path) -> None:
    path = tmp_path / "far.off"
    corners = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    stray = corners * 0.01 + [0.0, 0.0, -3e4]
    points = np.vstack([corners, stray]) + 1e6
    lines = [" ".join(map(repr, map(float, point))) for point in points]
    faces = ["3 0 1 2", "3 0 2 3", "3 4 5 6", "3 4 6 7"]
    path.write_text("\n".join(["OFF", "8 4 0", *lines, *faces, ""]))
    names = ("lambert", "wrap", "kubo2010", "lambert")
    window = open_window(
        Session(
            mesh=str(path),
            view="compare",
            compared=tuple(Method(name) for name in names),
            camera=Camera((1e6, 1e6, 1e6 + 6.0), (1e6, 1e6, 1e6)),
        )
    )
    # A roll keeps the square's area in the picture.
    window.controller.look(
        Camera((1e6, 1e6, 1e6 + 6.0), (1e6, 1e6, 1e6), up=(0.3, 1.0, 0.0)),
    )
    settled(qtbot, window)
    shown = pixels(window)
    for drawn in window.canvas.renderers():
        left, bottom, width, height = drawn.box
        part = shown[len(shown) - bottom - height :][:height, left : left + width]
        # Below the letters.
        covered = (part[40:] != shown[-1, -1]).any(axis=2).sum()
        # 2 units of 6 x 2 tan(15 degrees) over the height.
        assert covered == pytest.approx(
            (height * 2.0 / (12.0 * np.tan(np.pi / 12.0))) ** 2, rel=0.03
        )


def test_facing_keeps_distance_and_up() -> None:
    camera = Camera((0.0, 0.0, 5.0), (0.0, 0.0, 0.0))
    point = np.array([1.0, 0.0, 0.0])
    turned = facing(camera, point, np.array([2.0, 0.0, 0.0]))
    assert turned.position == pytest.approx((6.0, 0.0, 0.0))
    assert axes(turned)[1] == pytest.approx([0.0, 1.0, 0.0])
    above = facing(camera, point, np.array([0.0, 1.0, 0.0]))
    assert axes(above)[1] == pytest.approx([0.0, 0.0, -1.0])
    shifted = facing(camera, point, np.zeros(3))
    assert axes(shifted) == pytest.approx(axes(camera))
    assert shifted.target == (1.0, 0.0, 0.0)


def test_what_is_compared_follows_what_is_shown() -> None:
    assert [one.name for one in versus.sides(Session(model=Method("lambert")))] == [
        "lambert",
        "curvature-lut",
    ]
    soap = Substance("soap", (1.0, 1.0, 1.0), (0.1, 0.1, 0.1), 1.3)
    session = Session(compared_by="material", material=soap)
    assert [one.name for one in versus.sides(session)] == ["soap", "marble"]
    assert versus.names(session, "material")[0] == "soap"
    changed = versus.turned_to(Session(quantity="all", range=(0.0, 1.0)), "estimator")
    assert changed["quantity"] == "curvedness"
    assert changed["range"] is None
