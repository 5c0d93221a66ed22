"""Which lines of the readers run, and after which: what guides the search."""

import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import app.loading

_FOLDER = str(Path(app.loading.__file__).parent)


class Lines:
    """Records pairs of lines of `app.loading` that ran one after the other."""

    def __init__(self) -> None:
        self.seen: set[tuple[int, int, int]] = set()
        self._here: set[tuple[int, int, int]] = set()
        self._ours: dict[Any, int] = {}

    def new_by(self, call: Callable[[], None]) -> int:
        """Run a call and return how many pairs it was the first to reach."""
        self._here = set()
        before = sys.gettrace()
        sys.settrace(self._enter)
        try:
            call()
        finally:
            sys.settrace(before)
            new = len(self._here - self.seen)
            self.seen |= self._here
        return new

    def _enter(self, frame: FrameType, event: str, argument: Any) -> Any:
        code = frame.f_code
        number = self._ours.get(code)
        if number is None:
            number = len(self._ours) + 1 if code.co_filename.startswith(_FOLDER) else 0
            self._ours[code] = number
        if number == 0:
            return None
        last = 0
        here = self._here

        def line(frame: FrameType, event: str, argument: Any) -> Any:
            nonlocal last
            if event == "line":
                here.add((number, last, frame.f_lineno))
                last = frame.f_lineno
            return line

        return line
