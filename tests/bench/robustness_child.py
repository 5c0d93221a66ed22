"""What `tests.bench.robustness` starts: one reader, file after file, judged.

A file is a ``mesh`` (finite positions, indices of vertices that exist), ``empty`` (success without
a face), ``refused``, ``garbage`` (neither finite nor in range, said to be fine) or beyond the
``memory``. Ours is ``unclear`` where its error does not name the file and a remedy in one line.
"""

import json
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


def in_fork(reader: str, path: str, seconds: float) -> dict[str, Any]:
    """Read one file in a fork of this process, and return what became of it and what it took."""
    began = time.perf_counter()
    from_child, to_parent = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.write(to_parent, json.dumps(judged(reader, path)).encode())
        finally:
            os._exit(0)
    os.close(to_parent)
    with selectors.DefaultSelector() as waiting:
        waiting.register(from_child, selectors.EVENT_READ)
        # Ready, too, when the child is gone and the pipe closed.
        in_time = bool(waiting.select(seconds))
    if not in_time:
        os.kill(child, signal.SIGKILL)
    said = os.read(from_child, 1 << 16) if in_time else b'{"outcome": "hung"}'
    os.close(from_child)
    _, status, used = os.wait4(child, 0)
    found: dict[str, Any] = json.loads(said) if said else {"outcome": "died", "said": str(status)}
    found["seconds"] = time.perf_counter() - began
    found["peak_mib"] = used.ru_maxrss / 1024.0
    return found


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
    for line in lines:
        seconds, _, path = line.rstrip("\n").partition(" ")
        limit = float(seconds)
        found = in_fork(reader, path, limit) if limit else judged(reader, path)
        answers.write(json.dumps(found) + "\n")
        answers.flush()


if __name__ == "__main__":
    main(sys.argv[1])
