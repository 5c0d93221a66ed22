"""A monkey at the window: ``python -m tests.bench.monkey [--actions 2000] [--seed 1]``.

Random clicks, drags, keys and files on three meshes, one of them broken. Asked: no exception, the
window's thread never away from its events for more than 1 s, memory flat within 10 % after the
first 500 actions. While it computes a model may take hundreds of MiB for a while, and a large mesh
takes more than a small one: what stays is the growth from rest to rest on the first mesh.
"""

import argparse
import faulthandler
import os
import sys
import tempfile
import traceback
from pathlib import Path
from typing import Any

import psutil

from tests.screen import start_screen

_SETTLED = 500
_HUNG = 3600.0
_REST = 1000  # ms
_PATIENCE = 20  # of them


def main() -> None:
    """Let the monkey at it and print what it found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--actions", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--meshes", nargs=2, default=["sample:sphere", "sample:marble-face"])
    given = parser.parse_args()
    start_screen()
    with tempfile.TemporaryDirectory() as folder:
        os.environ["CURVELIGHT_CONFIG_DIR"] = folder
        broken = Path(folder) / "broken.ply"
        broken.write_bytes(b"ply\nformat ascii 1.0\nelement vertex 3\n")
        _run(given, [*given.meshes, str(broken)])


def _run(given: argparse.Namespace, meshes: list[str]) -> None:
    from qtpy.QtTest import QTest
    from qtpy.QtWidgets import QApplication

    from app.gui.window import Window
    from app.session import Session
    from tests.app.gui.monkey import Monkey, without_dialogs

    exceptions: list[str] = []
    sys.excepthook = lambda *what: exceptions.append("".join(traceback.format_exception(*what)))
    application = QApplication([])
    without_dialogs(setattr)
    window = Window(Session(mesh=meshes[0]))
    window.faults.told.connect(exceptions.append)
    window.show()
    window.start()
    while window.controller.outcome is None:
        QTest.qWait(10)
    # Where it hangs, if it hangs.
    faulthandler.dump_traceback_later(_HUNG, exit=True)
    monkey = Monkey(window, meshes, given.seed)
    monkey.act(min(given.actions, _SETTLED))
    settled = _at_rest(window, meshes[0])
    found = monkey.act(max(given.actions - _SETTLED, 0))
    stays = _at_rest(window, meshes[0]) / settled - 1.0
    faulthandler.cancel_dump_traceback_later()
    window.close()
    application.processEvents()
    print(f"actions                                  {len(found.done)}")
    print(f"exceptions                               {len(exceptions)}  (asked: 0)")
    print(
        f"longest away from events, s              {found.longest:.2f}  (asked: 1; {found.worst})"
    )
    if len(found.memory) > _SETTLED:
        growth = 100.0 * found.growth(_SETTLED)
        print(f"memory after the first {_SETTLED}, %            {growth:+.1f}  (asked: within 10)")
        print(f"the same from rest to rest, %            {100.0 * stays:+.1f}")
    print(f"memory at the end, MiB                   {found.memory[-1] / 2**20:.0f}")
    print("\n".join(exceptions[:5]))


def _at_rest(window: Any, mesh: str) -> int:
    """Return the resident bytes once the window shows a mesh and has nothing left to do."""
    from qtpy.QtTest import QTest

    controller = window.controller
    controller.cancel()
    controller.open(mesh)
    QTest.qWait(_REST)
    for _ in range(_PATIENCE):  # a model that takes longer is left
        if controller.worker.busy:
            QTest.qWait(_REST)
    controller.cancel()
    QTest.qWait(_REST)
    return int(psutil.Process().memory_info().rss)


if __name__ == "__main__":
    main()
