"""The session's lights as a list to choose from and to change. Knows no Qt."""

from collections.abc import Callable
from typing import Any

import numpy as np
from msgspec.structs import replace
from psygnal import Signal

from app.camera import axes
from app.gui import orbit
from app.gui.aiming import kept_in, seen_by, turned
from app.gui.controller import Controller
from app.gui.display import encoded
from app.session import Camera, Cone, Directional, Frame, Point, Session, Vector

AnyLight = Directional | Point | Cone
KINDS = ("directional", "point", "cone")
_KINDS: dict[type, str] = {Directional: "directional", Point: "point", Cone: "cone"}
# Of the view's height, between a new light and what is looked at: its handle is seen.
_AWAY = 0.45
# From the upper left, so that it is told from the two that are there at first.
_NEW = (-0.5, 0.6, 0.6)


class Lights:
    """Which light is chosen, and what is done to it.

    Parameters
    ----------
    controller : Controller
        Holds the session.
    look : callable
        Gives the camera of the view, for lights that move with it; None before there is one.
    """

    chosen = Signal(int)
    """Emitted with the index of the light that is chosen, or -1."""

    def __init__(self, controller: Controller, look: Callable[[], Camera | None]) -> None:
        self._controller = controller
        self._look = look
        self._index = 0
        controller.document.changed.connect(self._on_changed)

    @property
    def all(self) -> tuple[AnyLight, ...]:
        """The session's lights."""
        return self._controller.session.lights

    @property
    def camera(self) -> Camera | None:
        """Where the view is seen from."""
        return self._look()

    @property
    def index(self) -> int:
        """Which is chosen; -1 if there is none."""
        return min(self._index, len(self.all) - 1)

    @property
    def light(self) -> AnyLight | None:
        """The light that is chosen."""
        return self.all[self.index] if self.all else None

    def choose(self, index: int) -> None:
        """Choose a light.

        Parameters
        ----------
        index : int
            Of `all`.
        """
        if index != self._index:
            self._index = index
            self.chosen.emit(self.index)

    def change(self, label: str, **fields: Any) -> None:
        """Change fields of the chosen light, undoable.

        Parameters
        ----------
        label : str
            What is done, as a person calls it.
        **fields : object
            New values.
        """
        if self.light is not None:
            self._put(label, self.index, replace(self.light, **fields))

    def add(self, kind: str) -> None:
        """Add a light and choose it.

        Parameters
        ----------
        kind : str
            One of `KINDS`.
        """
        light = self._as(Directional(_NEW, (0.5, 0.5, 0.5), "camera"), kind)
        self._insert(f"add {kind} light", light)

    def duplicate(self) -> None:
        """Add a copy of the chosen light and choose it."""
        if self.light is not None:
            self._insert("duplicate light", self.light)

    def remove(self) -> None:
        """Take the chosen light away."""
        if self.light is not None:
            kept = (*self.all[: self.index], *self.all[self.index + 1 :])
            self._step("remove light", kept)
            self.chosen.emit(self.index)

    def make(self, kind: str) -> None:
        """Make the chosen light one of another kind, about as bright and from the same side.

        Parameters
        ----------
        kind : str
            One of `KINDS`.
        """
        if self.light is not None and kind_of(self.light) != kind:
            self._put("kind of light", self.index, self._as(self.light, kind))

    def fix(self, frame: Frame) -> None:
        """Let the chosen light move with the camera or stay in the world, where it is now.

        Parameters
        ----------
        frame : str
            ``camera`` or ``world``.
        """
        light = self.light
        if isinstance(light, Directional) and self.camera is not None and light.frame != frame:
            seen = seen_by(light, self.camera)
            other = replace(light, frame=frame)
            self.change("frame of light", frame=frame, direction=kept_in(other, seen, self.camera))

    def aim(self, seen: Vector) -> None:
        """Let the chosen light come from a direction.

        Parameters
        ----------
        seen : tuple of 3 floats
            To the light, in the camera's axes.
        """
        if isinstance(self.light, Directional) and self.camera is not None:
            self.change("direction of light", direction=kept_in(self.light, seen, self.camera))

    def turn(self, right: float, up: float) -> None:
        """Turn the chosen light about the mesh.

        Parameters
        ----------
        right, up : float
            How far the mouse moved, in heights of the view.
        """
        if isinstance(self.light, Directional) and self.camera is not None:
            self.aim(turned(seen_by(self.light, self.camera), right, up))

    def _insert(self, label: str, light: AnyLight) -> None:
        if self._step(label, (*self.all, light)):
            self._index = len(self.all) - 1
            self.chosen.emit(self._index)

    def _step(self, label: str, lights: tuple[AnyLight, ...]) -> bool:
        """Do what is a step of its own, however fast it follows another of its kind."""
        document = self._controller.document
        document.begin_drag()
        done = self._controller.change(label, lights=lights)
        document.end_drag()
        return done

    def _put(self, label: str, index: int, light: AnyLight) -> None:
        lights = (*self.all[:index], light, *self.all[index + 1 :])
        self._controller.change(f"{label} {index + 1}", lights=lights)

    def _as(self, light: AnyLight, kind: str) -> AnyLight:
        """Return a light of another kind, as bright where the camera looks."""
        camera = self.camera
        if camera is None or kind == kind_of(light):
            return light
        away = _AWAY * orbit.height_at_target(camera)
        if isinstance(light, Directional):
            world = axes(camera).T @ np.asarray(seen_by(light, camera))
            world = world / np.linalg.norm(world)
            position = orbit.vector(np.add(camera.target, away * world))
        else:
            position = light.position
            back = np.subtract(position, camera.target)
            away = max(float(np.linalg.norm(back)), 1e-6 * away)
            world = back / away
        red, green, blue = power(light)
        if kind == "directional":
            factor = 1.0 if isinstance(light, Directional) else away**-2
            arriving = (red * factor, green * factor, blue * factor)
            return Directional(orbit.vector(world), arriving, "world")
        factor = away**2 if isinstance(light, Directional) else 1.0
        intensity = (red * factor, green * factor, blue * factor)
        if kind == "point":
            return Point(position, intensity)
        return Cone(position, orbit.vector(-world), intensity)

    def _on_changed(self, session: Session, before: Session) -> None:
        if len(session.lights) != len(before.lights):
            self.chosen.emit(self.index)


def kind_of(light: AnyLight) -> str:
    """Return the kind of a light.

    Parameters
    ----------
    light : Directional, Point or Cone
        Any.

    Returns
    -------
    str
        One of `KINDS`.
    """
    return _KINDS[type(light)]


def power(light: AnyLight) -> Vector:
    """Return how strong a light is.

    Parameters
    ----------
    light : Directional, Point or Cone
        Any.

    Returns
    -------
    tuple of 3 floats
        Irradiance of a directional light, intensity of another.
    """
    return light.irradiance if isinstance(light, Directional) else light.intensity


def powered(light: AnyLight, rgb: Vector) -> dict[str, Vector]:
    """Return the field that makes a light so strong, for `Lights.change`.

    Parameters
    ----------
    light : Directional, Point or Cone
        Its kind counts.
    rgb : tuple of 3 floats
        Linear.

    Returns
    -------
    dict of str to tuple
        One field.
    """
    return {"irradiance" if isinstance(light, Directional) else "intensity": rgb}


def displayed(rgb: Vector) -> Vector:
    """Return a light's colour as bright as it can be shown.

    Parameters
    ----------
    rgb : tuple of 3 floats
        Linear, 0 or more.

    Returns
    -------
    tuple of 3 floats
        sRGB-encoded, 0 to 1; black for no light.
    """
    most = max(rgb)
    return orbit.vector(encoded(np.asarray(rgb) / most)) if most > 0.0 else (0.0, 0.0, 0.0)
