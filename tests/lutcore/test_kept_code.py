"""Machine code from the disk does all that code does which was compiled just now."""

import os
import subprocess
import sys

import pytest

MODULE = """
import numpy as np
from lutcore.compiled import compiled

@compiled()
def inner(values):
    if values.shape[0] == 0:
        raise ValueError("nothing there")
    return values[::-1].copy().sum()

@compiled()
def outer(values):
    return inner(values) + 1.0

@compiled(parallel=True)
def wide(values):
    return np.sqrt(values * values).sum()
"""
ASK = """
import sys
import numpy as np
import kept_example
from lutcore.compiling import when_compiling

when_compiling(lambda: print("compiles"))
for name in sys.argv[1:]:
    print(getattr(kept_example, name)(np.arange(4.0)))
    print("numba.np.arrayobj" in sys.modules)
try:
    getattr(kept_example, sys.argv[1])(np.empty(0))
except ValueError as error:
    print(error)
"""


@pytest.fixture
def asked(tmp_path):
    """Return a function that has functions called in a new process, all with one cache."""
    (tmp_path / "kept_example.py").write_text(MODULE)
    paths = os.pathsep.join(filter(None, [str(tmp_path), os.environ.get("PYTHONPATH", "")]))
    variables = os.environ | {"PYTHONPATH": paths, "CURVELIGHT_CACHE_DIR": str(tmp_path / "cache")}

    def ask(*names):
        command = [sys.executable, "-c", ASK, *names]
        done = subprocess.run(command, env=variables, capture_output=True, text=True, check=True)
        return done.stdout.splitlines()

    return ask


def test_kept_code_computes_and_raises_without_what_was_inlined(asked):
    assert asked("inner", "wide") == ["compiles", "6.0", "True", "6.0", "True", "nothing there"]
    assert asked("inner", "wide") == ["6.0", "False", "6.0", "False", "nothing there"]


def test_what_is_compiled_later_is_linked_with_kept_code_and_kept_again(asked):
    asked("inner")
    assert asked("inner", "outer")[:-1] == ["6.0", "False", "compiles", "7.0", "True"]
    assert asked("outer") == ["7.0", "False", "nothing there"]
