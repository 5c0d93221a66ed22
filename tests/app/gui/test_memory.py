"""A window that is open for hours must not grow."""

import subprocess
import sys
import threading

import numpy as np
import psutil
import pytest

from app.gui import worker
from app.gui.memory import give_back
from app.gui.worker import Worker
from lutcore.compiling import elsewhere


def test_its_process_has_a_child_compile(window):
    # What compiling leaves behind made it grow by a third in 2000 actions.
    assert elsewhere()


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the allocator does so by itself")
def test_freed_memory_goes_back_to_the_system():
    resident = psutil.Process().memory_info
    # Small enough for the heap; a few that stay keep the end of it from being free.
    held = [np.ones(8000) for _ in range(2000)]
    full = resident().rss
    held = held[::100]
    give_back()
    assert full - resident().rss > 64 * 2**20


_HEAPS = """
import numpy as np, psutil
from app.gui.memory import keep_large_apart
keep_large_apart()
resident = psutil.Process().memory_info
np.ones(2**21)  # once one so large was freed, glibc takes the next from its heap
large = [(np.ones(2**18), np.ones(2**10)) for _ in range(40)]
full = resident().rss
small = [one for _, one in large]
del large
print(full - resident().rss)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the allocator does so by itself")
def test_a_large_array_is_gone_when_it_is_freed():
    done = subprocess.run(
        [sys.executable, "-c", _HEAPS], capture_output=True, text=True, check=True
    )
    # 40 arrays of 2 MiB, with small ones in between that stay.
    assert int(done.stdout) > 60 * 2**20


def test_a_worker_that_rests_gives_back_once_what_its_jobs_freed(monkeypatch):
    given = []
    given_back, done = threading.Event(), threading.Event()
    monkeypatch.setattr(
        worker, "give_back", lambda: (given.append(done.is_set()), given_back.set())
    )
    monkeypatch.setattr(Worker, "_REST", 0.01)
    one = Worker(lambda call: call(), lambda _: None)
    one.submit("job", lambda _: done.set(), lambda _: None, lambda _: None)
    assert given_back.wait(5.0)
    one.close()
    assert given == [True]


def test_a_worker_at_rest_does_what_was_left_for_then_and_jobs_go_first(monkeypatch):
    monkeypatch.setattr(worker, "give_back", lambda: None)
    monkeypatch.setattr(Worker, "_REST", 0.01)
    done, ended = [], threading.Event()

    def job(name):
        return lambda _: done.append(name)

    def first():
        done.append("first step")
        one.submit("job", job("job"), lambda _: None, lambda _: None)
        raise RuntimeError("nobody hears of it")

    steps = (first, lambda: done.append("second step"), ended.set)
    one = Worker(lambda call: call(), lambda _: None, steps)
    assert not ended.wait(0.1)  # not before the first job: what a person waits for
    one.submit("job", job("begun"), lambda _: None, lambda _: None)
    assert ended.wait(5.0)
    one.close()
    assert done == ["begun", "first step", "job", "second step"]


_CHILD = """
import subprocess
import sys
from qtpy.QtCore import QTimer
from qtpy.QtWidgets import QApplication
application = QApplication([])
from app.gui.window import Window
from app.session import Session
window = Window(Session(mesh="sample:sphere"))
later = ["colour", "matplotlib", "plugins.curvature.vtk", "plugins.shading.wrap"]
asked = [name for name in later if name in sys.modules]
window.controller.shown.connect(lambda _: asked.extend(n for n in later if n in sys.modules))
timer = QTimer()
timer.timeout.connect(lambda: all(n in sys.modules for n in later) and application.quit())
timer.start(20)
window.show()
QTimer.singleShot(0, window.start)
QTimer.singleShot(240_000, application.quit)
application.exec()
print(asked, [name for name in later if name not in sys.modules])
"""


def test_what_is_used_later_is_loaded_once_the_first_picture_stands():
    # What is loaded at its first use makes a window grow after an hour, and a person wait.
    done = subprocess.run(
        [sys.executable, "-c", _CHILD], capture_output=True, text=True, timeout=300, check=True
    )
    assert done.stdout.splitlines()[-1] == "[] []"
