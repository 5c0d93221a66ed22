"""Shading at pixels or at vertices: which of them the view uses, and its uniforms."""

from collections.abc import Hashable

from qtpy.QtCore import QObject, QTimer

from app.camera import axes
from app.gui.canvas import Canvas
from app.gui.controller import Controller, Outcome
from app.gui.pixel_race import Contest, PixelRace, step_seconds
from app.gui.settings import Settings
from app.session import Camera, Session
from app.shader.look import PixelLook, look_of, unsupported
from app.steps.subject import Subject

CHOICES = {
    "automatic": ("The faster way", "Shade at pixels where this machine draws that faster"),
    "vertex": ("At vertices", "Compute shading at the vertices, as saved pictures do"),
    "pixel": ("At pixels", "Compute shading at each pixel wherever there is a shader for it"),
}
"""What is computed where: its text and its meaning in the menu."""
_SETTING = "shading path"
_REST = 200  # ms without a movement, after which the picture is computed at vertices too


class PixelPath(QObject):
    """Puts the shader on the first mesh of the view where it may and should.

    While it is on, a light that is dragged and a camera that turns only set uniforms. When they
    rest the picture is computed at vertices too: what is probed, saved and exposed is that one.

    Parameters
    ----------
    controller : Controller
        Of the window.
    canvas : Canvas
        Its view; it follows `controller` before this does.
    settings : Settings
        Remembers the choice.
    """

    def __init__(self, controller: Controller, canvas: Canvas, settings: Settings) -> None:
        super().__init__(canvas)
        self._controller, self._canvas, self._settings = controller, canvas, settings
        self.reason = ""
        """Why the vertices have the colours, if they do."""
        self._race: PixelRace | None = None
        self._verdicts: dict[Hashable, Contest] = {}
        self._look: tuple[Subject, PixelLook] | None = None
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(_REST)
        self._rest.timeout.connect(self._on_rest)
        self._still = QTimer(self)
        self._still.setSingleShot(True)
        self._still.setInterval(_REST)
        self._still.timeout.connect(self._prepare)
        controller.follows = self._follows
        controller.shown.connect(self._on_shown)
        controller.document.changed.connect(lambda *_: self._move())
        canvas.moved.connect(lambda _: self._move())
        canvas.recolored.connect(self._move)

    @property
    def choice(self) -> str:
        """A key of `CHOICES`."""
        found = self._settings.get(_SETTING, "automatic")
        return found if found in CHOICES else "automatic"

    @property
    def racing(self) -> bool:
        """Whether the two ways are being measured."""
        return self._race is not None

    def choose(self, choice: str) -> None:
        """Choose where shading is computed.

        Parameters
        ----------
        choice : str
            A key of `CHOICES`.
        """
        self._settings.set(_SETTING, choice)
        if self._controller.outcome is not None:
            self._on_shown(self._controller.outcome)
        self._canvas.update()

    def _on_shown(self, outcome: Outcome) -> None:
        session, subject = outcome.session, outcome.subject
        self._stop()
        self._still.stop()
        self.reason = self._against(session, subject)
        if self.reason:
            self._canvas.shade_by_pixel(None)
            self._look = None if unsupported(session, subject) else self._look
            self._canvas.update()  # so that the status bar says it
        elif self._canvas.by_pixel is not None:
            self._move()
        elif self._measured(session, subject):
            self._prepare()
        else:
            self._still.start()

    def _measured(self, session: Session, subject: Subject) -> bool:
        return self.choice != "automatic" or _key(session, subject) in self._verdicts

    def _prepare(self) -> None:
        outcome = self._controller.outcome
        if outcome is None or self._controller.document.dragging:
            return  # a picture follows, and asks again
        session, subject = outcome.session, outcome.subject
        ready = self._look is not None and self._look[0] is subject and self._look[1].fits(session)
        if self._look is not None and ready and self._measured(session, subject):
            self._use(outcome, self._look[1], None)
            return
        self._controller.run(
            "pixel", lambda _: self._make(outcome), lambda made: self._use(outcome, *made)
        )

    def _against(self, session: Session, subject: Subject) -> str:
        if self.choice == "vertex":
            return "at vertices: chosen in the menu View"
        if missing := unsupported(session, subject):
            return f"at vertices: {missing}"
        contest = self._verdicts.get(_key(session, subject))
        if self.choice == "automatic" and contest is not None and not contest.pixels_win:
            return contest.label
        return ""

    def _make(self, outcome: Outcome) -> tuple[PixelLook, float | None]:
        """Prepare the shader, in the worker's thread."""
        session, pipeline, made = outcome.session, self._controller.pipeline, outcome.composition
        look = look_of(session, pipeline, axes(made.camera))
        measured = self._measured(session, outcome.subject)
        return look, None if measured else step_seconds(made, pipeline)

    def _use(self, outcome: Outcome, look: PixelLook, seconds: float | None) -> None:
        if outcome is not self._controller.outcome or self._against(
            outcome.session, outcome.subject
        ):
            return  # another picture is shown by now, and will ask itself
        self._look = outcome.subject, look
        if self.choice == "automatic" and seconds is not None:

            def done(contest: Contest) -> None:
                self._race = None
                self._verdicts[_key(outcome.session, outcome.subject)] = contest
                self._on_shown(outcome)

            self._race = PixelRace(self._canvas, look, seconds, self._move, done)
            return
        self._canvas.shade_by_pixel(look)
        self._move()
        self._canvas.update()

    def _stop(self) -> None:
        if self._race is not None:
            self._race.stop()
            self._race = None

    def _move(self) -> None:
        """Tell the shader where lights and camera are."""
        canvas, made, session = self._canvas, self._canvas.composition, self._controller.session
        if canvas.by_pixel is None or made is None or canvas.camera is None:
            return
        outcome = self._controller.outcome
        exposure = session.exposure or made.exposure
        if outcome is None or exposure is None or unsupported(session, outcome.subject):
            return  # the picture that is being computed takes it off
        canvas.by_pixel.move(session, canvas.camera, exposure)

    def _on_rest(self) -> None:
        if self._canvas.held or self._controller.document.dragging:
            self._rest.start()
        else:
            self._controller.refresh()

    def _follows(self, changed: set[str]) -> bool:
        controller = self._controller
        if self._canvas.by_pixel is None or self._race is not None:
            return False
        dragged = {"camera", "lights"} if controller.document.dragging else {"camera"}
        if not changed <= dragged:
            return False
        if "camera" in changed and not isinstance(controller.session.camera, Camera):
            return False  # a view by its name is fitted to the mesh
        self._rest.start()
        return True


def _key(session: Session, subject: Subject) -> Hashable:
    return subject.key, session.model.name, len(session.lights)
