"""What a window does to compare: swipe, flicker, side by side, and the way to the worst point."""

from typing import Literal

import numpy as np

from app.gui import versus
from app.gui.canvas import Canvas
from app.gui.controller import Controller, Outcome
from app.gui.facing import facing
from app.gui.flicker import Flicker
from app.gui.letters import Letters
from app.gui.pins import Pins
from app.gui.swipe import Swipe
from app.scene import Surface
from app.session import ComparedBy, Directional, Method, Session

Mode = Literal["side", "swipe", "flicker"]
_STEP = 0.02
# Seen on both ends of the map of differences.
_WORST = (0.15, 0.95, 0.55)


class Comparing:
    """Comparison of two, three or four in one view.

    Parameters
    ----------
    controller : Controller
        Of the window.
    canvas : Canvas
        Its view.
    """

    def __init__(self, controller: Controller, canvas: Canvas) -> None:
        self._controller, self._canvas = controller, canvas
        self.swipe = Swipe(canvas)
        self.letters = Letters(canvas, self.swipe)
        self.flicker = Flicker(self.swipe)
        self._pins = Pins(canvas, _WORST)
        self.swipe.released.connect(self._on_released)
        self.flicker.changed.connect(self.letters.follow)
        controller.shown.connect(self._on_shown)
        controller.document.changed.connect(self._on_changed)

    @property
    def mode(self) -> Mode:
        """How the compared are shown, or would be."""
        if self._session.wipe is None:
            return "side"
        return "flicker" if self.flicker.on else "swipe"

    @property
    def on(self) -> bool:
        """Whether something is compared."""
        return self._session.view == "compare"

    def enter(self, mode: Mode) -> None:
        """Compare in one of the three ways.

        Parameters
        ----------
        mode : str
            Of `Mode`.
        """
        session = self._session
        changes = versus.entered(session, wiped=mode != "side")
        if len(session.compared) > len(changes["compared"]):
            self._controller.noted.emit(f"a {mode} is between two: A and B")
        self._controller.change("comparison", **changes)
        if mode == "flicker":
            self.flicker.start()
        else:
            self.flicker.stop()

    def toggle(self) -> None:
        """Enter the comparison as it was left, or go back to shading."""
        if self.on:
            self._controller.change("view", view="shade")
        else:
            self._controller.change("comparison", **versus.entered(self._session))

    def turn(self) -> None:
        """Show the other one of two, by hand."""
        if not self.flicker.on or not self.on:
            self.enter("flicker")
        self.flicker.turn_by_hand()

    def compare_by(self, by: ComparedBy) -> None:
        """Compare things of another kind.

        Parameters
        ----------
        by : str
            See `Session.compared_by`.
        """
        if by != self._session.compared_by:
            self._controller.change("compared by", **versus.turned_to(self._session, by))

    def put(self, index: int, method: Method | None) -> None:
        """Put something in one place of the comparison.

        Parameters
        ----------
        index : int
            From 0, for A.
        method : Method or None
            What; None leaves it out.
        """
        changes = versus.with_side(self._session, index, method)
        self._controller.change(f"compared {versus.LETTERS[index]}", **changes)

    def swap(self) -> None:
        """Exchange A and B."""
        self._controller.change("swap A and B", **versus.swapped(self._session))

    def show_difference(self, on: bool) -> None:
        """Show the map of differences, or leave it out.

        Parameters
        ----------
        on : bool
            Whether to.
        """
        entered = {} if self.on else versus.entered(self._session)
        self._controller.change("difference", difference=on, **entered)

    def step(self, steps: int) -> None:
        """Move the divider by the keyboard.

        Parameters
        ----------
        steps : int
            To the right.
        """
        at = self._session.wipe
        if at is not None:
            self._on_released(min(max(at + steps * _STEP, 0.0), 1.0))

    def face_worst(self, label: str) -> None:
        """Turn the camera to the point where a difference is largest.

        Parameters
        ----------
        label : str
            A key of `Composition.difference`.
        """
        outcome, camera = self._controller.outcome, self._canvas.camera
        found = None if outcome is None else outcome.composition.difference
        if outcome is None or camera is None or not found or label not in found:
            return
        worst = found[label]
        contents = [one.content for one in outcome.composition.panels]
        normals = next(one.normals for one in contents if isinstance(one, Surface))
        place = np.asarray(worst["position"])
        self._controller.look(facing(camera, place, normals[worst["vertex"]]))
        lights = outcome.session.lights
        turn = any(isinstance(one, Directional) and one.frame == "camera" for one in lights)
        if turn and outcome.session.compared_by != "estimator":
            self._controller.noted.emit(
                "lights turn with the camera: another point may be the worst now"
            )

    def face_worst_of_all(self) -> None:
        """Turn the camera to the point where the largest of the differences is."""
        outcome = self._controller.outcome
        found = None if outcome is None else outcome.composition.difference
        if found:
            self.face_worst(max(found, key=lambda label: found[label]["max"]))

    @property
    def _session(self) -> Session:
        return self._controller.session

    def _on_released(self, at: float) -> None:
        self._controller.change("divider", wipe=round(at, 4))

    def _on_shown(self, outcome: Outcome) -> None:
        found = outcome.composition.difference or {}
        x_y_z = [tuple(one["position"]) for one in found.values()]
        self._pins.show(x_y_z)  # type: ignore[arg-type]  # three each

    def _on_changed(self, session: Session, before: Session) -> None:
        if session.view != "compare" or session.wipe is None:
            self.flicker.stop()
