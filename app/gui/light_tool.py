"""Lights turned and moved in the view: by their handles, or with L or Alt held."""

import numpy as np
from qtpy.QtCore import QEvent, QObject, Qt

from app.camera import axes
from app.gui import orbit
from app.gui.aiming import beside, on_sphere, place_of
from app.gui.canvas import Canvas, Place
from app.gui.controller import Controller
from app.gui.light_handles import PIXELS, Handles, anchor, radius
from app.gui.lights import Lights
from app.session import Directional, Vector


class LightTool(QObject):
    """Takes a drag that begins on a handle, or while L or Alt is held.

    Parameters
    ----------
    canvas : Canvas
        The view.
    controller : Controller
        Told when a drag begins and ends.
    lights : Lights
        What is dragged.
    """

    def __init__(self, canvas: Canvas, controller: Controller, lights: Lights) -> None:
        super().__init__(canvas)
        self._canvas, self._controller, self._lights = canvas, controller, lights
        self.handles = Handles(canvas, lights)
        self._held = False
        self._grip: Vector | None = None
        self._turning = False
        self._from = (0.0, 0.0)
        self._offset = (0.0, 0.0)
        canvas.filled.connect(self.handles.draw)
        canvas.recolored.connect(self.handles.draw)
        canvas.moved.connect(lambda _: self.handles.draw())
        lights.chosen.connect(lambda _: self._redraw())
        controller.document.changed.connect(lambda *_: self._redraw())
        canvas.window().installEventFilter(self)

    def eventFilter(self, watched: QObject | None, event: QEvent | None) -> bool:  # noqa: N802
        """Know whether L is held; it is left to whoever else wants it."""
        if event is None:
            return False
        kind = event.type()
        if kind in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease):
            key = event.key()  # type: ignore[attr-defined]
            if key == Qt.Key.Key_L and not event.isAutoRepeat():  # type: ignore[attr-defined]
                self._held = kind == QEvent.Type.KeyPress
        elif kind == QEvent.Type.WindowDeactivate:
            self._held = False
        return False

    def press(self, place: Place) -> bool:
        """Take a drag of a handle, or of the chosen light with L or Alt."""
        if place.panel is None or place.button != Qt.MouseButton.LeftButton:
            return False
        self._from = place.right, place.up
        held = self._held or bool(place.modifiers & Qt.KeyboardModifier.AltModifier)
        if held and isinstance(self._lights.light, Directional):
            self._turning = True
        elif not self._grab(place):
            return False
        self._controller.begin_drag()
        return True

    def drag(self, place: Place) -> None:
        """Let the light follow the mouse."""
        if self._turning:
            self._lights.turn(place.right - self._from[0], place.up - self._from[1])
            self._from = place.right, place.up
        else:
            self._move(place)

    def release(self, place: Place) -> None:
        """Let go."""
        self._turning, self._grip = False, None
        self._controller.end_drag()

    def hover(self, place: Place | None) -> None:
        """Do nothing: handles are seen."""

    def _grab(self, place: Place) -> bool:
        camera = self._canvas.camera
        if not self.handles.shown or camera is None or place.panel is None:
            return False
        height = self._canvas.drawn[place.panel].renderer.GetSize()[1]
        reach = 1.5 * PIXELS * self._canvas.devicePixelRatioF() / height
        near = []
        for index, light in enumerate(self._lights.all):
            grip = anchor(light, camera)
            at = place_of(camera, grip)
            if at is not None:
                distance = float(np.hypot(at[0] - place.right, at[1] - place.up))
                near.append((distance, index, grip, at))
        if not near or min(near)[0] > reach:
            return False
        _, index, self._grip, at = min(near)
        self._offset = at[0] - place.right, at[1] - place.up
        self._lights.choose(index)
        return True

    def _move(self, place: Place) -> None:
        camera, light, grip = self._canvas.camera, self._lights.light, self._grip
        if camera is None or light is None or grip is None:
            return
        right, up = place.right + self._offset[0], place.up + self._offset[1]
        if isinstance(light, Directional):
            near = bool(axes(camera)[2] @ np.subtract(grip, camera.target) >= 0.0)
            world = on_sphere(camera, radius(camera), right, up, near)
            self._lights.aim(orbit.vector(axes(camera) @ world))
        else:
            self._lights.change("position of light", position=beside(camera, grip, right, up))

    def _redraw(self) -> None:
        if self.handles.shown:
            self.handles.draw()
            self._canvas.update()
