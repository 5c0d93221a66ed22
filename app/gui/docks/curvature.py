"""Curvature: what is measured, how, and in which colours it is shown."""

from typing import TYPE_CHECKING, get_args

from qtpy.QtWidgets import QCheckBox, QComboBox, QFormLayout, QVBoxLayout, QWidget

from app.colormaps import PAPER, table
from app.gui.curvature_scale import ScaleForm
from app.gui.distribution import Distribution, distribution
from app.gui.peers import PeersButton
from app.gui.plugin_form import PluginForm
from app.gui.range_form import RangeForm
from app.gui.showing import COLORMAPS, SWITCHES, show_quantity
from app.quantities import QUANTITIES
from app.session import Quantity

if TYPE_CHECKING:
    from app.gui.controller import Outcome
    from app.gui.window import Window

TITLE, AREA, ORDER, SHOWN = "Curvature", "right", 2, True


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
    return CurvaturePanel(window)


class CurvaturePanel(QWidget):
    """The quantity, its estimator and scale, and its colours.

    Parameters
    ----------
    window : Window
        What it is about.
    """

    def __init__(self, window: "Window") -> None:
        super().__init__(window)
        self._controller = controller = window.controller
        self._found: Distribution | None = None
        self._measured: tuple[object, ...] = ()
        self._colormaps: list[str] = []
        self.quantity = QComboBox(self)
        self.quantity.setAccessibleName("Quantity")
        self.quantity.setToolTip("What the colours tell")
        for name in get_args(Quantity):
            text = "all" if name == "all" else QUANTITIES[name].heading
            self.quantity.addItem(text, name)
        self.quantity.activated.connect(
            lambda _: show_quantity(controller, self.quantity.currentData())
        )
        self.peers = PeersButton(controller)
        self.estimator = PluginForm(
            "Estimator",
            lambda made: controller.change("estimator", estimator=made),
            controller.begin_drag,
            controller.end_drag,
        )
        self._offered = False
        self.scale = ScaleForm(controller)
        self.range = RangeForm(controller)
        self.colormap = QComboBox(self)
        self.colormap.setAccessibleName("Colour map")
        self.colormap.setToolTip("The paper's green to red, or one that the colour-blind can read")
        self.colormap.activated.connect(self._on_colormap)
        self.switches: dict[str, QCheckBox] = {}
        for name, (text, doc) in SWITCHES.items():
            switch = self.switches[name] = QCheckBox(text, self)
            switch.setToolTip(doc)
            switch.setAccessibleName(text)
            switch.clicked.connect(
                lambda on, name=name, text=text: controller.change(text.lower(), **{name: on})
            )
        self._lay_out()
        controller.document.changed.connect(lambda *_: self.follow())
        controller.shown.connect(self._on_shown)
        self.follow()
        if controller.outcome is not None:
            self._on_shown(controller.outcome)

    def _lay_out(self) -> None:
        rows = QFormLayout()
        rows.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        rows.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        rows.addRow("Quantity", self.quantity)
        rows.addRow("", self.peers)
        rows.addRow("Estimator", self.estimator)
        rows.addRow("Scale", self.scale)
        rows.addRow("Colours", self.colormap)
        whole = QVBoxLayout(self)
        whole.addWidget(self.range)
        whole.addLayout(rows)
        for switch in self.switches.values():
            whole.addWidget(switch)
        whole.addStretch(1)

    def showEvent(self, event: object) -> None:  # noqa: N802
        """Catch up with what happened unseen; list the estimators when first seen."""
        if not self._offered:
            self._offered = True
            from lutcore.estimation import estimator_registry

            self.estimator.offer(estimator_registry.names(), estimator_registry.get)
            self.estimator.follow(self._controller.session.estimator)
        if self._controller.outcome is not None:
            self._on_shown(self._controller.outcome)

    def follow(self) -> None:
        """Show what the session says."""
        session = self._controller.session
        self.quantity.setCurrentIndex(self.quantity.findData(session.quantity))
        self.peers.setVisible(session.quantity in ("disagreement", "all"))
        self.peers.follow(session.peers)
        self.estimator.follow(session.estimator)
        self.scale.follow(session)
        self._follow_colormap(session.colormap or PAPER)
        for name, switch in self.switches.items():
            switch.setChecked(getattr(session, name))
        self._follow_range()

    def _follow_colormap(self, name: str) -> None:
        names = list(dict.fromkeys((*COLORMAPS, name)))
        if names != self._colormaps:
            self._colormaps = names
            self.colormap.clear()
            for one in names:
                self.colormap.addItem(COLORMAPS.get(one, one), one)
        self.colormap.setCurrentIndex(names.index(name))

    def _follow_range(self) -> None:
        session, outcome = self._controller.session, self._controller.outcome
        found = self._found
        if found is not None and found.quantity is not QUANTITIES.get(session.quantity):
            found = None
        ends = session.range
        if ends is None and outcome is not None and outcome.session.range is None:
            ends = outcome.composition.ranges.get(session.quantity)
        if ends is None:
            ends = (found.low, found.high) if found else (0.0, 1.0)
        several = session.quantity == "all"
        why = "Each quantity has a range of its own" if several else "..."
        colors = table(session.colormap or PAPER)
        self.range.follow(found, colors[::-1] if session.flip else colors, ends, why)

    def _on_colormap(self) -> None:
        name = self.colormap.currentData()
        self._controller.change("colour map", colormap=None if name == PAPER else name)

    def _on_shown(self, outcome: "Outcome") -> None:
        if not self.isVisible():
            return
        session = outcome.session
        self.scale.measure(outcome)
        self._follow_range()
        measured = (
            outcome.measured,
            outcome.mm_per_unit,
            session.quantity,
            session.peers,
            session.percentiles,
            session.symmetric,
        )
        if session.quantity == "all" or measured == self._measured:
            return
        self._measured = measured
        self._controller.run(
            "distribution",
            lambda _: distribution(session, self._controller.pipeline),
            self._on_distribution,
        )

    def _on_distribution(self, found: Distribution) -> None:
        self._found = found
        self._follow_range()
