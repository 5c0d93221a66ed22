"""What every step does with its results: compute once, keep the last few."""

from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import TypeVar, cast

import msgspec

from lutcore.progress import Progress, silent

T = TypeVar("T")
# Of each kind of step, the last few results, enough for four views side by side; a light that is
# dragged pushes out nothing else.
_KEPT = 4
# Inputs are made in a millisecond of what others keep, and would hold that beyond its time.
_KEPT_OF = {"exitance": 8, "light": 8, "inputs": 2}


class Kept:
    """Keeps the last few results of each step.

    Parameters
    ----------
    progress : callable
        Told where long work stands; see `lutcore.progress`.
    """

    def __init__(self, progress: Progress = silent) -> None:
        self.progress = progress
        self._kept: dict[str, OrderedDict[Hashable, object]] = {}

    def once(self, key: tuple[Hashable, ...], compute: Callable[[], T]) -> T:
        """Return what a step gave, computed at most once while it is kept.

        Parameters
        ----------
        key : tuple
            The step's name, and all that its result depends on.
        compute : callable
            Gives the result.

        Returns
        -------
        object
            The result.
        """
        step = str(key[0])
        kept = self._kept.setdefault(step, OrderedDict())
        if key not in kept:
            kept[key] = compute()
            while len(kept) > _KEPT_OF.get(step, _KEPT):
                kept.popitem(last=False)
        kept.move_to_end(key)
        return cast(T, kept[key])


def key_of(part: object) -> bytes:
    """Return what tells one part of a session from others.

    Parameters
    ----------
    part : object
        Plain data.

    Returns
    -------
    bytes
        Equal for equal parts.
    """
    return msgspec.json.encode(part, order="sorted")
