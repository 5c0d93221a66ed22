"""Kill it at any moment: the next start offers the session, and no file is half written."""

import os
import signal
import subprocess
import sys
import time

import numpy as np
from qtpy.QtCore import Qt

from app.gui.document import Document
from app.gui.recovery import Recovery, lost
from app.session import Session, read
from tests.app.gui.conftest import settled

_CHILD = """
import random, sys, time
from pathlib import Path
from app.gui.document import Document
from app.gui.recovery import Recovery
from app.session import Session
document = Document(Session(mesh="sample:sphere"))
recovery = Recovery(document, Path(sys.argv[1]))
print("ready", flush=True)
step = 0
while True:
    step += 1
    document.change(f"exposure {step}", exposure=1.0 + 0.001 * step)
    recovery.keep()
"""


def test_what_is_killed_is_offered_whole(config) -> None:
    random = np.random.default_rng(4)
    for kill in range(4):
        command = [sys.executable, "-c", _CHILD, str(config)]
        with subprocess.Popen(command, stdout=subprocess.PIPE) as child:
            assert child.stdout.readline() == b"ready\n"
            while len(list((config / "unfinished").glob(f"{child.pid}-*"))) == 0:
                time.sleep(0.01)
            time.sleep(0.2 * random.random())
            child.send_signal(signal.SIGKILL)
        found = lost(config)
        assert len(found) == kill + 1
        assert all(one.session.exposure > 1.0 for one in found)
        assert all(read(one.path) == one.session for one in found)


def test_a_living_windows_session_is_nobody_elses(config) -> None:
    document = Document(Session(mesh="sample:sphere"))
    recovery = Recovery(document, config)
    document.change("exposure", exposure=2.0)
    recovery.keep()
    assert recovery.path.exists()
    assert lost(config) == []
    recovery.forget()
    assert not recovery.path.exists()


def test_the_next_window_offers_it_and_a_click_restores_it(open_window, qtbot, config) -> None:
    folder = config / "unfinished"
    folder.mkdir(parents=True)
    ended = subprocess.run(
        [sys.executable, "-c", "import os; print(os.getpid())"], capture_output=True, check=True
    )
    kept = Document(Session(mesh="sample:saddle"))
    kept.change("exposure", exposure=3.0)
    path = Recovery(kept, config).path
    Recovery.keep(recovery := Recovery(kept, config))
    gone = folder / f"{int(ended.stdout)}-1.json"
    os.replace(recovery.path, gone)
    (folder / f"{int(ended.stdout)}-2.json").write_bytes(b'{"mesh": ')
    assert path.parent == folder
    window = open_window(Session(mesh="sample:sphere"))
    window.offer_recovery()
    assert "sample:saddle" in window.banner.label.text()
    qtbot.mouseClick(window.banner.button, Qt.MouseButton.LeftButton)
    settled(qtbot, window)
    assert window.controller.session.exposure == 3.0
    assert window.controller.session.mesh == "sample:saddle"
    assert not gone.exists()
    assert window.recovery.path.exists()
    window.close()
    assert list(folder.iterdir()) == []
