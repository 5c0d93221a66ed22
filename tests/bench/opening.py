"""What a window's start takes: from the command to its mesh on the screen, and to its picture.

``python -m tests.bench.opening [--mesh sample:marble-face] [--json]``; on a virtual screen. Asked:
usable within 2 s on a machine that has compiled before. From its mesh on, in grey, it can be turned
and answers; the picture follows.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time

from tests.screen import start_screen

_RUNS = 4  # the first may compile, and reads files that the others find in memory
_CODE = """
import sys, time
from app.gui import main
from app.gui.window import Window

def tell(what):
    print(what, time.time(), flush=True)

def follow(window):
    controller = window.controller
    controller.previewed.connect(lambda _: tell("mesh"))
    controller.shown.connect(lambda _: window.canvas.drew.connect(lambda _: end(window)))

def end(window):
    tell("picture")
    window.close()

make = Window.__init__
def made(self, *given):
    make(self, *given)
    follow(self)

Window.__init__ = made
main.run(sys.argv[1])
"""


def seconds(mesh: str) -> dict[str, float]:
    """Return the least seconds from the command to the mesh and to the picture, of some runs."""
    found = []
    for _ in range(_RUNS):
        begun = time.time()
        done = subprocess.run(
            [sys.executable, "-c", _CODE, mesh], capture_output=True, check=True, text=True
        )
        told = dict(line.split() for line in reversed(done.stdout.splitlines()))
        found.append({what: float(at) - begun for what, at in told.items()})
    return {what: min(one[what] for one in found[1:]) for what in ("mesh", "picture")}


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mesh", default="sample:marble-face")
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    start_screen()
    with tempfile.TemporaryDirectory() as folder:
        os.environ["CURVELIGHT_CONFIG_DIR"] = folder
        found = seconds(given.mesh)
    if given.json:
        print(json.dumps(found, indent=2))
        return
    print(f"mesh on the screen, s                    {found['mesh']:.2f}  (asked: 2)")
    print(f"its picture, s                           {found['picture']:.2f}")


if __name__ == "__main__":
    main()
