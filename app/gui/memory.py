"""Memory that was freed, given back to the system. Knows no Qt."""

import ctypes
import sys
from contextlib import suppress

_LARGE = 2**20
"""Bytes of an array that gets pages of its own."""
_MMAP_THRESHOLD = -3  # of malloc.h


def keep_large_apart() -> None:
    """Let large arrays go back to the system as soon as they are freed.

    Left alone glibc takes them from its heaps once a few were freed, where a small one that was
    made meanwhile keeps all the space before it.
    """
    if sys.platform == "linux":
        with suppress(AttributeError):  # not every C library has it
            ctypes.CDLL(None).mallopt(_MMAP_THRESHOLD, _LARGE)


def give_back() -> None:
    """Return to the system what the allocator keeps of freed memory, where it has to be asked.

    What computing needs for a moment is freed below what was made meanwhile and stays: glibc gives
    back by itself only what lies at the end of its heaps.
    """
    if sys.platform == "linux":
        with suppress(AttributeError):  # not every C library has it
            ctypes.CDLL(None).malloc_trim(0)
