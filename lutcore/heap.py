"""Freed memory that is kept for the next call, where glibc would give it back each time."""

from functools import lru_cache

import numpy as np

# Arrays up to here get no pages of their own; a million vertices' vectors do, whose large pages are
# worth more. It may not exceed glibc's 32 MiB.
_LARGE = 22 * 2**20


@lru_cache(maxsize=1)
def keep_freed() -> None:
    """Let the allocator keep up to 44 MiB of what was freed; once in a process.

    As soon as more than twice its largest freed array is free at the end of its heap, glibc gives
    all of that back to the system, and the next call gets the same pages anew, emptied one by one:
    a tenth of its time on a mesh of 86,000 vertices. A larger array is asked for and freed before:
    no page of it is ever touched. Other allocators take no notice, nor does one that was told its
    threshold.
    """
    np.empty(_LARGE, np.uint8)
