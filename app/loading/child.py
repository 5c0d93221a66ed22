"""What `app.loading.guard` calls in the child process: a reader, its answer as arrays."""

import importlib
from pathlib import Path

import numpy as np

from app.loading.errors import BadContentError
from lutcore.arrays import AnyArray
from lutcore.errors import MeshError


def read(
    module: AnyArray,
    seconds: AnyArray,
    content: AnyArray | None = None,
    path: AnyArray | None = None,
) -> dict[str, AnyArray]:
    """Call ``read(content)`` or ``read(path)`` of a module.

    Parameters
    ----------
    module : ndarray of str, shape=()
        The reader's module.
    seconds : ndarray of int, shape=()
        Time of the processor that it may take, where the system can limit that.
    content : ndarray of uint8, or None
        The whole file.
    path : ndarray of str, shape=(), or None
        The file, for a reader that needs one.

    Returns
    -------
    dict of str to ndarray
        The fields of the `RawSurface`, or the problem and the advice of a `BadContentError`, or
        what a `MeshError` says.
    """
    _limit(int(seconds))
    reader = importlib.import_module(str(module)).read
    try:
        surface = reader(Path(str(path))) if content is None else reader(content.tobytes())
    except BadContentError as error:
        return {"problem": np.array(error.problem), "advice": np.array(error.advice)}
    except MeshError as error:
        return {"no surface": np.array(str(error))}
    found = {name: getattr(surface, name) for name in ("vertices", "corners", "counts")}
    if surface.colors is not None:
        found["colors"] = surface.colors
    return {**found, "warnings": np.array(surface.warnings, dtype=np.str_)}


def _limit(seconds: int) -> None:
    try:
        import resource
    except ImportError:  # Windows has no such limits
        return
    hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
    if hard != resource.RLIM_INFINITY:
        seconds = min(seconds, hard)
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, hard))
