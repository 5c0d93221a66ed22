"""Run a reader that may crash, hang or eat the memory in a child process."""

import math
import tempfile
from pathlib import Path

import numpy as np

from app.loading.errors import BadContentError
from app.loading.surface import RawSurface
from lutcore.arrays import AnyArray
from lutcore.errors import MeshError
from lutcore.isolated import IsolatedError, ShortageError, run_isolated

# Reading takes about 10 ns a byte in VTK, 1 us in Python, the start half a second. A loop without
# end is stopped by the processor's time, however busy the machine is; waiting, by the clock.
_SECONDS, _SECONDS_PER_BYTE = 10.0, 3e-6
_SLOWNESS = 6
# VTK's libraries alone map 1 GiB; a compressed file may unfold to many times its size.
_BYTES, _BYTES_PER_BYTE = 4 << 30, 64
# A reader's complaint goes into one line.
_LONGEST = 300
_REMEDY = (
    "decimate it or convert it to PLY, which is read without such a limit; if it should be small, "
    "it is damaged: copy or export it again"
)


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
    lutcore.errors.MeshError
        If the reader raised it: there is no surface.
    """
    return _called(module, {"content": np.frombuffer(content, np.uint8)}, len(content))


def read_file_guarded(module: str, content: bytes, suffix: str) -> RawSurface:
    """Call ``read(path)`` of a module in a child process with limits, for readers of files.

    Parameters
    ----------
    module : str
        The module: ``"app.loading.meshio_child"``.
    content : bytes
        The whole file.
    suffix : str
        Ending of the file's name, by which the reader tells its format.

    Returns
    -------
    RawSurface
        What the reader returned.

    Raises
    ------
    BadContentError
        If the reader raised it, crashed, or went beyond its time or memory.
    lutcore.errors.MeshError
        If the reader raised it: there is no surface.
    """
    # In a folder of its own, where it finds no other files; removed here, whatever becomes of it.
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"mesh.{suffix}"
        path.write_bytes(content)
        return _called(module, {"path": np.array(str(path))}, len(content))


def _called(module: str, arguments: dict[str, AnyArray], size: int) -> RawSurface:
    seconds = math.ceil(_SECONDS + _SECONDS_PER_BYTE * size)
    memory = _BYTES + _BYTES_PER_BYTE * size
    try:
        found = run_isolated(
            "app.loading.child:read",
            {"module": np.array(module), "seconds": np.array(seconds), **arguments},
            label="its reader",
            seconds=_SLOWNESS * seconds,
            memory=memory,
        )
    except ShortageError:
        raise BadContentError(
            f"needs more than {memory >> 30} GiB of memory to read, and has {_large(size)}", _REMEDY
        ) from None
    except IsolatedError as error:
        if "SIGXCPU" in str(error):
            raise BadContentError(f"its reader took more than {seconds} s") from None
        raise BadContentError(" ".join(str(error).split())[:_LONGEST]) from None
    if "no surface" in found:
        raise MeshError(str(found["no surface"]))
    if "problem" in found:
        raise BadContentError(str(found["problem"]), str(found["advice"]))
    return RawSurface(
        found["vertices"],
        found["corners"],
        found["counts"],
        found.get("colors"),
        found["warnings"].tolist(),
    )


def _large(size: int) -> str:
    return f"{size / 2**20:.1f} MiB" if size >= 2**20 else f"{size:,} bytes"
