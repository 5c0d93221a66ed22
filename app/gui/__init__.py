"""The window. Models and the controller know no Qt; `canvas`, `window`, `docks` and `menus` do."""

import os

# qtpy would take another binding that happens to be installed.
os.environ.setdefault("QT_API", "pyside6")
