"""Forked workers are as good as fresh ones: they end alone, are told of, and leave nothing."""

import os
import signal
import sys
import threading
import time
from pathlib import Path

import pytest

from app.batch.nursery import Nursery
from app.batch.worker import WARM
from lutcore.errors import CancelledError
from lutcore.isolated import Child

pytestmark = pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="workers are forked on Linux alone"
)


@pytest.fixture(scope="module")
def nursery():
    nursery = Nursery({"CURVELIGHT_TEST_OF_WORKERS": "yes"})
    yield nursery
    nursery.stop()


def warm(worker):
    return worker.call(memoryview(WARM), "a worker", 60.0, lambda share, step: True)


def born(nursery):
    worker = Child(nursery.worker())
    assert warm(worker) == b'{"ready":true}'
    return worker


def parent(process):
    return int(Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[1])


def lives(process):
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def gone(process):
    end = time.monotonic() + 10.0
    while lives(process):
        assert time.monotonic() < end
        time.sleep(0.01)
    return True


def test_workers_come_from_one_process_and_get_its_variables(nursery):
    one, other = born(nursery), born(nursery)
    assert one.pid != other.pid
    assert parent(one.pid) == parent(other.pid) != os.getpid()
    assert os.getpgid(one.pid) == one.pid  # so that it is ended with its own children
    assert b"CURVELIGHT_TEST_OF_WORKERS=yes" in Path(f"/proc/{one.pid}/environ").read_bytes()
    one.stop()
    assert warm(other) == b'{"ready":true}'
    other.stop()


def test_a_second_worker_is_there_at_once(nursery):
    born(nursery).stop()
    start = time.process_time()
    worker = born(nursery)
    used = Path(f"/proc/{worker.pid}/stat").read_text().rpartition(")")[2].split()[11:13]
    assert sum(map(int, used)) / os.sysconf("SC_CLK_TCK") < 0.3  # importing takes .6
    assert time.process_time() - start < 0.3
    worker.stop()


def test_the_end_of_a_worker_is_told(nursery):
    worker = born(nursery)
    os.kill(worker.pid, signal.SIGSEGV)
    assert warm(worker) is None
    assert worker.last_words() == "crashed on it (SIGSEGV)"
    born(nursery).stop()


def test_what_a_worker_says_is_not_taken_for_its_answer(nursery):
    worker = born(nursery)
    assert worker.call(memoryview(b"no job"), "a worker", 60.0, lambda share, step: True) is None
    assert worker.last_words() == "failed on it (no reason given)"


def test_no_file_is_left_open(nursery):
    born(nursery).stop()
    before = len(os.listdir("/proc/self/fd"))
    for _ in range(3):
        born(nursery).stop()
    # The listener to a worker's errors closes its pipe when that ends, a moment later.
    end = time.monotonic() + 10.0
    while len(os.listdir("/proc/self/fd")) > before:
        assert time.monotonic() < end
        time.sleep(0.01)


def test_where_they_come_from_can_be_lost(nursery):
    worker = born(nursery)
    os.kill(parent(worker.pid), signal.SIGKILL)
    assert gone(worker.pid)
    assert worker.last_words() == "crashed on it (SIGKILL)"
    other = born(nursery)
    assert lives(other.pid)
    other.stop()


def test_they_outlive_the_thread_that_asked_and_not_the_nursery():
    nursery, found = Nursery({}), []
    asking = threading.Thread(target=lambda: found.append(born(nursery)))
    asking.start()
    asking.join()
    assert warm(found[0]) == b'{"ready":true}'
    nursery.stop()
    assert gone(found[0].pid)
    with pytest.raises(CancelledError):
        nursery.worker()


def test_what_cannot_be_imported_is_told(monkeypatch):
    monkeypatch.setattr("app.batch.nursery._CRADLE", "app.batch.no_such_module")
    nursery = Nursery({})
    with pytest.raises(Exception, match="no worker can be started"):
        nursery.worker()
    nursery.stop()
