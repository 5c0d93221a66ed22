"""Processes that are timed start as they do where packages are installed: with their bytecode."""

import os

_NO_BYTECODE = "PYTHONDONTWRITEBYTECODE"


def variables() -> dict[str, str]:
    """Return this process's variables without the one that has all sources read at each start.

    Peers have the bytecode that pip made of them; a checkout gets its own at the first run.
    """
    return {name: value for name, value in os.environ.items() if name != _NO_BYTECODE}
