"""The session that flags begin at."""

from pathlib import Path

from app import session as state
from app.animation_motion import SUFFIXES
from app.session import Session


def started(path: Path | None) -> Session:
    """Return the session to start from.

    Parameters
    ----------
    path : Path or None
        A session file, or a picture or animation that Curvelight wrote.

    Returns
    -------
    Session
        The file's, the picture's, or the default.

    Raises
    ------
    SessionError
        If it cannot be read or holds no session.
    """
    if path is None:
        return Session()
    if path.suffix.lower() == ".png":
        from app.provenance import read_record

        return read_record(path).record.session
    if path.suffix.lower() in SUFFIXES:
        from app.animation_files import read_film

        return read_film(path).record.session
    return state.read(path)
