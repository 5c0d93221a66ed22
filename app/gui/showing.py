"""Which quantity is shown, and in which colours. Knows no Qt."""

from typing import Any

from app.colormaps import PAPER
from app.gui.controller import Controller
from app.quantities import QUANTITIES
from app.session import Method

COLORMAPS = {
    PAPER: "green to red (the paper's)",
    "cividis": "cividis (colour-blind-safe)",
    "viridis": "viridis",
    "magma": "magma",
    "coolwarm": "coolwarm (diverging)",
    "PuOr": "purple to orange (diverging)",
    "gray": "grey",
}
"""Maps that are offered, with what they are called."""
SWITCHES = {
    "symmetric": ("Symmetric", "Make the range as wide below zero as above"),
    "flip": ("Flip colours", "Turn the colour map round"),
    "fade": ("Fade below error", "Grey where neither |k1| nor |k2| exceeds its error"),
    "strokes": (
        "Principal directions",
        "Draw the principal directions as strokes: k1's in black, k2's in white",
    ),
}
"""What is on or off: the session's field, what it is called, what it does."""
PERCENTILES = ((5.0, 95.0), (1.0, 99.0), (0.0, 100.0))
"""Ends of the automatic range that are offered."""
# Of different families, and quick.
_PEERS = tuple(map(Method, ("auto", "rusinkiewicz2004", "corrected-curvature")))


def show_quantity(controller: Controller, name: str) -> None:
    """Show a quantity as colours.

    A range that was chosen goes with the old quantity, but for a locked one of the same unit. The
    shading, which would hide it, gives way to the curvature.

    Parameters
    ----------
    controller : Controller
        Of the window.
    name : str
        A key of `QUANTITIES`, or ``all``.
    """
    session = controller.session
    fields: dict[str, Any] = {"quantity": name}
    old, new = QUANTITIES.get(session.quantity), QUANTITIES.get(name)
    alike = old is not None and new is not None and old.power == new.power
    if name != session.quantity and not (controller.range_locked and alike):
        fields["range"] = None
        controller.range_locked = False
    if session.view == "shade" or (name == "all" and session.view != "curvature"):
        fields["view"] = "curvature"
    if name == "disagreement" and not session.peers:
        fields["peers"] = _PEERS
    controller.change(f"show {name.replace('_', ' ')}", **fields)
