"""The child process of `app.loading.guard`: limits itself, reads, hands arrays back."""

import importlib
import json
import sys
from pathlib import Path

import numpy as np

from app.loading.errors import BadContentError


def main(module: str, folder: Path, memory: int) -> None:
    """Read ``content`` in a folder and leave ``answer.json`` and ``arrays.npz`` beside it.

    Parameters
    ----------
    module : str
        The reader's module.
    folder : Path
        Where the content lies and the answer goes.
    memory : int
        Bytes of address space that may be used, where the system can limit that.
    """
    _limit(memory)
    answer: dict[str, object]
    try:
        surface = importlib.import_module(module).read((folder / "content").read_bytes())
        arrays = {name: getattr(surface, name) for name in ("vertices", "corners", "counts")}
        if surface.colors is not None:
            arrays["colors"] = surface.colors
        np.savez(folder / "arrays.npz", **arrays)
        answer = {"warnings": surface.warnings}
    except BadContentError as error:
        answer = {"problem": error.problem, "advice": error.advice}
    except MemoryError:
        answer = {
            "problem": f"reading it takes more than {memory >> 30} GiB of memory",
            "advice": "check that it is not damaged, or decimate the mesh",
        }
    (folder / "answer.json").write_text(json.dumps(answer))


def _limit(memory: int) -> None:
    try:
        import resource
    except ImportError:  # Windows has no such limits
        return
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    if hard != resource.RLIM_INFINITY:
        memory = min(memory, hard)
    resource.setrlimit(resource.RLIMIT_AS, (memory, hard))


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), int(sys.argv[3]))
