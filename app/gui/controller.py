"""What the window does, without a window: one document, one worker, one picture. Knows no Qt."""

import threading
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from msgspec.structs import replace
from psygnal import Signal

from app import session as state
from app.gui import ahead
from app.gui.document import Document
from app.gui.memory import keep_large_apart
from app.gui.worker import Post, Worker
from app.pipeline import Pipeline
from app.session import CHOSEN, Camera, Session, Settled
from app.steps.subject import Subject
from lutcore.compiling import compile_elsewhere
from lutcore.errors import CurvelightError
from lutcore.progress import Progress

if TYPE_CHECKING:
    from app.composition import Composition

T = TypeVar("T")
SESSION_SUFFIX = ".json"
_GREY = 10.0  # s that the worker waits for the first frame at most, in case none comes
# A change of anything else leaves what is being computed of use: it is seen while dragging.
_LIVE = {
    "lights",
    "exposure",
    "camera",
    "size",
    "range",
    "colormap",
    "symmetric",
    "flip",
    "flat",
    "albedo",
    "wipe",
    "background",
}
# What may change while a surface stays ready to be shaded; see `lutcore.draft`.
_OF_LIGHT = {"lights", "camera", "size", "exposure"}


@dataclass(frozen=True, eq=False)
class Outcome:
    """What a session looks like, and what it was made of.

    Parameters
    ----------
    session : Session
        What was asked for, its size that of the view.
    subject : Subject
        The mesh.
    composition : Composition
        What the view shows.
    measured : tuple
        What tells the session's curvature from others; see `Pipeline.curvature_key`.
    mm_per_unit : float
        Size of a mesh unit.
    settled : tuple of Settled
        What the model `auto` came to.
    """

    session: Session
    subject: Subject
    composition: "Composition"
    measured: tuple[Hashable, ...]
    mm_per_unit: float
    settled: tuple[Settled, ...] = ()


class _Held(NamedTuple):
    """What stands still while something is dragged, and what it is dragged from."""

    session: Session
    exposure: float | None
    settled: tuple[Settled, ...]


class Controller:
    """Turns what a person does into sessions, and sessions into what is shown.

    Parameters
    ----------
    post : callable
        Runs a function on the window's thread; see `app.gui.worker`.
    session : Session, optional
        What to begin with; the scanned marble face if left out.
    """

    loaded = Signal(object)
    """Emitted with the `Subject` as soon as another mesh is there, before its first picture."""
    previewed = Signal(object)
    """Emitted with a grey Composition where there is no picture yet that could stay."""
    shown = Signal(object)
    """Emitted with the `Outcome` when a picture is ready."""
    failed = Signal(str)
    """Emitted with a message when something a person asked for could not be done."""
    faulted = Signal(object)
    """Emitted with an exception that is a fault in the program; see `app.gui.faults`."""
    noted = Signal(str)
    """Emitted with a remark for the log."""
    standing = Signal(object)
    """Emitted with the `Standing` of long work, None when there is none."""

    def __init__(self, post: Post, session: Session | None = None) -> None:
        # This process lives long, and its memory is to stay flat.
        compile_elsewhere()
        keep_large_apart()
        self.document = Document(session or Session())
        self.pipeline = Pipeline()
        """Used in the worker's thread only: see `run`."""
        self.worker = Worker(post, self.standing.emit, ahead.steps())
        self.aside = Worker(post, self.standing.emit)
        """For what needs no pipeline and takes long: pictures go on meanwhile."""
        self.outcome: Outcome | None = None
        self.range_locked = False
        """Whether another mesh is shown in the range of this one, to compare them."""
        self.follows: Callable[[set[str]], bool] | None = None
        """Told which fields changed; True if the view shows that itself, and asks when it rests."""
        self._size = (800, 600)
        self._held: _Held | None = None
        self._subject: Subject | None = None
        self.document.changed.connect(self._on_change)

    @property
    def session(self) -> Session:
        """The document's session."""
        return self.document.session

    def open(self, path: str | Path) -> None:
        """Open a mesh, or a session file, in place of what is there.

        The old picture stays until the new one is ready; if the file is broken, for good.

        Parameters
        ----------
        path : str or Path
            A mesh file, ``sample:NAME`` or a session file.
        """
        file = Path(path) if str(path).lower().endswith(SESSION_SUFFIX) else None
        try:
            session = self._of_mesh(str(path)) if file is None else state.read(file)
        except CurvelightError as error:
            self.failed.emit(str(error))
            return

        def opened(_: Subject) -> None:
            if file is None:
                clean = not self.document.dirty
                self.document.put("open mesh", session)
                if clean:  # nothing is lost with it; and no session file says it
                    self.document.path = None
                    self.document.rest()
            else:
                self.document.open(session, file)

        # Loaded before the document changes, so that a broken file leaves everything as it was.
        self.run("open", lambda _: self.pipeline.subject(session), opened, supersede=True)

    def save(self, path: Path) -> bool:
        """Write the session as a file.

        Parameters
        ----------
        path : Path
            Where to; gets the ending of sessions if it has another.

        Returns
        -------
        bool
            False if it cannot be written; the message was emitted then.
        """
        if path.suffix.lower() != SESSION_SUFFIX:
            path = path.with_name(path.name + SESSION_SUFFIX)
        try:
            self.document.save(path, self.outcome.settled if self.outcome else ())
        except CurvelightError as error:
            self.failed.emit(str(error))
            return False
        self.noted.emit(f"saved {path}")
        return True

    def _of_mesh(self, mesh: str) -> Session:
        """Keep how things are shown, and drop what belonged to the old mesh."""
        return replace(
            self.session,
            mesh=mesh,
            repairs=(),
            mm_per_unit=None,
            scale=None,
            range=self.session.range if self.range_locked else None,
            camera="auto",
        )

    def change(self, label: str, **fields: Any) -> bool:
        """Change fields of the session, undoable.

        Parameters
        ----------
        label : str
            What is done, as a person calls it.
        **fields : object
            New values.

        Returns
        -------
        bool
            False if a value cannot be; the message was emitted then.
        """
        try:
            self.document.change(label, **fields)
        except CurvelightError as error:
            self.failed.emit(str(error))
            return False
        return True

    def complete(self, label: str, **fields: Any) -> None:
        """Change fields to what is known of the mesh anyway: nobody loses it, so none need save it.

        Parameters
        ----------
        label : str
            See `change`.
        **fields : object
            New values, which can be.
        """
        clean = not self.document.dirty
        if self.change(label, **fields) and clean:
            self.document.rest()

    def look(self, camera: str | Camera) -> None:
        """Move the camera.

        Parameters
        ----------
        camera : str or Camera
            See `Session.camera`.
        """
        self.document.look(camera)

    def resize(self, width: int, height: int) -> None:
        """Tell the size of the view.

        Parameters
        ----------
        width, height : int
            Pixels.
        """
        size = max(width, 64), max(height, 64)
        if size != self._size:
            self._size = size
            self.refresh()

    def refresh(self, supersede: bool = False) -> None:
        """Ask for the picture of the session as it is now.

        Parameters
        ----------
        supersede : bool
            Whether what is being computed is of no use any more.
        """
        session, held = replace(self.session, size=self._size), self._held
        self.run(
            "picture", lambda _: self._compose(session, held), self._on_shown, supersede=supersede
        )

    def begin_drag(self) -> None:
        """Make what follows one step of the history, under exposure and model of the picture shown.

        What followed a light while it is dragged would flicker, and colours are nearly right
        sooner. `end_drag` has all of it found anew, so that the still picture is that of the
        command line.
        """
        self.document.begin_drag()
        shown = self.outcome
        self._held = (
            _Held(shown.session, shown.composition.exposure, shown.settled) if shown else None
        )

    def end_drag(self) -> None:
        """End what `begin_drag` began."""
        self.document.end_drag()
        held, self._held = self._held, None
        if held and (held.settled or held.exposure):
            self.refresh()

    def run(
        self,
        key: str,
        job: Callable[[Progress], T],
        done: Callable[[T], None],
        supersede: bool = False,
        failed: Callable[[Exception], None] | None = None,
    ) -> None:
        """Do something with the pipeline in the worker's thread.

        Parameters
        ----------
        key : str
            Its kind: of each only the newest counts.
        job : callable
            Gets a function to report to.
        done : callable
            Gets the result on the window's thread.
        supersede : bool
            Whether one of the same kind that runs is of no use any more.
        failed : callable, optional
            Gets what was raised; by default a message is emitted.
        """

        def with_progress(progress: Progress) -> T:
            self.pipeline.progress = progress
            return job(progress)

        self.worker.submit(key, with_progress, done, failed or self.on_failed, supersede)

    def cancel(self) -> None:
        """Stop what runs, and drop what waits."""
        self.worker.cancel()
        self.aside.cancel()

    def close(self) -> None:
        """End the workers."""
        self.worker.close()
        self.aside.close()

    def _compose(self, session: Session, held: "_Held | None") -> Outcome:
        subject = self.pipeline.subject(session)
        if subject is not self._subject:
            if self._subject is None:
                from app.gui.preview import preview

                self._show_grey(preview(session, subject))
            self._subject = subject
            self.worker.post(lambda: self.loaded.emit(subject))
        from app.camera import axes
        from app.picture import compose
        from app.settling import recorded

        settled: tuple[Settled, ...] = ()
        exposure = held.exposure if held else None
        drafted = held is not None and _changed(session, held.session) <= _OF_LIGHT
        if held and held.settled and session.model.name == CHOSEN and session.view != "compare":
            # To choose anew for each place of a light takes a second, and may flicker.
            settled = held.settled
            drawn = replace(session, model=settled[0].method, shadows=session.casts)
            made = compose(drawn, self.pipeline, exposure, drafted)
        else:
            made = compose(session, self.pipeline, exposure, drafted)
            settled = recorded(session, self.pipeline, axes(made.camera)).settled
        return Outcome(
            session,
            subject,
            made,
            self.pipeline.curvature_key(session),
            self.pipeline.mm_per_unit(session),
            settled,
        )

    def _show_grey(self, grey: "Composition") -> None:
        """Have it on the screen before going on: what is loaded next takes all of Python's time."""
        seen = threading.Event()

        def show() -> None:
            self.previewed.emit(grey)
            seen.set()

        self.worker.post(show)
        seen.wait(_GREY)

    def _on_change(self, session: Session, before: Session) -> None:
        changed = _changed(session, before)
        if changed and not (self.follows and self.follows(changed)):
            self.refresh(supersede=not changed <= _LIVE)

    def _on_shown(self, outcome: Outcome) -> None:
        self.outcome = outcome
        self.shown.emit(outcome)

    def on_failed(self, error: Exception) -> None:
        """Tell a person what went wrong.

        Parameters
        ----------
        error : Exception
            What was raised.
        """
        if isinstance(error, CurvelightError | MemoryError):
            self.failed.emit(message_of(error))
        else:
            self.faulted.emit(error)


def message_of(error: Exception) -> str:
    """Return what to tell a person of an error.

    Parameters
    ----------
    error : Exception
        What was raised.

    Returns
    -------
    str
        Its message; that of a fault in the program says so.
    """
    if isinstance(error, CurvelightError):
        return str(error)
    if isinstance(error, MemoryError):
        return "not enough memory; decimate the mesh or close programs"
    return f"fault in the program: {type(error).__name__}: {error}"


def _changed(one: Session, other: Session) -> set[str]:
    names = Session.__struct_fields__
    return {name for name in names if getattr(one, name) != getattr(other, name)}
