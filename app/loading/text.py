"""Numbers in text, read fast, and found again when one of them is none."""

import re

import numpy as np

from app.loading.errors import BadContentError
from lutcore.arrays import AnyArray, FloatArray

_FRACTIONS = re.compile(rb"[.eEnN]")
_IS_BLANK = np.isin(np.arange(256), np.frombuffer(b" \t\n\r\v\f", np.uint8))


def numbers(text: bytes, first_line: int | None = 1) -> FloatArray:
    """Read all numbers of a text, separated by white space.

    Parameters
    ----------
    text : bytes
        Numbers only.
    first_line : int or None
        Line of the file at which the text starts, for messages; None if its lines are not those
        of the file.

    Returns
    -------
    ndarray of float64, shape=(n,)
        The numbers.

    Raises
    ------
    BadContentError
        If anything else is among them; it says what and in which line.
    """
    if not text.strip():
        return np.empty(0)
    # Ten times as fast without fractions; what int64 cannot hold comes back as its limits, and a
    # sign without digits at the end as 0.
    whole_only = not _FRACTIONS.search(text) and text.rstrip()[-1:] not in (b"-", b"+")
    dtype = np.int64 if whole_only else np.float64
    try:
        found = np.fromstring(text, dtype=dtype, sep=" ")
    except (DeprecationWarning, ValueError):
        raise _culprit(text, first_line) from None
    # Older NumPy returns what came before text that is no number, with a DeprecationWarning.
    # Counted, since what becomes of warnings is the whole process's choice, not one thread's.
    if len(found) != _word_count(text):
        raise _culprit(text, first_line)
    return found.astype(np.float64, copy=False)


def _word_count(text: bytes) -> int:
    blank = _IS_BLANK[np.frombuffer(text, np.uint8)]
    return int(np.count_nonzero(blank[:-1] & ~blank[1:])) + int(not blank[0])


def _culprit(text: bytes, first_line: int | None) -> BadContentError:
    lines = text.replace(b"\r\n", b"\n").replace(b"\r", b"\n").split(b"\n")
    for number, line in enumerate(lines):
        for word in line.split():
            try:
                float(word)
            except ValueError:
                shown = word[:40].decode("ascii", "backslashreplace")
                where = "" if first_line is None else f"line {first_line + number}: "
                return BadContentError(f"{where}{shown!r} is not a number")
    return BadContentError("it holds text where numbers are expected")


def whole(values: FloatArray, what: str) -> AnyArray:
    """Return numbers read from text as whole numbers.

    Parameters
    ----------
    values : ndarray of float64
        Numbers read from text.
    what : str
        What they are, for the message: ``"face indices"``.

    Returns
    -------
    ndarray of int64
        The same numbers.

    Raises
    ------
    BadContentError
        If one is not whole, or too large to be counted with.
    """
    # Comparison and not conversion: a NaN or 1e300 has no whole number. 2^53 is where float64
    # stops telling neighbours apart.
    good = np.abs(values) < 2.0**53
    good[good] = values[good] == np.floor(values[good])
    if not good.all():
        raise BadContentError(f"{values[np.argmin(good)]:g} stands among the {what}")
    return values.astype(np.int64)


def line_of(content: bytes, offset: int) -> int:
    """Return the line (from 1) in which a byte of a text lies.

    Parameters
    ----------
    content : bytes
        The whole text.
    offset : int
        Position of the byte.

    Returns
    -------
    int
        The line's number.
    """
    return content.count(b"\n", 0, offset) + 1


def note_open_end(content: bytes, warnings: list[str]) -> None:
    """Report a text whose last line is not ended: a number cut short looks like another number.

    Parameters
    ----------
    content : bytes
        The whole file.
    warnings : list of str
        Gets a line if there is no line end.
    """
    if content[-1:] not in (b"\n", b"\r"):
        warnings.append(
            "its last line has no line end: if it was cut short there, its last number is wrong"
        )
