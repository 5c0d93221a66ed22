"""Results that follow from a few numbers and take long, kept from one process to the next.

A table, a fit or a filter takes milliseconds to work out, and a third of a second where SciPy must
be imported for it: longer than all else that shading a small mesh takes.
"""

import hashlib
import os
import pickle
import tempfile
from collections.abc import Callable
from contextlib import suppress
from dataclasses import fields, is_dataclass
from functools import lru_cache, wraps
from pathlib import Path
from typing import ParamSpec, TypeVar

import numpy as np

from lutcore.cache import folder, sources

P = ParamSpec("P")
R = TypeVar("R")


def kept(function: Callable[P, R]) -> Callable[P, R]:
    """Keep what a function returns: while the process lives, and on the disk.

    Parameters
    ----------
    function : callable
        Of `lutcore` or a plug-in, depending on nothing but its arguments. Those are hashable and
        say themselves exactly, as frozen dataclasses of numbers and names do. If one comes from
        another package, whose code is not known here, the result is kept for the process alone.

    Returns
    -------
    callable
        Gives the same object for the same arguments, to the last bit the same in every process.
    """

    @lru_cache(maxsize=256)
    @wraps(function)
    def found(*arguments: P.args, **named: P.kwargs) -> R:
        if not all(map(_known, (*arguments, *named.values()))):
            return _shared(function(*arguments, **named))
        said = (
            f"{function.__module__}.{function.__qualname__} {arguments!r} {sorted(named.items())!r}"
        )
        place = _folder() / hashlib.sha256(said.encode()).hexdigest()[:32]
        # Whatever is wrong with the file, it is made anew.
        with suppress(Exception):
            stored, result = pickle.loads(place.read_bytes())  # noqa: S301  the user's own folder
            if stored == said:
                return _shared(result)
        result = _shared(function(*arguments, **named))
        with suppress(OSError):  # a full disk hinders no result
            _write(place, pickle.dumps((said, result)))
        return result

    return found  # type: ignore[return-value]


def _shared(result: R) -> R:
    """Return a result whose arrays cannot be written: all who ask get the same one."""
    if isinstance(result, np.ndarray):
        result.setflags(write=False)
    elif isinstance(result, tuple | list):
        for part in result:
            _shared(part)
    elif is_dataclass(result):
        for field in fields(result):
            _shared(getattr(result, field.name))
    return result


def _known(argument: object) -> bool:
    package = type(argument).__module__.partition(".")[0]
    return package in ("builtins", "lutcore", "plugins")


@lru_cache(maxsize=1)
def _folder() -> Path:
    import numpy
    import scipy

    return folder("tables", sources().every, numpy.__version__, scipy.__version__)


def _write(place: Path, content: bytes) -> None:
    handle, beside = tempfile.mkstemp(dir=place.parent)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(content)
        os.replace(beside, place)
    except OSError:
        os.unlink(beside)
        raise
