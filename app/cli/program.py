"""The installed command: `app.cli.main` in a process that does nothing else."""

import atexit
import gc
import os
import sys
from contextlib import suppress

from app.cli.main import main

# Imports make some 100 000 objects that stay; looking them through again and again takes a
# tenth of a command's time.
_OBJECTS = 50_000
_SHORTEST = "4"  # as a power of two, in ticks of the processor's clock


def program() -> int:
    """Run the command line that this process was started with.

    Returns
    -------
    int
        Exit code; see `app.cli.main.main`.
    """
    # NumPy's threads wait for the next product by spinning, on a core that other work needs.
    os.environ.setdefault("OPENBLAS_THREAD_TIMEOUT", _SHORTEST)
    gc.set_threshold(_OBJECTS)
    leave = _Leave()
    # The first to be registered is the last to be called.
    atexit.register(leave)
    leave.code = main()
    return leave.code


class _Leave:
    """Ends the process without taking it apart, which takes a quarter of a second."""

    code: int | None = None

    def __call__(self) -> None:
        if self.code is None:
            return
        for stream in (sys.stdout, sys.stderr):
            # A reader that left wants nothing more; without a console there is no stream.
            with suppress(OSError, ValueError, AttributeError):
                stream.flush()
        os._exit(self.code)
