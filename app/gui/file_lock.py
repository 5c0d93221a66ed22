"""A lock that the system gives back when its process ends, however it ends."""

import sys
from pathlib import Path
from typing import BinaryIO

if sys.platform == "win32":
    import msvcrt

    def _lock(stream: BinaryIO) -> None:
        msvcrt.locking(stream.fileno(), msvcrt.LK_NBLCK, 1)

else:
    import fcntl

    def _lock(stream: BinaryIO) -> None:
        fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)


def locked(path: Path) -> BinaryIO | None:
    """Take the lock of a file.

    Parameters
    ----------
    path : Path
        The file; it is made if it is not there.

    Returns
    -------
    file or None
        Holds the lock until it is closed; None if somebody has it, in this process or another.

    Raises
    ------
    OSError
        If the file cannot be opened.
    """
    stream = path.open("ab")
    try:
        _lock(stream)
    except (BlockingIOError, PermissionError):
        stream.close()
        return None
    except OSError:
        stream.close()
        raise
    return stream
