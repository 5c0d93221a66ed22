"""The session that the window shows, with its history. Knows no Qt."""

import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from msgspec.structs import replace
from psygnal import Signal

from app import session as state
from app.samples import PREFIX
from app.session import Camera, Session, Settled

_MOST_STEPS = 500
# Changes of one control within this time are one step: a slider that is dragged.
_ONE_STEP = 1.0


@dataclass(frozen=True)
class Step:
    """One step of the history.

    Parameters
    ----------
    label : str
        What was done, as a person calls it.
    session : Session
        The state after it.
    """

    label: str
    session: Session


class Document:
    """A session that can be changed, undone and saved.

    The camera is part of the session but not of its history.

    Parameters
    ----------
    session : Session
        The first state.
    """

    changed = Signal(Session, Session)
    """Emitted with the new session and the one before it."""
    history_changed = Signal()
    """Emitted when what can be undone, or whether there are unsaved changes, may have changed."""

    def __init__(self, session: Session) -> None:
        self._steps = [Step("open", session)]
        self._at = 0
        self._session = session
        # States that need no saving: those of files, and what they become by opening a mesh.
        self._safe = [_without_camera(session)]
        self._last: tuple[str, float] = ("", 0.0)
        self._drags = 0
        self.path: Path | None = None

    @property
    def session(self) -> Session:
        """The state as it is now."""
        return self._session

    @property
    def dirty(self) -> bool:
        """Whether there are changes, camera apart, that no file holds."""
        return _without_camera(self._session) not in self._safe

    @property
    def undo_label(self) -> str | None:
        """What undo would take back, None if nothing."""
        return self._steps[self._at].label if self._at else None

    @property
    def redo_label(self) -> str | None:
        """What redo would do again, None if nothing."""
        return self._steps[self._at + 1].label if self._at + 1 < len(self._steps) else None

    def change(self, label: str, **fields: Any) -> None:
        """Change fields of the session, as a step that can be undone.

        Parameters
        ----------
        label : str
            What is done, as a person calls it: ``"exposure"``. The same label again within a
            second is the same step.
        **fields : object
            New values; None is a value here, where a field allows it.

        Raises
        ------
        ParameterError
            If a value cannot be; nothing is changed then.
        """
        self.put(label, state.checked(self._session, **fields))

    def put(self, label: str, session: Session) -> None:
        """Replace the whole session, as a step that can be undone.

        Parameters
        ----------
        label : str
            See `change`.
        session : Session
            The new state.
        """
        if session == self._session:
            return
        now = time.monotonic()
        recent = self._drags > 0 or now - self._last[1] < _ONE_STEP
        joined = label == self._last[0] and recent and self._at > 0
        del self._steps[self._at + 1 :]
        step = Step(label, session)
        if joined:
            self._steps[self._at] = step
        else:
            self._steps.append(step)
            del self._steps[:-_MOST_STEPS]
            self._at = len(self._steps) - 1
        self._last = label, now
        self._show(session)

    @property
    def dragging(self) -> bool:
        """Whether `begin_drag` was called, and `end_drag` not yet."""
        return self._drags > 0

    def holds(self, path: Path) -> bool:
        """Tell whether a session file says the very state, camera included.

        Parameters
        ----------
        path : Path
            A session file.

        Returns
        -------
        bool
            False, too, if it cannot be read any more.
        """
        try:
            return _placed(state.read(path)) == _placed(self._session)
        except state.SessionError:
            return False

    def rest(self) -> None:
        """Take the state as it is for one that needs no saving: nothing of it was made here."""
        self._safe = [*self._safe[1 - _MOST_STEPS :], _without_camera(self._session)]
        self.history_changed.emit()

    def begin_drag(self) -> None:
        """Make all changes of one label one step, however long they take, until `end_drag`."""
        self._drags += 1
        self._last = ("", 0.0)

    def end_drag(self) -> None:
        """End what `begin_drag` began; what follows is a step of its own."""
        self._drags = max(self._drags - 1, 0)
        self._last = ("", 0.0)

    def look(self, camera: str | Camera) -> None:
        """Move the camera; not a step of the history.

        Parameters
        ----------
        camera : str or Camera
            See `Session.camera`.
        """
        self._show(replace(self._session, camera=camera))

    def undo(self) -> None:
        """Take the last step back, if there is one; the camera stays."""
        if self._at:
            self._at -= 1
            self._return()

    def redo(self) -> None:
        """Do the step again that was taken back last, if there is one; the camera stays."""
        if self._at + 1 < len(self._steps):
            self._at += 1
            self._return()

    def open(self, session: Session, path: Path | None = None) -> None:
        """Begin anew with another session; its history is empty.

        Parameters
        ----------
        session : Session
            The state.
        path : Path, optional
            The session file it came from.
        """
        self._steps, self._at = [Step("open", session)], 0
        self._last = ("", 0.0)
        self._safe, self.path = [_without_camera(session)], path
        self._show(session)

    def save(self, path: Path, settled: tuple[Settled, ...] = ()) -> None:
        """Write the session as a file, whole or not at all.

        Parameters
        ----------
        path : Path
            Where to.
        settled : tuple of Settled
            What the model `auto` came to where the session was drawn.

        Raises
        ------
        WriteError
            If it cannot be written.
        """
        state.write(replace(self._session, settled=settled), path)
        self._safe, self.path = [_without_camera(self._session)], path
        self.history_changed.emit()

    def _return(self) -> None:
        self._last = ("", 0.0)
        kept = self._steps[self._at].session
        # Another mesh is seen from where it was seen, the same mesh from where one is.
        if kept.mesh == self._session.mesh:
            kept = replace(kept, camera=self._session.camera)
        self._show(kept)

    def _show(self, session: Session) -> None:
        before, self._session = self._session, session
        self.changed.emit(session, before)
        self.history_changed.emit()


def _placed(session: Session) -> Session:
    sample = session.mesh.startswith(PREFIX)
    return session if sample else replace(session, mesh=str(Path(session.mesh).resolve()))


def _without_camera(session: Session) -> Session:
    return replace(session, camera="auto")
