"""Where one plug-in's form takes another's place, nothing of the old one is seen at any moment."""

import numpy as np
import pytest
from qtpy.QtGui import QImage
from qtpy.QtWidgets import QApplication, QLabel, QWidget

from app.session import Method, Session
from tests.app.gui.conftest import settled
from tests.app.gui.hands import choose
from tests.app.gui.test_fits import faults


def labels(form: QWidget) -> list[str]:
    return [one.text() for one in form.findChildren(QLabel) if one.isVisible()]


def grabbed(widget: QWidget) -> np.ndarray:
    image = widget.grab().toImage().convertToFormat(QImage.Format.Format_RGB32)
    rows = np.frombuffer(image.constBits(), np.uint8)
    return rows.reshape(image.height(), image.bytesPerLine()).copy()


@pytest.mark.parametrize(
    ("dock", "part"), [("shading", "model"), ("shading", "profile"), ("curvature", "estimator")]
)
def test_the_old_parameters_are_gone_at_every_moment(window, qtbot, dock, part) -> None:
    window.docks[dock].raise_()
    panel = window.docks[dock].fill()
    qtbot.waitUntil(panel.isVisible)
    settled(qtbot, window)
    form = getattr(panel, part)
    names = [form.names.itemText(at) for at in range(form.names.count())]
    assert len(names) > 3
    for name in names:
        choose(qtbot, form.names, name)
        assert form.names.currentText() == name
        expected = [
            one.text() for one in form.form.findChildren(QLabel) if not one.isHidden()
        ]  # as it will be
        for _ in range(4):
            seen = labels(form)
            assert seen in ([], expected), name
            QApplication.processEvents()
        assert labels(form) == expected, name
        assert faults(panel) == [], name
        # What is drawn now is what stays.
        now = grabbed(form)
        window.controller.worker.cancel()
        settled(qtbot, window)
        qtbot.waitUntil(lambda: len(form.findChildren(type(form.form))) == 1)
        np.testing.assert_array_equal(grabbed(form), now)
    settled(qtbot, window)


def test_the_sides_of_a_comparison_follow_at_once(open_window, qtbot) -> None:
    session = Session(
        mesh="sample:sphere",
        view="compare",
        compared=(Method("lambert"), Method("curvature-lut")),
    )
    window = open_window(session)
    window.docks["compare"].raise_()
    panel = window.docks["compare"].fill()
    settled(qtbot, window)
    side = panel.sides[0]
    for name in ("kubo2010", "lambert", "gather", "curvature-lut-physical"):
        choose(qtbot, side.names, name)
        assert side.names.currentText() == name
        for _ in range(3):
            assert len([one for one in side.findChildren(type(side.form)) if one.isVisible()]) <= 1
            QApplication.processEvents()
        assert faults(side) == [], name
        window.controller.worker.cancel()
    settled(qtbot, window)
