"""What keeps a picture from being drawn again."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from app.provenance import PictureError
from app.record import Record
from app.samples import PREFIX
from app.session import Session
from app.versions import MAKER
from lutcore.errors import ParameterError


@contextmanager
def redrawing(path: Path, record: Record, edited: bool) -> Iterator[None]:
    """Say what keeps a picture from being drawn again.

    Parameters
    ----------
    path : Path
        Its file.
    record : Record
        How it was made.
    edited : bool
        Whether its metadata were edited.

    Yields
    ------
    None
        To draw in.

    Raises
    ------
    PictureError
        If its mesh is not there, or a name or value in its record is not known here.
    """
    session: Session = record.session
    if not session.mesh.startswith(PREFIX) and not Path(session.mesh).exists():
        raise PictureError(
            f"{path}: its mesh is not at {session.mesh}; say where it is: --mesh FILE"
        )
    try:
        yield
    except ParameterError as error:
        reason = (
            "its metadata were edited after it was written"
            if edited
            else f"install what drew it, Curvelight {record.versions.get(MAKER)} and its plug-ins"
        )
        raise PictureError(f"{path}: cannot be redrawn: {error}; {reason}") from None
