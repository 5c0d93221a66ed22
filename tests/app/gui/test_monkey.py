"""A short run of the monkey; ``python -m tests.bench.monkey`` is the long one."""

from tests.app.gui.conftest import settled
from tests.app.gui.monkey import Monkey, without_dialogs

# No action may keep the window from its events for long; the limit of the long run is 1 s, on an
# idle machine. Here others may be at work and code may be compiled.
_LONGEST = 5.0


def test_nothing_that_a_monkey_does_breaks_the_window(window, qtbot, tmp_path, monkeypatch) -> None:
    without_dialogs(monkeypatch.setattr)
    broken = tmp_path / "broken.ply"
    broken.write_bytes(b"ply\nformat ascii 1.0\nelement vertex 3\n")
    faults: list[str] = []
    window.faults.told.connect(faults.append)
    monkey = Monkey(window, ["sample:sphere", "sample:saddle", str(broken)], seed=1)
    with qtbot.captureExceptions() as exceptions:
        found = monkey.act(150)
        window.controller.worker.cancel()
        settled(qtbot, window)
    assert exceptions == [], found.done[-5:]
    assert found.longest < _LONGEST, found.worst
    assert faults == []
