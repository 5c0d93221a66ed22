"""View: what is shown, and from where."""

from functools import partial
from typing import TYPE_CHECKING

from app.camera import VIEWS
from app.gui import orbit
from app.gui.actions import Action
from app.gui.pixel_path import CHOICES
from app.session import View

if TYPE_CHECKING:
    from app.gui.window import Window

ORDER = 2
_KEYS = {
    "front": "1",
    "right": "3",
    "top": "7",
    "back": "Ctrl+1",
    "left": "Ctrl+3",
    "bottom": "Ctrl+7",
}
_SHOWN: dict[View, tuple[str, str, str]] = {
    "shade": ("Shading", "Show the mesh as a translucent material", "F2"),
    "curvature": ("Curvature", "Show the curvature as colours", "F3"),
    "figure": ("Figure", "Show shading and curvature side by side, as in the paper", "F4"),
}


def actions(window: "Window") -> list[Action]:
    """Return the actions of this menu.

    Parameters
    ----------
    window : Window
        What they act on.

    Returns
    -------
    list of Action
        In the order of the menu.
    """
    controller = window.controller
    shown = [
        Action(
            f"view.{view}",
            "View",
            text,
            doc,
            partial(controller.change, "view", view=view),  # type: ignore[arg-type]
            key,
            checked=partial(_is_shown, window, view),
        )
        for view, (text, doc, key) in _SHOWN.items()
    ]
    cameras = [
        Action(
            f"view.from_{name}",
            "View/Camera",
            name.capitalize(),
            f"Look from the {name}" if name != "oblique" else "Look from aside and above",
            partial(controller.look, name),
            _KEYS.get(name, ""),
        )
        for name in VIEWS
    ]
    return [
        *shown,
        Action(
            "view.reset",
            "View",
            "Reset camera",
            "Show the whole mesh from its best side",
            partial(controller.look, "auto"),
            "Return",
        ),
        Action(
            "view.parallel",
            "View",
            "Parallel projection",
            "Switch between parallel and perspective projection",
            partial(_parallel, window),
            "5",
            checked=partial(_is_parallel, window),
        ),
        *cameras,
        Action(
            "view.transparent",
            "View",
            "Transparent background",
            "Have nothing behind the mesh: pictures that are saved or copied get an alpha channel",
            window.background.toggle,
            checked=lambda: window.background.transparent,
        ),
        Action(
            "view.background",
            "View",
            "Background colour\N{HORIZONTAL ELLIPSIS}",
            "Choose what colour lies behind the mesh",
            partial(window.background.choose, window),
        ),
        *_paths(window),
    ]


def _paths(window: "Window") -> list[Action]:
    path = window.pixel_path
    return [
        Action(
            f"view.shade_{choice}",
            "View/Compute shading",
            text,
            doc,
            partial(path.choose, choice),
            checked=lambda choice=choice: path.choice == choice,  # type: ignore[misc]
        )
        for choice, (text, doc) in CHOICES.items()
    ]


def _is_shown(window: "Window", view: View) -> bool:
    return window.controller.session.view == view


def _is_parallel(window: "Window") -> bool:
    camera = window.canvas.camera
    return camera is not None and camera.height is not None


def _parallel(window: "Window") -> None:
    camera = window.canvas.camera
    if camera is not None:
        window.controller.look(orbit.parallel(camera, camera.height is None))
