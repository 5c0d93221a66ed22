"""Shading: the material, its size, the model, and how the result is shown."""

import math
from typing import TYPE_CHECKING

from qtpy.QtWidgets import QCheckBox, QComboBox, QFormLayout, QGroupBox, QVBoxLayout, QWidget

from app.gui.material_form import MaterialForm
from app.gui.plugin_form import PluginForm
from app.gui.slider import Slider

if TYPE_CHECKING:
    from app.gui.controller import Outcome
    from app.gui.window import Window
    from lutcore.progress import Progress

TITLE, AREA, ORDER, SHOWN = "Shading", "right", 1, True
_SHADOWS = {
    "": "off, but for the model auto",
    "off": "off",
    "on": "on",
    "auto": "where they change much",
}
_STOPS = 10.0


def build(window: "Window") -> QWidget:
    """Make the dock's content.

    Parameters
    ----------
    window : Window
        What it is about.

    Returns
    -------
    QWidget
        The content.
    """
    return ShadingPanel(window)


class ShadingPanel(QWidget):
    """What the mesh is made of, and how it is shaded and shown.

    Parameters
    ----------
    window : Window
        What it is about.
    """

    def __init__(self, window: "Window") -> None:
        super().__init__(window)
        self._controller = controller = window.controller
        drags = controller.begin_drag, controller.end_drag
        self.material = MaterialForm(
            lambda made: controller.change("material", material=made), *drags
        )
        self.model = PluginForm(
            "Model", lambda made: controller.change("model", model=made), *drags
        )
        self.profile = PluginForm(
            "Diffusion profile", lambda made: controller.change("profile", profile=made), *drags
        )
        self._offered = False
        self._asked: tuple[object, ...] = ()
        self.unit = Slider(
            "Millimetres in a mesh unit",
            "Size of a mesh unit, mm: light spreads by millimetres, so small things glow more",
            1e-4,
            1e4,
            suffix=" mm",
            logarithmic=True,
        )
        self.unit.changed.connect(lambda value: controller.change("scale", mm_per_unit=value))
        self.own_unit = QCheckBox("as the file says", self)
        self.own_unit.setToolTip("Take the size that the file or the sample gives, else 1 mm")
        self.own_unit.clicked.connect(self._on_own_unit)
        self.shadows = QComboBox(self)
        for data, text in _SHADOWS.items():
            self.shadows.addItem(text, data)
        self.shadows.setAccessibleName("Shadows")
        self.shadows.setToolTip(
            "Whether the surface casts shadows on itself; the model auto finds out by itself"
        )
        self.shadows.activated.connect(
            lambda _: controller.change("shadows", shadows=self.shadows.currentData() or None)
        )
        self.exposure = Slider(
            "Exposure",
            "Exposure in stops: each doubles the light; at 0 an exitance of 1 is white",
            -_STOPS,
            _STOPS,
            suffix=" stops",
        )
        self.exposure.changed.connect(
            lambda stops: controller.change("exposure", exposure=2.0**stops)
        )
        self.auto_exposure = QCheckBox("automatic", self)
        self.auto_exposure.setToolTip(
            "Bring the brightest parts near white; it stands still while something is dragged"
        )
        self.auto_exposure.clicked.connect(self._on_auto_exposure)
        self.albedo = QCheckBox("Colours of the file", self)
        self.albedo.setToolTip("Multiply the light by the vertex colours or texture of the file")
        self.albedo.clicked.connect(lambda on: controller.change("albedo", albedo=on))
        self.flat = QCheckBox("Flat colours of curvature", self)
        self.flat.setToolTip("Show curvature in the exact colours of the bar, without shape")
        self.flat.clicked.connect(lambda on: controller.change("flat colours", flat=on))
        for slider in (self.unit, self.exposure):
            slider.pressed.connect(drags[0])
            slider.released.connect(drags[1])
        self._lay_out()
        controller.document.changed.connect(lambda *_: self.follow())
        controller.shown.connect(self._on_shown)
        if controller.outcome is not None:
            self._on_shown(controller.outcome)
        self.follow()

    def follow(self) -> None:
        """Show what the session says."""
        session = self._controller.session
        self.material.follow(session.material)
        self.model.follow(session.model)
        self.profile.follow(session.profile)
        self.own_unit.setChecked(session.mm_per_unit is None)
        self.auto_exposure.setChecked(session.exposure is None)
        if session.mm_per_unit is not None:
            self.unit.follow(session.mm_per_unit)
        if session.exposure is not None:
            self.exposure.follow(math.log2(session.exposure))
        self.shadows.setCurrentIndex(self.shadows.findData(session.shadows or ""))
        self.albedo.setChecked(session.albedo)
        self.flat.setChecked(session.flat)
        asked = session.material, session.profile
        # Not before the first picture, which would wait for what this loads.
        if self._offered and asked != self._asked:
            self._asked = asked
            self._ask_for_facts()

    def _lay_out(self) -> None:
        column = QVBoxLayout(self)
        for title, rows in (
            ("Material", ((None, self.material),)),
            ("Scale", (("mm per unit", self.unit), ("", self.own_unit))),
            (
                "Model",
                (
                    ("Model", self.model),
                    ("Profile", self.profile),
                    ("Shadows", self.shadows),
                ),
            ),
            (
                "Display",
                (
                    ("Exposure", self.exposure),
                    ("", self.auto_exposure),
                    ("", self.albedo),
                    ("", self.flat),
                ),
            ),
        ):
            box = QGroupBox(title, self)
            form = QFormLayout(box)
            form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
            form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
            for text, widget in rows:
                if text is None:
                    form.addRow(widget)
                else:
                    form.addRow(text, widget)
            column.addWidget(box)
        column.addStretch(1)

    def _on_shown(self, outcome: "Outcome") -> None:
        if not self._offered:
            # Now that they are loaded; before the first picture that would be waited for.
            from lutcore.diffusion import diffusion_profiles, profile_registry
            from lutcore.shading import AUTO, model_registry, shading_models

            self._offered = True
            self.model.offer([AUTO, *shading_models()], model_registry.get)
            self.profile.offer(diffusion_profiles(), profile_registry.get)
            self.follow()
        session = self._controller.session
        if session.mm_per_unit is None:
            self.unit.follow(outcome.mm_per_unit)
        exposure = outcome.composition.exposure
        if session.exposure is None and exposure:
            self.exposure.follow(math.log2(exposure))
        loaded = outcome.subject.loaded
        self.albedo.setEnabled(loaded.colors is not None or loaded.texture is not None)

    def _on_own_unit(self, on: bool) -> None:
        self._controller.change("scale", mm_per_unit=None if on else self.unit.value)

    def _on_auto_exposure(self, on: bool) -> None:
        self._controller.change("exposure", exposure=None if on else 2.0**self.exposure.value)

    def _ask_for_facts(self) -> None:
        session = self._controller.session
        pipeline = self._controller.pipeline

        def facts(_: "Progress") -> tuple[list[float], list[float]]:
            from lutcore.diffusion import optics

            made = pipeline.material(session)
            profile = pipeline.profile(session)
            channels = optics(made)
            lengths = [
                one.mean_free_path / one.beta if one.beta > 0.0 else math.inf for one in channels
            ]
            return lengths, [profile.total(one) for one in channels]

        self._controller.run("facts", facts, lambda found: self.material.facts.tell(*found))
