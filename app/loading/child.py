"""What `app.loading.guard` calls in the child process: a reader, its answer as arrays."""

import importlib

import numpy as np

from app.loading.errors import BadContentError
from lutcore.arrays import AnyArray


def read(module: AnyArray, content: AnyArray) -> dict[str, AnyArray]:
    """Call ``read(content)`` of a module.

    Parameters
    ----------
    module : ndarray of str, shape=()
        The reader's module.
    content : ndarray of uint8
        The whole file.

    Returns
    -------
    dict of str to ndarray
        The fields of the `RawSurface`, or the problem and the advice of a `BadContentError`.
    """
    try:
        surface = importlib.import_module(str(module)).read(content.tobytes())
    except BadContentError as error:
        return {"problem": np.array(error.problem), "advice": np.array(error.advice)}
    found = {name: getattr(surface, name) for name in ("vertices", "corners", "counts")}
    if surface.colors is not None:
        found["colors"] = surface.colors
    return {**found, "warnings": np.array(surface.warnings, dtype=np.str_)}
