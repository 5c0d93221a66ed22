"""The mesh is seen before the packages that take long to load are."""

import subprocess
import sys

_CHILD = """
import sys
from qtpy.QtCore import QTimer
from qtpy.QtWidgets import QApplication
application = QApplication([])
from app.gui.window import Window
window = Window()
# Of scipy only what tells the parts of a mesh apart is loaded, to frame the largest.
heavy = ["numba", "scipy.spatial", "scipy.special", "matplotlib", "pyvista", "trimesh", "colour"]

def drew(seconds):
    if window.canvas.drawn:
        loaded = [name for name in heavy if name in sys.modules]
        print("grey" if window.controller.outcome is None else "shaded", *loaded, flush=True)
        application.quit()

window.canvas.drew.connect(drew)
window.show()
QTimer.singleShot(0, window.start)
QTimer.singleShot(60_000, application.quit)
application.exec()
"""


def test_the_mesh_is_there_in_grey_before_heavy_packages() -> None:
    done = subprocess.run(
        [sys.executable, "-c", _CHILD], capture_output=True, text=True, timeout=120, check=True
    )
    assert done.stdout.splitlines() == ["grey"]
