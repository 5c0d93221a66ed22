"""Submenus of what can be opened at once: files that were opened before, and the samples."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from qtpy.QtWidgets import QMenu

from app.gui.controller import SESSION_SUFFIX
from app.gui.unsaved import may_leave
from app.samples import PREFIX, names, sample

if TYPE_CHECKING:
    from app.gui.window import Window

RECENT, SAMPLES = "File/Open recent", "File/Sample meshes"


def add_open_menus(window: "Window") -> None:
    """Put both below the first entry of the File menu.

    Parameters
    ----------
    window : Window
        Whose menus are there.
    """
    file = window.menus["File"]
    below = file.actions()[1]
    for title, fill in ((RECENT, _fill_recent), (SAMPLES, _fill_samples)):
        menu = window.menus[title] = QMenu(title.partition("/")[2], file)
        menu.setToolTipsVisible(True)
        # When it is opened, as the list changes and samples are read from a file.
        menu.aboutToShow.connect(partial(fill, window, menu))
        file.insertMenu(below, menu)


def _fill_recent(window: "Window", menu: QMenu) -> None:
    menu.clear()
    for file in window.settings.recent:
        entry = menu.addAction(file if file.startswith(PREFIX) else Path(file).name)
        entry.setToolTip(file)
        entry.setStatusTip(file)
        entry.triggered.connect(partial(_open, window, file))
    if menu.isEmpty():
        menu.addAction("No file was opened yet").setEnabled(False)


def _fill_samples(window: "Window", menu: QMenu) -> None:
    if not menu.isEmpty():
        return
    for name in names():
        entry = menu.addAction(name)
        entry.setToolTip(sample(name).summary)
        entry.setStatusTip(sample(name).summary)
        entry.triggered.connect(partial(_open, window, PREFIX + name))


def _open(window: "Window", file: str, _checked: bool = False) -> None:
    if not file.lower().endswith(SESSION_SUFFIX) or may_leave(window):
        window.controller.open(file)
