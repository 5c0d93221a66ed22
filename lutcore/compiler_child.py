"""The child process of `lutcore.compiler`: compiles what it is told, which keeps it on the disk."""

import importlib
import os
import pickle
import sys

from numba.core.dispatcher import Dispatcher

from lutcore.isolated_child import receive, send


def main() -> None:
    """Compile until the other side has gone."""
    # What a library prints must not come between the bytes of an answer.
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    while (content := receive(sys.stdin.buffer)) is not None:
        module, name, signature = pickle.loads(content)  # noqa: S301  from the one who started us
        _named(module, name).compile(signature)
        send(answers, memoryview(b"compiled"))


def _named(module: str, name: str) -> Dispatcher:
    """Return what a module has compiled of a function: it may have another name there."""
    found = vars(importlib.import_module(module)).values()
    return next(
        one for one in found if isinstance(one, Dispatcher) and one.py_func.__qualname__ == name
    )


if __name__ == "__main__":
    main()
