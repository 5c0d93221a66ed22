"""Memory that was freed, given back to the system. Knows no Qt."""

import ctypes
import sys
from contextlib import suppress


def give_back() -> None:
    """Return to the system what the allocator keeps of freed memory, where it has to be asked.

    What computing needs for a moment is freed below what was made meanwhile and stays: glibc gives
    back by itself only what lies at the end of its heaps.
    """
    if sys.platform == "linux":
        with suppress(AttributeError):  # not every C library has it
            ctypes.CDLL(None).malloc_trim(0)
