"""Shading: the model, the material's colours, and the lights."""

from functools import partial
from typing import TYPE_CHECKING

from app.gui.actions import Action
from app.gui.lights import KINDS

if TYPE_CHECKING:
    from app.gui.window import Window

ORDER = 4


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
    controller, lights = window.controller, window.lights
    added = [
        Action(
            f"lights.add_{kind}",
            "Shading/Add light",
            kind.capitalize(),
            f"Add a {kind} light and choose it",
            partial(lights.add, kind),
        )
        for kind in KINDS
    ]
    return [
        Action(
            "shading.auto_exposure",
            "Shading",
            "Automatic exposure",
            "Bring the brightest parts near white; off keeps the exposure as it is now",
            partial(_auto_exposure, window),
            checked=lambda: controller.session.exposure is None,
        ),
        Action(
            "shading.albedo",
            "Shading",
            "Colours of the file",
            "Multiply the light by the vertex colours or the texture of the file",
            partial(_albedo, window),
            checked=lambda: controller.session.albedo,
        ),
        Action(
            "shading.shadows",
            "Shading",
            "Cast shadows",
            "Let the surface cast shadows on itself",
            partial(_shadows, window),
            checked=lambda: controller.session.casts != "off",
        ),
        *added,
        Action(
            "lights.remove",
            "Shading",
            "Remove light",
            "Take the chosen light away",
            lights.remove,
            enabled=lambda: lights.light is not None,
        ),
    ]


def _auto_exposure(window: "Window") -> None:
    controller = window.controller
    now = controller.outcome.composition.exposure if controller.outcome else None
    kept = None if controller.session.exposure is not None else now or 1.0
    controller.change("exposure", exposure=kept)


def _albedo(window: "Window") -> None:
    controller = window.controller
    controller.change("albedo", albedo=not controller.session.albedo)


def _shadows(window: "Window") -> None:
    controller = window.controller
    shadows = "on" if controller.session.casts == "off" else "off"
    controller.change("shadows", shadows=shadows)
