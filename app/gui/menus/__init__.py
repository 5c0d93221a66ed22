"""The actions: each module of this package declares some.

A module has `ORDER` among the modules and ``actions(window) -> list[Action]``.
"""

from importlib import import_module
from pkgutil import iter_modules
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from app.gui.window import Window


def add_all(window: "Window") -> None:
    """Declare all actions of a window.

    Parameters
    ----------
    window : Window
        Has its controller, canvas and docks.
    """
    modules = [import_module(f"app.gui.menus.{one.name}") for one in iter_modules(__path__)]
    for module in sorted(modules, key=lambda module: int(module.ORDER)):
        window.actions_.add(*module.actions(window))
