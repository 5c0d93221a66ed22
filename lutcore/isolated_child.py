"""The child process of `lutcore.isolated`: limits itself, calls, hands arrays back.

Imports as little as it can: its start is part of every call.
"""

import importlib
import io
import json
import os
import sys
from collections.abc import Mapping
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

JOB, PROBLEM, SHORTAGE = "isolated job", "isolated problem", "isolated shortage"
# How C++, VTK, NumPy and the system say that there was no memory.
_SHORTAGES = (
    "bad_alloc",
    "bad_array_new_length",
    "Unable to allocate",
    "Cannot allocate memory",
    "failed to map segment",
)
_HEADER = 8  # bytes that tell the length of what follows


def pack(arrays: Mapping[str, NDArray[Any]]) -> memoryview:
    """Return arrays as bytes.

    Parameters
    ----------
    arrays : mapping of str to ndarray
        Arrays by name, none of objects.

    Returns
    -------
    memoryview
        An npz archive, not compressed.
    """
    out = io.BytesIO()
    np.savez(out, allow_pickle=False, **arrays)
    return out.getbuffer()


def unpack(content: bytes) -> dict[str, NDArray[Any]]:
    """Return the arrays that `pack` made bytes of.

    Parameters
    ----------
    content : bytes
        An npz archive.

    Returns
    -------
    dict of str to ndarray
        Arrays by name.
    """
    with np.load(io.BytesIO(content), allow_pickle=False) as found:
        return dict(found)


def send(pipe: IO[bytes], content: memoryview) -> None:
    """Write a message.

    Parameters
    ----------
    pipe : file
        Where to.
    content : memoryview
        The message.
    """
    pipe.write(len(content).to_bytes(_HEADER, "little"))
    pipe.write(content)
    pipe.flush()


def receive(pipe: IO[bytes]) -> bytes | None:
    """Read a message.

    Parameters
    ----------
    pipe : file
        Where from.

    Returns
    -------
    bytes or None
        The message; None if the other side has gone.
    """
    header = pipe.read(_HEADER)
    if len(header) < _HEADER:
        return None
    size = int.from_bytes(header, "little")
    content = pipe.read(size)
    return content if len(content) == size else None


def short(said: str) -> bool:
    """Tell whether words of foreign code are of memory that it did not get.

    Parameters
    ----------
    said : str
        An error's text, or what a process wrote before it crashed.

    Returns
    -------
    bool
        True if they are.
    """
    return any(words in said for words in _SHORTAGES)


def main() -> None:
    """Answer jobs until the other side has gone."""
    # What a library prints must not come between the bytes of an answer.
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    while (content := receive(sys.stdin.buffer)) is not None:
        send(answers, pack(_answer(unpack(content))))


def _answer(arrays: dict[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    job = json.loads(str(arrays.pop(JOB)))
    module, name = job["function"].split(":")
    _limit(job["memory"])
    try:
        found: dict[str, NDArray[Any]] = getattr(importlib.import_module(module), name)(**arrays)
        return found
    except MemoryError:
        return {SHORTAGE: np.array(True)}
    except Exception as error:  # whatever it is, it must reach the caller as words
        if short(str(error)):
            return {SHORTAGE: np.array(True)}
        words = " ".join(str(error).split())  # a message is one line
        return {PROBLEM: np.array(f"failed on it ({type(error).__name__}: {words})")}


def _limit(memory: int) -> None:
    try:
        import resource
    except ImportError:  # Windows has no such limits
        return
    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    if hard != resource.RLIM_INFINITY:
        memory = min(memory, hard)
    resource.setrlimit(resource.RLIMIT_AS, (memory, hard))


if __name__ == "__main__":
    main()
