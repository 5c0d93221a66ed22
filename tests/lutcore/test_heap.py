import platform
import subprocess
import sys

import pytest

_CALLS = """
import numpy as np, psutil
from lutcore.heap import keep_freed
{keep}
resident = psutil.Process().memory_info
def call():
    arrays = [np.ones(2**18) for _ in range(20)]  # of 2 MiB
    full = resident().rss
    del arrays
    return full - resident().rss
call()
print(call())
"""


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="of glibc's allocator alone")
@pytest.mark.parametrize("keep", ["keep_freed()", ""])
def test_what_a_call_frees_is_there_for_the_next(keep):
    done = subprocess.run(
        [sys.executable, "-c", _CALLS.format(keep=keep)], capture_output=True, text=True, check=True
    )
    given_back = int(done.stdout)
    # Without it most of the 40 MiB go back and come again.
    assert given_back < 2 * 2**20 if keep else given_back > 20 * 2**20


def test_keeping_it_takes_none():
    # Its pages are never touched.
    script = (
        "import psutil; from lutcore.heap import keep_freed; r = psutil.Process().memory_info;"
        "b = r().rss; keep_freed(); print(r().rss - b)"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert int(done.stdout) < 2**20
