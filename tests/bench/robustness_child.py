"""What `tests.bench.robustness` starts: one reader, file after file, judged.

Files are read in forks of this process, which has imported the reader: many by one fork, as long as
it lives. What a fork with a past dies of, or has no memory for, is read again by a fresh one. A
file is a ``mesh`` (finite positions, indices of vertices that exist), ``empty`` (success without
a face), ``refused``, ``garbage`` (neither finite nor in range, said to be fine) or beyond the
``memory``. Ours is ``unclear`` where its error does not name the file and a remedy in one line.
"""

import contextlib
import json
import math
import os
import resource
import selectors
import signal
import sys
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from tests.bench.robustness import ADDRESS_SPACE

Arrays = tuple[Any, Any]
_SLOWNESS = 4
_TERM = 60  # files, so that what leaks is not the next ones' lack of memory


def _ours(path: str) -> Iterator[Arrays]:
    from app.loading import load_mesh

    mesh = load_mesh(path).mesh
    yield mesh.vertices, mesh.faces


def _pyvista(path: str) -> Iterator[Arrays]:
    import pyvista

    waiting = [pyvista.read(path)]
    while waiting:
        data = waiting.pop()
        if isinstance(data, pyvista.MultiBlock):
            waiting.extend(block for block in data if block is not None)
        elif isinstance(data, pyvista.PolyData):
            cells = data.GetPolys(), data.GetStrips()
            for each in cells:
                yield data.points, pyvista.convert_array(each.GetConnectivityArray())
        elif isinstance(data, pyvista.UnstructuredGrid):
            yield data.points, data.cell_connectivity


def _trimesh(path: str) -> Iterator[Arrays]:
    import trimesh

    found = trimesh.load(path, process=False)
    parts = found.geometry.values() if isinstance(found, trimesh.Scene) else [found]
    for part in parts:
        if isinstance(part, trimesh.Trimesh):
            yield part.vertices, part.faces


def _meshio(path: str) -> Iterator[Arrays]:
    import meshio

    found = meshio.read(path)
    for block in found.cells:
        yield found.points, np.asarray(block.data)


def _pymeshlab(path: str) -> Iterator[Arrays]:
    import pymeshlab

    layers = pymeshlab.MeshSet()
    layers.load_new_mesh(path)
    for layer in layers:
        yield layer.vertex_matrix(), layer.face_matrix()


_READERS: dict[str, tuple[str, Callable[[str], Iterator[Arrays]]]] = {
    "curvelight": ("app.loading", _ours),
    "pyvista": ("pyvista", _pyvista),
    "trimesh": ("trimesh", _trimesh),
    "meshio": ("meshio", _meshio),
    "pymeshlab": ("pymeshlab", _pymeshlab),
}


def judged(reader: str, path: str) -> dict[str, Any]:
    """Read one file and return its outcome, with the error's words."""
    try:
        outcome = "empty"
        for points, corners in _READERS[reader][1](path):
            if corners is None or np.size(corners) == 0:
                continue
            if not is_sound(np.asarray(points, np.float64), np.asarray(corners)):
                return {"outcome": "garbage"}
            outcome = "mesh"
    except MemoryError:
        return {"outcome": "memory"}
    except (Exception, SystemExit) as error:
        if "bad_alloc" in str(error) or "Unable to allocate" in str(error):
            return {"outcome": "memory", "said": str(error)[:200]}
        return _refused(error, path) if reader == "curvelight" else {"outcome": "refused"}
    return {"outcome": outcome}


def is_sound(points: Any, corners: Any) -> bool:
    in_range = corners.min() >= 0 and corners.max() < len(points)
    return bool(in_range and np.isfinite(points).all())


def _refused(error: BaseException, path: str) -> dict[str, Any]:
    """Judge an error of ours: its kind, its words and the exit code they give."""
    from app.cli.main import exit_code
    from app.loading import UnreadableFileError
    from lutcore.errors import CurvelightError, MeshError

    said = str(error)
    if not isinstance(error, CurvelightError):
        return {"outcome": "unclear", "said": repr(error)[:300]}
    code = exit_code(error)
    if "memory" in said:
        return {"outcome": "memory", "said": said[-200:]}
    right = code == (3 if isinstance(error, UnreadableFileError) else 4)
    clear = said.startswith(f"{path}: ") and "\n" not in said and "; " in said
    fine = isinstance(error, MeshError) and right and clear
    return {"outcome": "refused" if fine else "unclear", "said": said[-300:], "code": code}


class Worker:
    """A fork of this process that reads one file after another."""

    def __init__(self, reader: str, seconds: float) -> None:
        self.past = 0
        self._seconds = seconds
        self._buffer = b""
        from_us, self._to = os.pipe()
        self._from, to_us = os.pipe()
        self._child = os.fork()
        if self._child == 0:
            try:
                os.close(self._to)
                os.close(self._from)
                _serve(reader, seconds, from_us, to_us)
            finally:
                os._exit(0)
        os.close(from_us)
        os.close(to_us)

    def read(self, path: str) -> dict[str, Any]:
        """Return what became of a file; unless ``alive``, the process has ended."""
        began = time.perf_counter()
        self.past += 1
        found: dict[str, Any] = {"outcome": "died"}
        with contextlib.suppress(OSError):
            os.write(self._to, path.encode() + b"\n")
        line = self._line(began + _SLOWNESS * self._seconds)
        if line is None:
            os.kill(self._child, signal.SIGKILL)
            found = {"outcome": "hung"}
        elif line:
            found = json.loads(line) | {"alive": True}
        if "alive" not in found:
            _, status, used = os.wait4(self._child, 0)
            found["peak_mib"] = used.ru_maxrss / 1024.0
            if os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGXCPU:
                found["outcome"] = "hung"
            elif found["outcome"] == "died":
                found["said"] = str(status)
            self._close()
        found["seconds"] = time.perf_counter() - began
        return found

    def _line(self, end: float) -> bytes | None:
        """Return an answer; empty if the process has gone, None if it took too long."""
        with selectors.DefaultSelector() as waiting:
            waiting.register(self._from, selectors.EVENT_READ)
            while b"\n" not in self._buffer:
                if not waiting.select(max(0.0, end - time.perf_counter())):
                    return None
                chunk = os.read(self._from, 1 << 16)
                if not chunk:
                    return b""
                self._buffer += chunk
        line, _, self._buffer = self._buffer.partition(b"\n")
        return line

    def stop(self) -> None:
        """End the process."""
        self._close()
        os.waitpid(self._child, 0)

    def _close(self) -> None:
        os.close(self._to)
        os.close(self._from)


def _serve(reader: str, seconds: float, lines: int, answers: int) -> None:
    """Read files by their names until there are none."""
    for line in os.fdopen(lines):
        # The processor's time: a loop without end is one on a busy machine, too.
        end = math.ceil(time.process_time() + seconds)
        resource.setrlimit(resource.RLIMIT_CPU, (end, resource.RLIM_INFINITY))
        with contextlib.suppress(OSError), open("/proc/self/clear_refs", "w") as peak:
            peak.write("5")  # the peak begins anew, where the system can do that
        found = judged(reader, line.rstrip("\n"))
        os.write(answers, json.dumps(found | {"peak_mib": _peak()}).encode() + b"\n")


def _peak() -> float:
    """Return the largest resident size since it was reset, or of a child of ours, MiB."""
    kib = 0
    with contextlib.suppress(OSError), open("/proc/self/status") as status:
        kib = next(int(line.split()[1]) for line in status if line.startswith("VmHWM:"))
    return max(kib, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss) / 1024.0


class Workers:
    """Reads files by one fork as long as it lives, and no longer than `_TERM` files.

    Each file may take so many seconds of the processor, and `_SLOWNESS` times as many of waiting.
    """

    def __init__(self, reader: str) -> None:
        self._reader = reader
        self._worker: Worker | None = None

    def read(self, path: str, seconds: float) -> dict[str, Any]:
        """Return what became of a file."""
        while True:
            worker = self._worker or Worker(self._reader, seconds)
            found = worker.read(path)
            alive = found.pop("alive", False)
            spent = alive and (worker.past >= _TERM or found["outcome"] == "memory")
            if spent:
                worker.stop()
            self._worker = worker if alive and not spent else None
            # Leaks and overwritten memory of the files before are not this file's.
            if found["outcome"] not in ("died", "memory") or worker.past == 1:
                return found

    def stop(self) -> None:
        """End what is running."""
        if self._worker is not None:
            self._worker.stop()


def main(reader: str) -> None:
    """Answer lines of seconds and a path until standard input ends; with 0 seconds, no fork."""
    # What a library prints must not come between answers, nor a library wait for a user.
    answers, lines = os.fdopen(os.dup(1), "w"), os.fdopen(os.dup(0))
    silent = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1):
        os.dup2(silent, stream)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
    __import__(_READERS[reader][0])
    workers = Workers(reader)
    for line in lines:
        seconds, _, path = line.rstrip("\n").partition(" ")
        limit = float(seconds)
        found = workers.read(path, limit) if limit else judged(reader, path)
        answers.write(json.dumps(found) + "\n")
        answers.flush()
    workers.stop()


if __name__ == "__main__":
    main(sys.argv[1])
