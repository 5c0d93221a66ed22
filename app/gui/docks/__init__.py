"""The docks: each module of this package is one.

A module has `TITLE`, `AREA` (left, right or bottom), `ORDER` in its area, `SHOWN` at first, and
``build(window) -> QWidget``, called when the dock is first seen.
"""

from importlib import import_module
from pkgutil import iter_modules
from typing import TYPE_CHECKING

from qtpy.QtCore import QSize, Qt
from qtpy.QtWidgets import QDockWidget, QScrollArea, QTabWidget, QWidget

if TYPE_CHECKING:
    from app.gui.window import Window

_AREAS = {
    "left": Qt.DockWidgetArea.LeftDockWidgetArea,
    "right": Qt.DockWidgetArea.RightDockWidgetArea,
    "bottom": Qt.DockWidgetArea.BottomDockWidgetArea,
}
_SHARE = 0.4


class _Scroll(QScrollArea):
    """Shows what there is room for; a dock at the bottom leaves most of the height to the view."""

    def __init__(self, dock: "Dock") -> None:
        super().__init__(dock)
        self._low = dock.area == "bottom"

    def sizeHint(self) -> QSize:  # noqa: N802
        """Return what the content wants, bounded at the bottom."""
        hint = super().sizeHint()
        most = round(_SHARE * self.window().height())
        return QSize(hint.width(), min(hint.height(), most)) if self._low else hint


class Dock(QDockWidget):
    """A dock whose content is made when it is first seen.

    Parameters
    ----------
    window : Window
        Its window.
    name : str
        The module's name in this package.
    """

    def __init__(self, window: "Window", name: str) -> None:
        self._module = import_module(f"app.gui.docks.{name}")
        super().__init__(self._module.TITLE, window)
        self.setObjectName(f"dock.{name}")
        self.setAccessibleName(self._module.TITLE)
        self.name = name
        self.area: str = self._module.AREA
        self.order: int = self._module.ORDER
        self.shown: bool = self._module.SHOWN
        self._window = window
        self.content: QWidget | None = None
        self.visibilityChanged.connect(self._on_visibility)

    def fill(self) -> QWidget:
        """Make the content, if it is not there yet.

        Returns
        -------
        QWidget
            The content.
        """
        if self.content is None:
            self.content = self._module.build(self._window)
            scroll = _Scroll(self)
            scroll.setAccessibleName(self._module.TITLE)
            scroll.setWidgetResizable(True)
            scroll.setFrameShape(QScrollArea.Shape.NoFrame)
            scroll.setWidget(self.content)
            self.setWidget(scroll)
        return self.content

    def _on_visibility(self, visible: bool) -> None:
        if visible:
            self.fill()
        if self.content is not None:
            # Behind another tab Qt leaves it shown, out of sight: it would go on computing, and
            # marking what is in the view.
            self.content.setVisible(visible)


def add_all(window: "Window") -> dict[str, Dock]:
    """Put the docks around a window's view.

    Parameters
    ----------
    window : Window
        Has its controller and its canvas.

    Returns
    -------
    dict of str to Dock
        By name.
    """
    window.setTabPosition(Qt.DockWidgetArea.AllDockWidgetAreas, QTabWidget.TabPosition.North)
    first: dict[str, Dock] = {}
    found = [Dock(window, one.name) for one in iter_modules(__path__)]
    made = {dock.name: dock for dock in sorted(found, key=lambda dock: (dock.area, dock.order))}
    for dock in made.values():
        window.addDockWidget(_AREAS[dock.area], dock)
        if dock.area in first:
            window.tabifyDockWidget(first[dock.area], dock)
        first.setdefault(dock.area, dock)
        dock.setVisible(dock.shown)
    for dock in first.values():
        dock.raise_()
    return made
