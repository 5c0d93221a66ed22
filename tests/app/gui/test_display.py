"""The window's thread never waits for compiled code."""

import threading

import numpy as np
from numba.core.compiler_lock import global_compiler_lock

from app.gui.display import encoded
from lutcore.color import srgb_encode
from tests.app.gui.conftest import settled


def test_colours_are_encoded_as_those_of_pictures() -> None:
    linear = np.random.default_rng(1).uniform(-0.1, 1.2, (50, 3))
    # Rounding of the power function, in two libraries.
    np.testing.assert_allclose(encoded(linear), srgb_encode(linear), rtol=0.0, atol=1e-12)


def test_every_dock_opens_while_something_is_compiled(window, qtbot) -> None:
    held, free = threading.Event(), threading.Event()

    def compile_for_long() -> None:
        with global_compiler_lock:
            held.set()
            free.wait(120.0)

    thread = threading.Thread(target=compile_for_long)
    thread.start()
    assert held.wait(60.0)
    unblock = threading.Timer(100.0, free.set)  # so that a failure ends, too
    unblock.start()
    try:
        for dock in window.docks.values():
            dock.show()
            dock.raise_()
            dock.fill()
            qtbot.wait(30)
        for name in ("view.curvature", "view.transparent", "curvature.seen_with_deuteranopia"):
            window.act(window.actions_[name])
            qtbot.wait(30)
        assert not free.is_set(), "the window waited for the compiler"
    finally:
        free.set()
        unblock.cancel()
        thread.join()
    settled(qtbot, window)
