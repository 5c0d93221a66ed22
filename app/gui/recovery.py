"""Keeps the session of a window where a crash leaves it, and finds what one left. Knows no Qt.

Each window has a file of its session and a lock beside it, named after its process. The system
gives the lock back when the process ends, however that happens: a session whose lock is free was
left by a crash, and who takes the lock owns what was left.
"""

import os
import threading
import time
import uuid
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import msgspec
from msgspec.structs import replace

from app.gui.file_lock import locked
from app.session import Session
from app.writing import WriteError, write_bytes

_DELAY = 1.0  # seconds that changes are gathered before they are written
_STALE = 60.0  # seconds after which a temporary file is nobody's


class Kept(msgspec.Struct, frozen=True):
    """What is kept of a window.

    Parameters
    ----------
    session : Session
        What it showed; the path of its mesh does not depend on the folder of the process.
    path : str or None
        The session file that was open.
    written : float
        When, seconds since 1970.
    """

    session: Session
    path: str | None
    written: float


@dataclass(frozen=True, eq=False)
class Left:
    """What a process that is gone has left; nobody else has it as long as we do.

    Parameters
    ----------
    file : Path
        Where it is.
    kept : Kept
        What it says.
    lock : file
        Held open.
    """

    file: Path
    kept: Kept
    lock: BinaryIO


class Recovery:
    """Keeps the session of one window while it holds unsaved changes.

    Parameters
    ----------
    folder : Path
        Where the windows of this user keep theirs; made when it is needed.
    told : callable
        Gets what went wrong, on any thread; the window works without all this.
    delay : float
        Seconds that changes are gathered.
    """

    def __init__(self, folder: Path, told: Callable[[str], None], delay: float = _DELAY) -> None:
        self._folder, self._told, self._delay = folder, told, delay
        self.file = folder / f"{os.getpid()}-{uuid.uuid4().hex[:8]}.json"
        self._lock: BinaryIO | None = None
        self._waiting: Kept | None = None
        self._ended = self._complained = False
        self._wake = threading.Condition()
        # Held while files change, so that what was forgotten is not written after all.
        self._writing = threading.Lock()
        self._thread: threading.Thread | None = None

    @property
    def busy(self) -> bool:
        """Whether what is to be kept is not written yet."""
        with self._writing, self._wake:
            return self._waiting is not None

    def keep(self, session: Session, path: Path | None) -> None:
        """Keep a session soon, on a thread of its own: a slow disk stops nobody.

        Parameters
        ----------
        session : Session
            As it is now.
        path : Path or None
            Its session file, if there is one.
        """
        kept = Kept(_anywhere(session), str(path.resolve()) if path else None, time.time())
        with self._wake:
            if self._ended:
                return
            self._waiting = kept
            if self._thread is None:
                self._thread = threading.Thread(
                    target=self._work, name="curvelight-recovery", daemon=True
                )
                self._thread.start()
            self._wake.notify()

    def forget(self) -> None:
        """Keep nothing, because there is nothing unsaved."""
        with self._wake:
            self._waiting = None
        with self._writing, suppress(OSError):
            self.file.unlink(missing_ok=True)

    def close(self) -> None:
        """End well: nothing is left for the next start."""
        with self._wake:
            self._ended = True
            self._wake.notify()
        self.forget()
        with self._writing:
            if self._lock is not None:
                _release(self._lock, self.file)
                self._lock = None

    def find(self) -> list[Left]:
        """Take what processes that are gone have left.

        Returns
        -------
        list of Left
            The newest first. What is neither adopted nor discarded is found again by the next
            process.
        """
        found = []
        with suppress(OSError):
            for old in self._folder.glob(".curvelight-*"):
                if time.time() - old.stat().st_mtime > _STALE:
                    old.unlink()
        # Not those that a crash left half written, whose names begin with a point.
        for file in self._folder.glob("[!.]*.json"):
            left = self._take(file) if file != self.file else None
            if left is not None:
                found.append(left)
        return sorted(found, key=lambda left: -left.kept.written)

    def adopt(self, left: Left) -> None:
        """Make what was left the own of this window, which shows it now.

        Parameters
        ----------
        left : Left
            From `find`.
        """
        with self._writing, suppress(OSError):
            self._hold()
            os.replace(left.file, self.file)
        _release(left.lock, left.file)

    def discard(self, left: Left) -> None:
        """Forget what was left for good.

        Parameters
        ----------
        left : Left
            From `find`.
        """
        with suppress(OSError):
            left.file.unlink(missing_ok=True)
        _release(left.lock, left.file)

    def _take(self, file: Path) -> Left | None:
        lock = None
        try:
            lock = locked(file.with_suffix(".lock"))
            if lock is None:  # its process lives, or another start was faster
                return None
            if not file.exists():  # another start has dealt with it
                _release(lock, file)
                return None
            return Left(file, msgspec.json.decode(file.read_bytes(), type=Kept), lock)
        except (OSError, msgspec.MsgspecError) as error:
            if lock is not None:
                _release(lock, file)
            self._told(f"{file}: a session left by a crash cannot be read ({error}); delete it")
            return None

    def _work(self) -> None:
        while True:
            with self._wake:
                while self._waiting is None and not self._ended:
                    self._wake.wait()
                # Later changes are written with the first: a long drag is kept while it lasts.
                self._wake.wait_for(lambda: self._ended, self._delay)
                if self._ended:
                    return
            with self._writing:
                with self._wake:
                    kept, self._waiting = self._waiting, None
                if kept is not None:
                    self._write(kept)

    def _write(self, kept: Kept) -> None:
        try:
            self._hold()
            write_bytes(self.file, msgspec.json.encode(kept))
            self._complained = False
        except (OSError, WriteError) as error:
            if not self._complained:
                self._complained = True
                self._told(f"changes are not kept in case of a crash: {error}")

    def _hold(self) -> None:
        if self._lock is None:
            self._folder.mkdir(parents=True, exist_ok=True)
            self._lock = locked(self.file.with_suffix(".lock"))


def _anywhere(session: Session) -> Session:
    if session.mesh.startswith("sample:"):
        return session
    return replace(session, mesh=str(Path(session.mesh).resolve()))


def _release(lock: BinaryIO, file: Path) -> None:
    # Closed first: Windows removes no file that is open.
    lock.close()
    with suppress(OSError):
        file.with_suffix(".lock").unlink(missing_ok=True)
