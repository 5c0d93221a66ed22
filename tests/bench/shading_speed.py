"""Speed and memory of `shade`: python -m tests.bench.shading_speed [--size N] [--json].

Times are the best of several runs in one process: nanoseconds per vertex, and per vertex, light and
channel, of the compiled models and of plain NumPy; ratios are between runs of this process. Models
that gather take what the mesh asks for: theirs is of 2000 vertices, in NumPy at some of them.
Memory is taken in a child process, from the resident size before the call to the peak after it,
less the output: an upper bound, because the peak may be older. POSIX.
"""

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numba
import numpy as np
import psutil  # type: ignore[import-untyped]

from lutcore.curvature import PrincipalCurvatures
from lutcore.exitance import shade
from lutcore.lights import ConeLight, DirectionalLight, Light, PointLight
from lutcore.mesh import TriangleMesh
from lutcore.shading import model_registry, shading_models
from tests import numpy_shading
from tests.surfaces import torus

MATERIAL = "skin1"
OUTPUT_BYTES = 24
INPUTS = ("k1", "k2", "d1", "d2", "normals", "error")
LIGHTS: tuple[Light, ...] = (
    DirectionalLight((1.0, 0.3, 0.5), (1.0, 0.9, 0.8)),
    PointLight((-60.0, 20.0, 40.0), (3000.0, 3000.0, 4000.0)),
    ConeLight((0.0, 0.0, 90.0), (0.0, 0.0, -1.0), 2000.0, 25.0),
)

WITH_F_T = "lambert, F_t(N.w)"
NUMPY_POINTS = 20
GATHERING = [name for name in shading_models() if not model_registry.get(name).local]
LOCAL = [name for name in shading_models() if model_registry.get(name).local]
MODELS: dict[str, tuple[str, dict[str, Any]]] = {
    **{name: (name, {}) for name in LOCAL},
    WITH_F_T: ("lambert", {"fresnel": "directional"}),
}
PLAIN = {
    "bredow2002": numpy_shading.bredow2002,
    "curvature-lut": numpy_shading.curvature_lut,
    "curvature-lut-physical": numpy_shading.curvature_lut_physical,
    "kolchin2007": numpy_shading.kolchin2007,
    "kolchin2007-simplified": numpy_shading.kolchin2007_simplified,
    "kubo2010": numpy_shading.kubo2010,
    "lambert": numpy_shading.lambert,
    "monge-patch": numpy_shading.monge_patch,
    "penner2011": numpy_shading.penner2011,
    "sphere-table": numpy_shading.sphere,
    "wrap": numpy_shading.wrap,
    WITH_F_T: numpy_shading.lambert_directional,
}


def best(call: Callable[[], object], runs: int) -> float:
    seconds = []
    for _ in range(runs):
        start = time.perf_counter()
        call()
        seconds.append(time.perf_counter() - start)
    return min(seconds)


def speeds(size: int, runs: int = 9) -> dict[str, object]:
    mesh, curvatures = torus(size)
    small = torus(100)
    count = len(mesh.vertices)
    per_vertex = {}
    for label, (name, parameters) in MODELS.items():
        shade(*small, MATERIAL, LIGHTS, name, **parameters)
        call = partial(shade, mesh, curvatures, MATERIAL, LIGHTS, name, **parameters)
        per_vertex[label] = 1e9 * best(call, runs) / count
    arguments = (mesh, curvatures, MATERIAL, LIGHTS)
    plain = {
        label: 1e9 * best(partial(function, *arguments), 2) / count
        for label, function in PLAIN.items()
    }
    each = 3 * len(LIGHTS)
    ours = per_vertex["curvature-lut"]
    return {
        "vertices": count,
        "lights": len(LIGHTS),
        "threads": numba.get_num_threads(),
        "ns_per_vertex": per_vertex,
        "ns_per_vertex_light_channel": {k: v / each for k, v in per_vertex.items()},
        "numpy_ns_per_vertex_light_channel": {k: v / each for k, v in plain.items()},
        "numpy_lambert_ns_per_vertex": plain["lambert"],
        "numpy_curvature_lut_ns_per_vertex": plain["curvature-lut"],
        "curvature_lut_to_lambert_with_F_t": ours / per_vertex[WITH_F_T],
        "curvature_lut_to_numpy_lambert": ours / plain["lambert"],
        "numpy_curvature_lut_to_compiled": plain["curvature-lut"] / ours,
    }


def gathering_speeds(size: int = 2000, runs: int = 2) -> dict[str, object]:
    """Time the models whose time depends on the mesh, in NumPy at a few of its vertices."""
    surface = torus(size)
    count, each = len(surface[0].vertices), 3 * len(LIGHTS)
    times = {}
    for name in GATHERING:
        shade(*torus(100), MATERIAL, LIGHTS, name)
        call = partial(shade, *surface, MATERIAL, LIGHTS, name)
        times[name] = 1e9 * best(call, runs) / (count * each)
    some = surface[0].vertices[:: count // NUMPY_POINTS]
    call = partial(numpy_shading.gather, *surface, MATERIAL, LIGHTS, some)
    return {
        "gathering_vertices": count,
        "gathering_ns_per_vertex_light_channel": times,
        "numpy_gather_ns_per_vertex_light_channel": 1e9 * best(call, 1) / (len(some) * each),
    }


def memory(size: int, model: str) -> float:
    """Return at most how many bytes a vertex `shade` needs beyond its inputs and output."""
    with tempfile.TemporaryDirectory() as folder:
        mesh, curvatures = torus(size)
        # The child loads its inputs, so that making them does not raise its peak.
        np.save(Path(folder, "points.npy"), mesh.vertices)
        for name in INPUTS:
            np.save(Path(folder, f"{name}.npy"), getattr(curvatures, name))
        command = [sys.executable, "-m", "tests.bench.shading_speed", "--child", model, folder]
        return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def _child(model: str, folder: str) -> float:
    shade(*torus(100), MATERIAL, LIGHTS, model)
    mesh = TriangleMesh(np.load(Path(folder, "points.npy")), [[0, 1, 2]])
    arrays = {name: np.load(Path(folder, f"{name}.npy")) for name in INPUTS}
    curvatures = PrincipalCurvatures(scale=0.0, **arrays)
    before = psutil.Process().memory_info().rss
    shade(mesh, curvatures, MATERIAL, LIGHTS, model)
    return float(_peak() - before) / len(mesh.vertices) - OUTPUT_BYTES


def _peak() -> int:
    status = Path("/proc/self/status")
    if status.exists():
        # getrusage would count the parent: Linux hands its peak on to what it starts.
        (line,) = (row for row in status.read_text().splitlines() if row.startswith("VmHWM"))
        return int(line.split()[1]) * 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=1_000_000, help="vertices")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--child", nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child:
        print(_child(*options.child))
        return
    result = speeds(options.size) | gathering_speeds()
    result["peak_bytes_per_vertex"] = {name: memory(options.size, name) for name in LOCAL}
    if options.json:
        print(json.dumps(result))
        return
    for key, value in result.items():
        if isinstance(value, dict):
            print(f"{key}:")
            for name, number in value.items():
                print(f"    {name:24} {number:8.1f}")
        else:
            print(f"{key}: {value:.4g}" if isinstance(value, float) else f"{key}: {value}")


if __name__ == "__main__":
    main()
