"""A window that is open for hours must not grow."""

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
