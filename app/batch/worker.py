"""A worker of a batch: draws one mesh after another until the other side has gone."""

import ctypes
import os
import signal
import sys
from contextlib import suppress
from importlib import import_module
from pathlib import Path

import msgspec

from lutcore.compiling import when_compiling
from lutcore.isolated_child import receive, send

WARM = b'"warm"'
"""The job of importing and loading what every mesh needs."""
_PR_SET_PDEATHSIG = 1
_NEEDED = (
    "app.batch.drawing",
    "app.failing",
    "numpy.ma",  # numba asks it of every array
    "PIL.PngImagePlugin",
    "vtkmodules.vtkRenderingAnnotation",
    "vtkmodules.vtkRenderingFreeType",
    "vtkmodules.vtkRenderingOpenGL2",
)


def main() -> None:
    """Answer jobs."""
    detach()
    # What a library prints must not come between the bytes of an answer.
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    jobs = os.fdopen(0, "rb", closefd=False)
    while (content := receive(jobs)) is not None:
        answer = _warm() if content == WARM else _answer(content)
        send(answers, memoryview(msgspec.json.encode(answer)))


def detach() -> None:
    """Leave Ctrl-C to the parent, but end with it, and leave no core dump."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(os, "setsid"):
        with suppress(OSError):
            os.setsid()  # a group of its own, so that its own children can be ended with it
    if sys.platform.startswith("linux"):
        # A parent that was killed cannot tell us, and nobody would take the result.
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    with suppress(ImportError):
        import resource

        hard = resource.getrlimit(resource.RLIMIT_CORE)[1]
        resource.setrlimit(resource.RLIMIT_CORE, (0, hard))


def prepare() -> None:
    """Import and find out what every mesh needs; no thread is started, so that forks are safe."""
    for name in _NEEDED:
        import_module(name)
    from app.session import Session
    from app.versions import versions

    versions(Session())


def _warm() -> dict[str, object]:
    from app.offscreen import keep_window

    prepare()
    keep_window()
    return {"ready": True}


def _answer(content: bytes) -> dict[str, object]:
    from app.batch.drawing import drawn
    from app.batch.memory import own
    from app.batch.task import COMPILING, Task

    task = msgspec.json.decode(content, type=Task)
    when_compiling(lambda: Path(task.pending, COMPILING).touch())
    return drawn(task) | {"memory": own()}


if __name__ == "__main__":
    main()
