"""The view: a composition on the screen, seen by a camera that the mouse moves."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import vtkmodules.vtkRenderingFreeType
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  registers the OpenGL classes
from qtpy.QtCore import QEvent, QPointF, Qt, QTimer, Signal
from qtpy.QtGui import QKeyEvent, QMouseEvent, QResizeEvent, QWheelEvent
from qtpy.QtWidgets import QWidget
from vtkmodules.qt.QVTKRenderWindowInteractor import QVTKRenderWindowInteractor
from vtkmodules.vtkRenderingCore import vtkRenderWindow

from app.backend import Backend, backend_of
from app.composition import Composition
from app.gui import orbit
from app.gui.background import lay_checks, on_screen
from app.gui.coarse import Coarse
from app.gui.stand_in import StandIn
from app.render import Drawn, Panel, fill, refill_bar
from app.scene import ColorScale, Surface, aim, recolor
from app.session import Camera, Vector

if TYPE_CHECKING:
    from app.shader.drawing import PixelLight
    from app.shader.look import PixelLook

# Slower than this a moving picture is no longer seen as moving.
_SLOW = 1.0 / 15.0
_STILL = 200  # ms without a movement, after which the picture is refined
_SAMPLES = 4
_CLICK = 3  # pixels that a hand may move between press and release of a click
_WHEEL = 1.1  # larger by, for one click of the wheel


@dataclass(frozen=True)
class Place:
    """Where the mouse is.

    Parameters
    ----------
    x, y : int
        Pixels of the screen from the lower left corner of the view.
    panel : int or None
        Index of the panel with a mesh that is there.
    right, up : float
        From the middle of that panel, in its heights.
    button : Qt.MouseButton
        What is pressed, or was released.
    modifiers : Qt.KeyboardModifier
        Keys that are held.
    """

    x: int
    y: int
    panel: int | None
    right: float
    up: float
    button: Qt.MouseButton
    modifiers: Qt.KeyboardModifier


class Tool(Protocol):
    """Something that may take the mouse from the camera."""

    def press(self, place: Place) -> bool:
        """Tell whether a drag that begins here is for this tool."""

    def drag(self, place: Place) -> None:
        """Follow a drag that this tool took."""

    def release(self, place: Place) -> None:
        """End a drag that this tool took."""

    def hover(self, place: Place | None) -> None:
        """Follow the mouse while no button is pressed; None when it leaves."""


class Canvas(QVTKRenderWindowInteractor):  # type: ignore[misc]  # no types in VTK
    """Draws compositions with the renderers of pictures, and moves their camera.

    Parameters
    ----------
    parent : QWidget
        Where it lies.
    """

    moved = Signal(object)
    """Emitted with the Camera while it is moved by hand."""
    filled = Signal()
    """Emitted when renderers were made anew: who draws over them draws again."""
    recolored = Signal()
    """Emitted when the same renderers show other colours, or another camera."""
    resized = Signal(int, int)
    """Emitted with width and height in pixels of the screen."""
    drew = Signal(float)
    """Emitted after each frame with its seconds."""
    hovered = Signal(object)
    """Emitted with the Place of the mouse while no button is pressed, None when it leaves."""
    clicked = Signal(object)
    """Emitted with the Place of a click with the left button that no tool took."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.window_: vtkRenderWindow = self.GetRenderWindow()
        # A software renderer takes three times as long with four samples.
        self.window_.SetMultiSamples(0)
        self.window_.SetWindowName("curvelight")
        self.backend: Backend | None = None
        """What draws; known after the first picture."""
        self.drawn: list[Drawn] = []
        """What the view holds, in the order of the composition's panels."""
        self.composition: Composition | None = None
        self.camera: Camera | None = None
        self.origin: Vector = (0.0, 0.0, 0.0)
        """What the geometry is drawn relative to: subtract it from world coordinates."""
        self.by_pixel: PixelLight | None = None
        """What shades the first mesh by the pixel; None while vertices have the colours."""
        self.tools: list[Tool] = []
        """Asked in order, before the camera, who wants a drag."""
        self._taken: Tool | None = None
        self._last: QPointF | None = None
        self._pressed: QPointF | None = None
        self._stand_in = StandIn()
        self._frame = 0.0
        self._still = QTimer(self)
        self._still.setSingleShot(True)
        self._still.setInterval(_STILL)
        self._still.timeout.connect(self._refine)
        self.setAccessibleName("View of the mesh")
        self.setAccessibleDescription("Drag to turn, right drag to shift, wheel to zoom")

    def show_composition(self, made: Composition, camera: Camera) -> None:
        """Show a composition; where only colours changed, only they are sent to the renderer.

        Parameters
        ----------
        made : Composition
            What to show.
        camera : Camera
            Where from: the camera may have moved on while the colours were computed.
        """
        if self.by_pixel is not None and not self.by_pixel.look.fits(made.session):
            self.shade_by_pixel(None)
        before, self.composition = self.composition, made
        self.camera = camera
        if before is not None and _same_but_colors(before, made):
            size = tuple(self.window_.GetSize())
            for index, (drawn, panel) in enumerate(zip(self.drawn, made.panels, strict=True)):
                if drawn.actor is not None:
                    if self.by_pixel is None or index > 0:
                        self._recolor(index, panel)
                elif isinstance(panel.content, ColorScale):
                    refill_bar(drawn, panel.content, size, made.rows)
            self._stand_in.recolor([panel.content for panel in made.panels])
            self._aim()
            self.recolored.emit()
        else:
            self._fill(made, before)
        self.update()

    def shade_by_pixel(self, look: "PixelLook | None") -> None:
        """Shade the first mesh in the fragment shader, or show the colours of its vertices.

        Parameters
        ----------
        look : PixelLook or None
            Of what is shown.
        """
        if self.by_pixel is not None:
            self.by_pixel.remove()
            self.by_pixel = None
            self.resend()  # colours that came meanwhile were not sent
        made, camera = self.composition, self.camera
        if look is None or made is None or camera is None or made.exposure is None:
            return
        if self.drawn and self.drawn[0].actor is not None:
            from app.shader.drawing import PixelLight  # which needs compiled code

            coarse = self._stand_in.of(0)
            actors = [(self.drawn[0].actor, None), *([coarse] if coarse else [])]
            self.by_pixel = PixelLight(
                look, actors, self.origin, made.session, camera, made.exposure
            )

    def resend(self) -> None:
        """Send the first mesh's colours to the renderer once more."""
        if self.composition is not None:
            self._recolor(0, self.composition.panels[0])

    @property
    def held(self) -> bool:
        """Whether a drag goes on."""
        return self._pressed is not None

    @property
    def coarsely(self) -> bool:
        """Whether something moves and is drawn coarsely."""
        return self._stand_in.shown

    @property
    def seconds(self) -> float:
        """Of the last frame of the meshes themselves, not of coarse ones; 0 before it."""
        return self._frame

    @property
    def has_coarse(self) -> bool:
        """Whether there is something coarse to be drawn in place of the first mesh."""
        return self._stand_in.of(0) is not None

    def draw_unseen(self) -> None:
        """Draw the coarse mesh to the end, in part of the view, and leave what is on the screen.

        Its triangles have as many pixels as those of the mesh itself in the whole view, so that
        both take their time for the same things.
        """
        found, renderer = self._stand_in.coarse, self.drawn[0].renderer
        if found is None:
            return
        share = (len(found.mesh.faces) / len(found.fine.faces)) ** 0.5
        left, low, right, high = renderer.GetViewport()
        renderer.SetViewport(left, low, left + share * (right - left), low + share * (high - low))
        self._stand_in.show(self.drawn, True)
        self.window_.SwapBuffersOff()
        try:
            self.window_.Render()
            self.window_.WaitForCompletion()
        finally:
            self.window_.SwapBuffersOn()
            self._stand_in.show(self.drawn, False)
            renderer.SetViewport(left, low, right, high)

    def _recolor(self, index: int, panel: Panel) -> None:
        actor = self.drawn[index].actor
        if actor is not None and isinstance(panel.content, Surface):
            recolor(actor, panel.content)

    def place_camera(self, camera: Camera) -> None:
        """See the same from elsewhere.

        Parameters
        ----------
        camera : Camera
            Where from.
        """
        self.camera = camera
        self._aim()
        self.update()

    def give_coarse(self, found: Coarse | None) -> None:
        """Give what is drawn while the camera moves, where the mesh itself is too slow.

        Parameters
        ----------
        found : Coarse or None
            Made of the mesh that is shown, or will be.
        """
        look = None if self.by_pixel is None else self.by_pixel.look
        self.shade_by_pixel(None)
        self._stand_in.coarse = found
        if self.drawn:
            self._stand_in.fill(self.drawn, self.origin)
            self.shade_by_pixel(look)
            self.recolored.emit()

    def draw(self) -> None:
        """Draw a frame now."""
        if self.backend is not None:
            # Pictures are drawn in windows off the screen, on this thread: they leave OpenGL in
            # another state than this window remembers, and its next frame would lack parts.
            self.window_.MakeCurrent()
            self.window_.GetState().Reset()
        self.window_.Render()

    def stir(self) -> None:
        """Say that something moves: what is slow to draw is drawn coarsely until it rests."""
        if self._frame > _SLOW:
            self._stand_in.show(self.drawn, True)
        self._still.start()
        self.update()

    def renderers(self) -> Sequence[Drawn]:
        """Return what holds a mesh.

        Returns
        -------
        sequence of Drawn
            From left to right, row by row.
        """
        return [one for one in self.drawn if one.actor is not None]

    def _fill(self, made: Composition, before: Composition | None) -> None:
        window, self.by_pixel = self.window_, None
        for renderer in list(window.GetRenderers()):
            window.RemoveRenderer(renderer)
        if before is None or _mesh(before) is not _mesh(made):
            self.origin = made.camera.target
            self._frame = 0.0
        panels, size = made.panels, tuple(window.GetSize())
        background = on_screen(made.session.background)
        self.drawn = fill(window, panels, size, background, made.rows, self.origin)
        if background != made.session.background:
            lay_checks(window, self.devicePixelRatioF())
        self._stand_in.fill(self.drawn, self.origin)
        self._aim()
        self.filled.emit()

    def _aim(self) -> None:
        if self.camera is None:
            return
        for drawn in self.renderers():
            aim(drawn.renderer, self.camera, self.origin)

    def _know_backend(self) -> None:
        self.backend = backend_of(self.window_)
        if not self.backend.software:
            self.window_.SetMultiSamples(_SAMPLES)
            self.update()

    def _refine(self) -> None:
        self._stand_in.show(self.drawn, False)
        self.update()

    # What Qt calls.

    def paintEvent(self, event: QEvent | None) -> None:  # noqa: N802
        """Draw, and note how long it took."""
        start = time.perf_counter()
        self.draw()
        seconds = time.perf_counter() - start
        if self.backend is None and self.drawn:
            self._know_backend()
        if not self._stand_in.shown:
            self._frame = seconds
        self.drew.emit(seconds)

    def resizeEvent(self, event: QResizeEvent | None) -> None:  # noqa: N802
        """Follow the widget's size, in pixels of the screen that it is on."""
        scale = self.devicePixelRatioF()
        size = round(scale * self.width()), round(scale * self.height())
        # One point is one pixel, as off the screen: letters are sized by the picture's height.
        self.window_.SetDPI(72)
        self.window_.SetSize(*size)
        self.resized.emit(*size)
        self.update()

    def place(self, at: QPointF, button: Qt.MouseButton, keys: Qt.KeyboardModifier) -> Place:
        """Return where a point of the widget is in the picture.

        Parameters
        ----------
        at : QPointF
            In the widget's own units, from its upper left corner.
        button : Qt.MouseButton
            For `Place.button`.
        keys : Qt.KeyboardModifier
            For `Place.modifiers`.

        Returns
        -------
        Place
            The same place.
        """
        scale = self.devicePixelRatioF()
        x, y = round(at.x() * scale), round((self.height() - 1 - at.y()) * scale)
        for index, drawn in enumerate(self.drawn):
            left, bottom = drawn.renderer.GetOrigin()
            width, height = drawn.renderer.GetSize()
            if drawn.actor and left <= x < left + width and bottom <= y < bottom + height:
                right = (x + 0.5 - left - width / 2.0) / height
                up = (y + 0.5 - bottom - height / 2.0) / height
                return Place(x, y, index, right, up, button, keys)
        return Place(x, y, None, 0.0, 0.0, button, keys)

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Begin a drag: of the first tool that wants it, else of the camera."""
        place = self.place(event.position(), event.button(), event.modifiers())
        self._last = self._pressed = event.position()
        self._taken = next((tool for tool in self.tools if tool.press(place)), None)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Follow a drag, or the mouse."""
        place = self.place(event.position(), event.button(), event.modifiers())
        if self._taken is not None:
            self._taken.drag(place)
        elif event.buttons() == Qt.MouseButton.NoButton or self._last is None:
            for tool in self.tools:
                tool.hover(place)
            self.hovered.emit(place)
        else:
            self._drag(event)
            self._last = event.position()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """End a drag."""
        place = self.place(event.position(), event.button(), event.modifiers())
        if self._taken is not None:
            self._taken.release(place)
        elif self._pressed is not None and self.camera is not None:
            away = event.position() - self._pressed
            if away.manhattanLength() > _CLICK:
                self.moved.emit(self.camera)
            elif event.button() == Qt.MouseButton.LeftButton:
                self.clicked.emit(place)
        self._taken = self._last = self._pressed = None

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Take it for another press."""
        self.mousePressEvent(event)

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802
        """Come nearer, or go."""
        if self.camera is not None:
            self._move(orbit.nearer(self.camera, _WHEEL ** (event.angleDelta().y() / 120.0)))

    def leaveEvent(self, event: QEvent) -> None:  # noqa: N802
        """Tell the tools that the mouse is gone."""
        for tool in self.tools:
            tool.hover(None)
        self.hovered.emit(None)

    def enterEvent(self, event: QEvent) -> None:  # noqa: N802
        """Leave VTK's own interactor out of it."""

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802
        """Leave keys to the window's shortcuts: VTK's own would end the program at E."""
        event.ignore()

    def keyReleaseEvent(self, event: QKeyEvent) -> None:  # noqa: N802
        """Leave keys to the window's shortcuts."""
        event.ignore()

    def _drag(self, event: QMouseEvent) -> None:
        camera, last = self.camera, self._last
        if camera is None or last is None:
            return
        step = event.position() - last
        right, up = step.x() / self.height(), -step.y() / self.height()
        buttons, keys = event.buttons(), event.modifiers()
        if buttons & Qt.MouseButton.LeftButton and not keys & Qt.KeyboardModifier.ShiftModifier:
            if keys & Qt.KeyboardModifier.ControlModifier:
                self._move(orbit.rolled(camera, right * 3.0))
            else:
                self._move(orbit.turned(camera, right, up))
        else:
            self._move(orbit.shifted(camera, right, up))

    def _move(self, camera: Camera) -> None:
        self.camera = camera
        self._aim()
        self.stir()
        self.moved.emit(camera)


def _mesh(made: Composition) -> Any:
    return next(one.content.mesh for one in made.panels if isinstance(one.content, Surface))


def _same_but_colors(one: Composition, other: Composition) -> bool:
    """Tell whether the panels of two compositions differ in nothing but colours and camera."""
    if one.rows != other.rows or len(one.panels) != len(other.panels):
        return False
    if one.session.background != other.session.background or one.session.size != other.session.size:
        return False
    return all(
        a.width == b.width and _alike(a.content, b.content)
        for a, b in zip(one.panels, other.panels, strict=True)
    )


def _texture(surface: Surface) -> Any:
    return None if surface.coat is None else surface.coat.texture


def _alike(one: Any, other: Any) -> bool:
    if isinstance(one, Surface) and isinstance(other, Surface):
        return (
            one.mesh is other.mesh
            and one.lit == other.lit
            and one.caption == other.caption
            and (one.rgb is None) == (other.rgb is None)
            and one.normals is other.normals
            and _texture(one) is _texture(other)
            and one.strokes is other.strokes
            and (one.wipe is None) == (other.wipe is None)
        )
    return isinstance(one, ColorScale) and isinstance(other, ColorScale)
