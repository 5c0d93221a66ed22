"""Run a reader that may crash, hang or eat the memory in a child process."""

import numpy as np

from app.loading.errors import BadContentError
from app.loading.surface import RawSurface
from lutcore.isolated import IsolatedError, run_isolated

# Reading takes about 10 ns a byte; the rest is Python's start on a busy machine.
_SECONDS, _SECONDS_PER_BYTE = 60.0, 1e-6
# VTK's libraries alone map 1 GiB; a compressed file may unfold to many times its size.
_BYTES, _BYTES_PER_BYTE = 4 << 30, 64


def read_guarded(module: str, content: bytes) -> RawSurface:
    """Call ``read(content)`` of a module in a child process with limits.

    Parameters
    ----------
    module : str
        The module: ``"app.loading.vtp_vtk"``.
    content : bytes
        The whole file.

    Returns
    -------
    RawSurface
        What the reader returned.

    Raises
    ------
    BadContentError
        If the reader raised it, crashed, or went beyond its time or memory.
    """
    try:
        found = run_isolated(
            "app.loading.child:read",
            {"module": np.array(module), "content": np.frombuffer(content, np.uint8)},
            label="its reader",
            seconds=_SECONDS + _SECONDS_PER_BYTE * len(content),
            memory=_BYTES + _BYTES_PER_BYTE * len(content),
        )
    except IsolatedError as error:
        raise BadContentError(str(error)) from None
    if "problem" in found:
        raise BadContentError(str(found["problem"]), str(found["advice"]))
    return RawSurface(
        found["vertices"],
        found["corners"],
        found["counts"],
        found.get("colors"),
        found["warnings"].tolist(),
    )
