"""Meshes for batches: small good ones, broken ones, and ones that a plug-in dies of.

The plug-in stands for foreign code: a package of its own, found by its entry point in whatever
process loads it. What it does follows from the number of vertices.
"""

import os
from pathlib import Path

import numpy as np

from sample_meshes.ply import write_ply

METHOD = "deadly"
CRASH, HANG, EAT = 6, 7, 8
"""Sides of the sheets that end the process, never return, and take memory without end."""
_PLUGIN = '''
"""Estimates as rusinkiewicz2004 does, but for some meshes."""

import os
import signal
import time
from dataclasses import dataclass

import numpy as np

from lutcore.estimation import EstimatorParameters, estimator_registry


@estimator_registry.register("deadly")
@dataclass(frozen=True)
class Deadly(EstimatorParameters):
    """Ends badly for some numbers of vertices."""

    def estimate(self, mesh, scale, progress):
        from lutcore.parameters import create

        count = len(mesh.vertices)
        if count == 36:
            os.kill(os.getpid(), signal.SIGSEGV)
        while count == 49:
            time.sleep(1.0)
        held = []
        while count == 64:
            held.append(np.ones(4 << 20))  # 32 MiB
            time.sleep(0.01)
        other = create(estimator_registry.get("rusinkiewicz2004"), "estimator", {})
        return other.estimate(mesh, scale, progress)
'''


def install(folder: Path) -> dict[str, str]:
    """Install the plug-in into a folder; return the variables that make processes find it."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "deadly_curvature.py").write_text(_PLUGIN)
    about = folder / "deadly_curvature-1.0.dist-info"
    about.mkdir(exist_ok=True)
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: deadly-curvature\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text(
        f"[curvelight.curvature]\n{METHOD} = deadly_curvature:Deadly\n"
    )
    paths = [str(folder), *os.environ.get("PYTHONPATH", "").split(os.pathsep)]
    return {"PYTHONPATH": os.pathsep.join(filter(None, paths))}


def sheet(path: Path, side: int, seed: int = 0) -> Path:
    """Write a bent sheet of side x side vertices, another one for each seed."""
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(0.0, 10.0, side), np.linspace(0.0, 10.0, side))
    bend, phase = random.uniform(0.5, 1.5), random.uniform(0.0, 6.0)
    z = bend * np.sin(x / 2.0 + phase) * np.cos(y / 3.0)
    corner = np.arange(side * side).reshape(side, side)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]
    faces = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)]).reshape(-1, 3)
    write_ply(path, np.stack([x, y, z], -1).reshape(-1, 3), faces)
    return path


def broken(path: Path, kind: int) -> Path:
    """Write a file that holds no mesh: cut short, empty, no mesh at all, or without an area."""
    sheet(path, 12)
    content = path.read_bytes()
    flat = b"ply\nformat ascii 1.0\nelement vertex 3\n" + b"".join(
        b"property float %c\n" % axis for axis in b"xyz"
    )
    flat += b"element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    flat += b"1 1 1\n1 1 1\n1 1 1\n3 0 1 2\n"
    path.write_bytes((content[: len(content) // 2], b"", b"not a mesh", flat)[kind % 4])
    return path
