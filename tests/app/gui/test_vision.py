"""The preview for the colour-blind."""

import numpy as np
import pytest

from app.colormaps import table
from app.gui.vision import KINDS, matrix, simulated
from app.session import Method, Session
from lutcore.metrics import ciede2000
from tests.app.gui.conftest import pixels, settled
from tests.app.gui.hands import click_menu


@pytest.mark.parametrize("kind", KINDS)
def test_greys_are_seen_as_they_are(kind) -> None:
    greys = np.repeat(np.linspace(0.0, 1.0, 9)[:, None], 3, axis=1)
    # The rows of a matrix sum to 1, as printed in the paper with six digits.
    assert simulated(greys, matrix(kind)) == pytest.approx(greys, abs=1e-4)


def test_the_papers_ends_come_closer_and_those_of_its_twin_do_not() -> None:
    def apart(name: str) -> tuple[float, float]:
        ends = table(name)[[0, -1]]
        seen = simulated(ends, matrix("deuteranopia"))
        before, after = (np.rint(255.0 * one).astype(np.uint8) for one in (ends, seen))
        return float(ciede2000(before[:1], before[1:])[0]), float(
            ciede2000(after[:1], after[1:])[0]
        )

    before, after = apart("green-red")
    assert after < 0.6 * before
    before, after = apart("cividis")
    assert after > 0.9 * before


def test_the_view_shows_the_preview_and_the_session_stays(open_window, qtbot) -> None:
    window = open_window(
        Session(
            mesh="sample:torus", view="curvature", estimator=Method("rusinkiewicz2004"), fade=True
        )
    )
    before, session = pixels(window), window.controller.session
    click_menu(qtbot, window, "Curvature", "Seen with", "Deuteranopia")
    settled(qtbot, window)
    shown = pixels(window)
    assert np.abs(shown.astype(int) - before).max() > 50
    assert window.controller.session == session
    assert window.qactions["curvature.seen_with_deuteranopia"].isChecked()
    click_menu(qtbot, window, "Curvature", "Seen with", "All cones")
    settled(qtbot, window)
    np.testing.assert_array_equal(pixels(window), before)
