"""Waits for files to change, by looking at them: that works on network folders too."""

import time
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

INTERVAL_S = 0.5
_Stamp = tuple[int, int] | None


def changes(
    paths: Callable[[], Iterable[Path]],
    interval: float = INTERVAL_S,
    sleep: Callable[[float], None] = time.sleep,
) -> Iterator[tuple[Path, ...]]:
    """Yield the files that changed, once they are written whole.

    Parameters
    ----------
    paths : callable
        Returns what to watch; asked again after each change, for one file may name another. A
        file that comes or goes has changed.
    interval : float
        Seconds between looks. A file that was the same at two looks is taken as whole.
    sleep : callable
        Waits so many seconds.

    Yields
    ------
    tuple of Path
        What changed: nothing the first time, which comes at once. What changes while the caller
        works is seen afterwards.
    """
    known = _stamps(paths())
    yield ()
    while True:
        sleep(interval)
        now = _stamps(known)
        if now == known:
            continue
        sleep(interval)
        while (later := _stamps(known)) != now:
            now = later
            sleep(interval)
        changed = tuple(path for path in known if known[path] != now[path])
        # What was being watched keeps the stamp that was reported, so that nothing is passed over.
        known = {path: now.get(path, stamp) for path, stamp in _stamps(paths()).items()}
        if changed:
            yield changed


def _stamps(paths: Iterable[Path]) -> dict[Path, _Stamp]:
    return {path: _stamp(path) for path in paths}


def _stamp(path: Path) -> _Stamp:
    try:
        found = path.stat()
    except (OSError, ValueError):
        return None
    return found.st_mtime_ns, found.st_size
