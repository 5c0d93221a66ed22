"""What a child process is told to do."""

from msgspec import Struct

from app.batch.plan import Work


class Task(Struct, frozen=True):
    """The work on one mesh, as the child gets it.

    Parameters
    ----------
    works : tuple of Work
        Their sessions name a file of this machine.
    pending : str
        The folder to draw into.
    origin : str
        The folder that pictures will lie in: they name their mesh as seen from there.
    thumbnail : str
        Name of a small copy of the first picture, for the contact sheet.
    """

    works: tuple[Work, ...]
    pending: str
    origin: str
    thumbnail: str


THUMBNAIL = (240, 200)
"""Most pixels of a small copy."""
COMPILING = ".compiling"
"""File in the pending folder that tells that machine code is being made, once on a machine."""
