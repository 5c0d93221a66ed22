"""Whether a command can write what a file's ending asks for."""

from collections.abc import Collection
from pathlib import Path

from lutcore.errors import ParameterError


def check_ending(path: Path, known: Collection[str]) -> None:
    """Make sure that a file's ending is one of those that can be written.

    Parameters
    ----------
    path : Path
        The file.
    known : collection of str
        Endings in small letters, with their dots.

    Raises
    ------
    ParameterError
        If it ends otherwise.
    """
    if path.suffix.lower() not in known:
        raise unknown_ending(path, known)


def unknown_ending(path: Path, known: Collection[str]) -> ParameterError:
    """Return what to say of a file whose ending cannot be written.

    Parameters
    ----------
    path, known
        See `check_ending`.

    Returns
    -------
    ParameterError
        For PDF with the way to one, where a page can be written.
    """
    if path.suffix.lower() == ".pdf" and ".html" in known:
        return ParameterError(
            f"{path}: PDF is not written; write -o {path.with_suffix('.html')} and print that "
            "from a browser"
        )
    return ParameterError.unknown("output format", path.suffix or path.name, known)
