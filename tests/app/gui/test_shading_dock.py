"""The dock of material, model and display, clicked and typed in."""

import math

import numpy as np
import pytest
from qtpy.QtCore import Qt
from qtpy.QtTest import QTest

from app.colormaps import PAPER, table
from app.loading import load_mesh
from app.picture import compose
from app.pipeline import Pipeline
from app.samples import sample
from app.session import Method, Session, Substance
from lutcore.materials import material
from tests.app.gui.conftest import pixels, settled
from tests.app.gui.hands import bring_to_view, choose, click_tab, tick, type_in, undo


@pytest.fixture
def panel(qtbot, window):
    click_tab(qtbot, window, "Shading")
    content = window.docks["shading"].fill()
    settled(qtbot, window)
    return content


def test_a_preset_changes_material_sliders_figures_and_picture(qtbot, window, panel):
    before = window.controller.outcome.composition.panels[0].content.rgb
    choose(qtbot, panel.material.preset, "marble")
    settled(qtbot, window)
    assert window.controller.session.material == "marble"
    assert panel.material.scattering[2].value == 3.0 and panel.material.eta[1].value == 1.5
    assert (window.controller.outcome.composition.panels[0].content.rgb != before).any()
    known = material("marble")
    length = known.mean_free_path[0] / known.beta[0]
    assert panel.material.facts.cells["length", 0].text() == f"{length:.3g}"


def test_a_slider_makes_a_changed_material_and_undo_takes_it_back(qtbot, window, panel):
    slider = panel.material.absorption[0].slider
    slider.setFocus()
    QTest.keyClick(slider, Qt.Key.Key_PageUp)
    settled(qtbot, window)
    made = window.controller.session.material
    assert isinstance(made, Substance) and made.name == "skin1, changed"
    assert made.absorption[0] > 0.032 and made.absorption[1:] == (0.17, 0.48)
    assert panel.material.preset.currentText() == "skin1, changed"
    undo(qtbot, window)
    assert window.controller.session.material == "skin1"
    assert panel.material.absorption[0].value == 0.032


def test_sliders_back_at_the_named_values_are_the_named_material(qtbot, window, panel):
    type_in(qtbot, panel.material.scattering[0].number, "0.5")
    assert window.controller.session.material.scattering[0] == 0.5
    type_in(qtbot, panel.material.scattering[0].number, "0.74")
    assert window.controller.session.material == "skin1"


def test_the_three_indices_move_together_until_they_are_parted(qtbot, window, panel, monkeypatch):
    monkeypatch.setattr("app.gui.document._ONE_STEP", 0.0)  # what follows at once is a step too
    form = panel.material
    assert form.linked.isChecked()
    type_in(qtbot, form.eta[1].number, "1.5")
    assert [slider.value for slider in form.eta] == [1.5, 1.5, 1.5]
    assert window.controller.session.material.eta == 1.5
    before = window.controller.outcome.composition.panels[0].content.rgb
    tick(qtbot, form.linked)
    type_in(qtbot, form.eta[2].number, "2")
    settled(qtbot, window)
    assert window.controller.session.material.eta == (1.5, 1.5, 2.0)
    after = window.controller.outcome.composition.panels[0].content.rgb
    changed = (after != before).any(axis=0)
    assert changed[2]
    # Joined again they are what red is, and that is one step to undo.
    tick(qtbot, form.linked)
    assert window.controller.session.material.eta == 1.5
    undo(qtbot, window)
    assert window.controller.session.material.eta == (1.5, 1.5, 2.0)
    assert not form.linked.isChecked() and form.eta[2].value == 2.0


def test_no_absorption_is_the_left_end(window, panel):
    red = panel.material.absorption[0]
    red.slider.setFocus()
    QTest.keyClick(red.slider, Qt.Key.Key_Home)
    assert red.value == 0.0 and window.controller.session.material.absorption[0] == 0.0


def test_equal_ways_of_a_logarithmic_slider_are_equal_ratios(panel):
    red = panel.material.scattering[0]
    red.follow(0.1)
    first = red.slider.value()
    red.follow(1.0)
    second = red.slider.value()
    red.follow(10.0)
    assert abs((red.slider.value() - second) - (second - first)) <= 1


def test_the_scale_is_the_files_own_until_it_is_typed(qtbot, window, panel):
    assert panel.own_unit.isChecked() and panel.unit.value == 1.0
    type_in(qtbot, panel.unit.number, "2.5")
    settled(qtbot, window)
    assert window.controller.session.mm_per_unit == 2.5 and not panel.own_unit.isChecked()
    assert window.controller.outcome.mm_per_unit == 2.5
    tick(qtbot, panel.own_unit)
    assert window.controller.session.mm_per_unit is None


def test_a_model_shows_its_own_parameters(qtbot, window, panel):
    assert set(panel.model.form.controls) == {"hinges", "area", "samples"}
    type_in(qtbot, panel.model.form.controls["hinges"], "8")
    assert window.controller.session.model == Method("curvature-lut", {"hinges": 8.0})
    choose(qtbot, panel.model.names, "lambert")
    assert window.controller.session.model == Method("lambert")
    assert "hinges" not in panel.model.form.controls
    settled(qtbot, window)


def test_the_profile_and_shadows_are_chosen(qtbot, window, panel):
    choose(qtbot, panel.profile.names, "burley2015")
    choose(qtbot, panel.shadows, panel.shadows.itemText(panel.shadows.findData("on")))
    settled(qtbot, window)
    session = window.controller.session
    assert session.profile.name == "burley2015" and session.shadows == "on"
    choose(qtbot, panel.shadows, panel.shadows.itemText(0))
    assert window.controller.session.shadows is None and panel.shadows.currentIndex() == 0
    window.controller.change("model", model=Method("auto"))
    assert window.controller.session.casts == "auto" and panel.shadows.currentIndex() == 0
    undo(qtbot, window)


def test_exposure_is_automatic_or_in_stops(qtbot, window, panel):
    automatic = window.controller.outcome.composition.exposure
    assert panel.exposure.value == pytest.approx(math.log2(automatic), abs=1e-6)
    tick(qtbot, panel.auto_exposure)
    # What is shown stays, to the nine decimals that the slider's number keeps of the stops.
    assert window.controller.session.exposure == pytest.approx(automatic, rel=1e-8)
    before = window.controller.outcome.composition.panels[0].content.rgb.astype(int)
    type_in(qtbot, panel.exposure.number, f"{math.log2(automatic) - 1.0:.4f}")
    settled(qtbot, window)
    after = window.controller.outcome.composition.panels[0].content.rgb
    assert (after <= before).all()
    # sRGB's power part; both are rounded to bytes, and stops to four digits.
    bright = (before > 100) & (before < 255)
    expected = 255.0 * ((before[bright] / 255.0 + 0.055) * 0.5 ** (1.0 / 2.4) - 0.055)
    np.testing.assert_allclose(after[bright], expected, atol=1.0)
    tick(qtbot, panel.auto_exposure)
    assert window.controller.session.exposure is None


def test_arrow_keys_move_a_slider_and_open_no_other_file(window, panel):
    opened = []
    window.controller.noted.connect(opened.append)
    red = panel.material.scattering[0]
    before = red.value
    red.slider.setFocus()
    QTest.keyClick(red.slider, Qt.Key.Key_Right)
    assert red.value > before and not opened


def test_flat_colours_are_the_exact_ones_of_the_map(qtbot, window, panel):
    assert not panel.albedo.isEnabled()  # the sphere's file has no colours
    qtbot.keyClick(window, Qt.Key.Key_F3)
    settled(qtbot, window)
    lit = pixels(window)
    bring_to_view(qtbot, panel.flat)
    tick(qtbot, panel.flat)
    settled(qtbot, window)
    assert window.controller.session.flat
    flat = pixels(window)
    colors = np.rint(255.0 * table(PAPER)).astype(int)

    def of_the_map(image) -> float:
        mesh = image[(image != image[2, 2]).any(axis=2)][::7].astype(int)
        return np.mean(np.abs(mesh[:, None] - colors).max(axis=2).min(axis=1) <= 3)

    # Beside them there are the bar's letters and edges.
    assert of_the_map(flat) > 0.9 > of_the_map(lit)


def test_the_files_own_colours_are_seen_and_left_out(open_window, qtbot, tmp_path):
    mesh = load_mesh(sample("sphere").path).mesh
    path = tmp_path / "red.off"
    red = [f"{x} {y} {z} 255 40 40" for x, y, z in mesh.vertices]
    faces = [f"3 {a} {b} {c}" for a, b, c in mesh.faces]
    path.write_text("\n".join(["COFF", f"{len(red)} {len(faces)} 0", *red, *faces, ""]))
    window = open_window(Session(mesh=str(path), material="marble"))
    panel = window.docks["shading"].fill()
    click_tab(qtbot, window, "Shading")
    settled(qtbot, window)
    with_colours = pixels(window).astype(int)
    middle = tuple(one // 2 for one in with_colours.shape[:2])
    assert with_colours[middle][0] > with_colours[middle][2] + 40
    bring_to_view(qtbot, panel.albedo)
    tick(qtbot, panel.albedo)
    settled(qtbot, window)
    assert not window.controller.session.albedo
    without = pixels(window).astype(int)
    assert without[middle][0] < without[middle][2] + 40


def test_all_controls_have_names_and_tips(panel):
    from qtpy.QtWidgets import QAbstractSlider, QCheckBox, QComboBox

    from app.gui.slider import Number

    for kind in (QAbstractSlider, QCheckBox, QComboBox, Number):
        for widget in panel.findChildren(kind):
            if widget.isVisibleTo(panel):
                name = widget.accessibleName() or getattr(widget, "text", str)()
                assert name and widget.toolTip(), widget


def test_the_view_shows_what_the_command_line_draws(qtbot, window, panel):
    choose(qtbot, panel.material.preset, "ketchup")
    settled(qtbot, window)
    outcome = window.controller.outcome
    made = compose(outcome.session, Pipeline())
    assert isinstance(outcome.session, Session)
    np.testing.assert_array_equal(
        made.panels[0].content.rgb, outcome.composition.panels[0].content.rgb
    )
