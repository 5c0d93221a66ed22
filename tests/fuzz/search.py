"""Coverage-guided search for a file at which a reader of ours falls over.

Readers in Python only: what runs in a child process may crash there, and `tests.bench.robustness`
counts what comes of it.
"""

import re
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from app.loading import load_mesh
from lutcore.errors import MeshError
from tests.corpus.containers import container_mutations
from tests.corpus.mutations import MUTATIONS
from tests.fuzz.lines import Lines

# Files of 2 kB take milliseconds; tracing makes that ten times as long.
_SECONDS = 10.0
_LARGEST = 20_000
# Begins of what a child process would read.
_CHILD = re.compile(rb"# vtk DataFile|[\s\S]{0,4096}<VTKFile")


class TooSlowError(BaseException):
    """A file took longer than any file of its size may."""


@dataclass
class Search:
    """One search: what was tried, what it reached, what fell over.

    Parameters
    ----------
    files : dict of str to bytes
        Valid files by name, where it begins.
    seed : int
        Of the random numbers.
    folder : Path
        Where the file being read is written: it is still there if the process dies.
    """

    files: dict[str, bytes]
    seed: int
    folder: Path
    runs: int = 0
    faults: list[tuple[str, bytes, str]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.lines = Lines()
        self._random = np.random.default_rng(self.seed)
        self.kept: list[tuple[str, bytes]] = []
        for name, content in self.files.items():
            self._try(name, content)
            self.kept.append((name, content))

    def step(self) -> None:
        """Damage one of the kept files further, read it, keep it if it reached new lines."""
        # The latest finds as often as all others: they have been tried least.
        count = len(self.kept)
        start = count - 1 - count // 8 if self._random.random() < 0.5 else 0
        name, content = self.kept[int(self._random.integers(start, count))]
        other = self.kept[int(self._random.integers(0, count))][1]
        damaged = self._damaged(name, content, other)
        if not damaged or _CHILD.match(damaged):
            return
        if self._try(name, damaged):
            self.kept.append((name, damaged))

    def _damaged(self, name: str, content: bytes, other: bytes) -> bytes:
        special = container_mutations(name)
        special.pop("bomb", None)
        for _ in range(int(self._random.integers(1, 4))):
            pool = special if special and self._random.random() < 0.4 else MUTATIONS
            change = pool[list(pool)[int(self._random.integers(0, len(pool)))]]
            try:
                content = change(content, self._random, other)
            except Exception:  # damage inside what is too damaged to be opened
                return b""
            if not 0 < len(content) <= _LARGEST:
                return b""
        return content

    def _try(self, name: str, content: bytes) -> int:
        self.runs += 1
        path = self.folder / name
        path.write_bytes(content)
        try:
            with _alarm():
                return self.lines.new_by(lambda: _judge(path))
        except AssertionError as error:
            self.faults.append((name, content, f"silent garbage: {error}"))
        except TooSlowError:
            self.faults.append((name, content, f"more than {_SECONDS:g} s"))
        except MemoryError:
            self.faults.append((name, content, "MemoryError"))
        except Exception as error:
            self.faults.append((name, content, repr(error)[:300]))
        return 0


def _judge(path: Path) -> None:
    try:
        loaded = load_mesh(path)
    except MeshError as error:
        said = str(error)
        assert said.startswith(f"{path}: ") and "\n" not in said and "; " in said, said
        assert "not enough memory" not in said, said
        return
    vertices, faces = loaded.mesh.vertices, loaded.mesh.faces
    assert np.isfinite(vertices).all(), "a position is not finite"
    assert len(faces) and faces.min() >= 0 and faces.max() < len(vertices), "an index is wrong"
    if loaded.colors is not None:
        shares = loaded.colors
        assert shares.shape == vertices.shape, "colours do not fit the vertices"
        assert ((shares >= 0.0) & (shares <= 1.0)).all(), "a colour is not from 0 to 1"


@contextmanager
def _alarm() -> Iterator[None]:
    def stop(number: int, frame: Any) -> None:
        raise TooSlowError

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, _SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
