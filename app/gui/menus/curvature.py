"""Curvature: which quantity is shown, and in which colours."""

from functools import partial
from typing import TYPE_CHECKING, Any, get_args

from app.colormaps import PAPER
from app.gui.actions import Action
from app.gui.showing import COLORMAPS, PERCENTILES, SWITCHES, show_quantity
from app.gui.vision import KINDS
from app.quantities import QUANTITIES
from app.session import Quantity, Session

if TYPE_CHECKING:
    from app.gui.controller import Controller
    from app.gui.window import Window

ORDER = 3


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
    return [
        *(_quantity(controller, name) for name in get_args(Quantity)),
        *(_colormap(controller, name, text) for name, text in COLORMAPS.items()),
        *(_switch(controller, name, *words) for name, words in SWITCHES.items()),
        *(_vision(window, kind) for kind in ("", *KINDS)),
        *(_percentiles(controller, ends) for ends in PERCENTILES),
        Action(
            "curvature.automatic_range",
            "Curvature/Range",
            "Automatic",
            "Let the range follow the values",
            partial(_change, controller, "automatic range", range=None),
            enabled=lambda: controller.session.range is not None,
        ),
    ]


def _change(controller: "Controller", label: str, **fields: Any) -> None:
    controller.change(label, **fields)


def _quantity(controller: "Controller", name: str) -> Action:
    text = "All" if name == "all" else _capital(QUANTITIES[name].name)
    return Action(
        f"curvature.show_{name}",
        "Curvature/Quantity",
        text,
        "Show all quantities side by side" if name == "all" else f"Show {QUANTITIES[name].name}",
        partial(show_quantity, controller, name),
        checked=partial(_is, controller, "quantity", name),
    )


def _colormap(controller: "Controller", name: str, text: str) -> Action:
    value = None if name == PAPER else name
    return Action(
        f"curvature.colormap_{name}",
        "Curvature/Colour map",
        _capital(text),
        f"Show values in the colours {text}",
        partial(_change, controller, "colour map", colormap=value),
        checked=partial(_is, controller, "colormap", value),
    )


def _switch(controller: "Controller", name: str, text: str, doc: str) -> Action:
    def turn() -> None:
        _change(controller, text.lower(), **{name: not getattr(controller.session, name)})

    return Action(
        f"curvature.{name}",
        "Curvature",
        text,
        doc,
        turn,
        checked=partial(_is, controller, name, True),
    )


def _vision(window: "Window", kind: str) -> Action:
    return Action(
        f"curvature.seen_with_{kind or 'all_cones'}",
        "Curvature/Seen with",
        _capital(kind) if kind else "All cones",
        f"Preview the colour map as seen with {kind}" if kind else "Show the colours as they are",
        partial(window.vision.choose, kind),
        checked=lambda: window.vision.kind == kind,
    )


def _percentiles(controller: "Controller", ends: tuple[float, float]) -> Action:
    low, high = ends
    text = f"{low:g} to {high:g} %"

    def is_on() -> bool:
        session: Session = controller.session
        return session.range is None and session.percentiles == ends

    return Action(
        f"curvature.percentiles_{low:g}_{high:g}",
        "Curvature/Range",
        f"Percentiles {text}",
        f"Show the values from percentile {low:g} to percentile {high:g}",
        partial(_change, controller, "percentiles", percentiles=ends, range=None),
        checked=is_on,
    )


def _is(controller: "Controller", field: str, value: object) -> bool:
    return bool(getattr(controller.session, field) == value)


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
