"""Compare: two or more on one mesh."""

from functools import partial
from typing import TYPE_CHECKING

from app.gui.actions import Action

if TYPE_CHECKING:
    from app.gui.comparing import Comparing, Mode
    from app.gui.window import Window

ORDER = 5
_MODES: dict["Mode", tuple[str, str, str]] = {
    "side": ("Side by side", "Show what is compared in views of their own, with one camera", "F6"),
    "swipe": ("Swipe", "Show A left and B right of a divider on one surface", "F7"),
    "flicker": ("Flicker", "Show A and B in turn", "B"),
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
    comparing = window.comparing
    controller = window.controller

    def wiped() -> bool:
        return comparing.on and controller.session.wipe is not None

    def differs() -> bool:
        return comparing.on and controller.session.difference

    return [
        Action(
            "view.compare",
            "Compare",
            "Compare",
            "Compare what is shown with the plainest, or what was compared before",
            comparing.toggle,
            "F5",
            checked=lambda: comparing.on,
        ),
        *(
            Action(
                f"compare.{mode}",
                "Compare",
                text,
                doc,
                partial(_enter, comparing, mode),
                key,
                checked=partial(_is_on, comparing, mode),
            )
            for mode, (text, doc, key) in _MODES.items()
        ),
        Action(
            "compare.other",
            "Compare",
            "Show the other",
            "Show B instead of A, or A instead of B, and stay there",
            comparing.turn,
            "N",
        ),
        Action(
            "compare.swap",
            "Compare",
            "Swap A and B",
            "Exchange the first and the second: differences are from the first",
            comparing.swap,
            "X",
            enabled=lambda: comparing.on,
        ),
        Action(
            "compare.difference",
            "Compare",
            "Difference",
            "Show on the surface how far the others are from A",
            lambda: comparing.show_difference(not differs()),
            "D",
            checked=differs,
        ),
        Action(
            "compare.left",
            "Compare",
            "Divider to the left",
            "Move the divider to the left",
            partial(comparing.step, -1),
            ",",
            enabled=wiped,
        ),
        Action(
            "compare.right",
            "Compare",
            "Divider to the right",
            "Move the divider to the right",
            partial(comparing.step, 1),
            ".",
            enabled=wiped,
        ),
        Action(
            "compare.worst",
            "Compare",
            "Go to the worst point",
            "Turn the camera to the point where the difference is largest",
            comparing.face_worst_of_all,
            "Shift+D",
            enabled=differs,
        ),
    ]


def _enter(comparing: "Comparing", mode: "Mode") -> None:
    # The key that started the flicker stops it.
    running = mode == "flicker" and comparing.on and comparing.flicker.running
    comparing.enter("swipe" if running else mode)


def _is_on(comparing: "Comparing", mode: "Mode") -> bool:
    return comparing.on and comparing.mode == mode
