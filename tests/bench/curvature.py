"""Speed and accuracy of every curvature estimator beside VTK called bare, in one run.

    python -m tests.bench.curvature [--size 1000000] [--accuracy 160000] [--only A,B] [--json]

Times are of the second call, on a mesh that is already in memory: ours from a TriangleMesh, VTK's
from a vtkPolyData, for both principal curvatures. Estimators of other packages run in a child
process; their times hold the way there and back. One that takes longer than the limit is stopped
and left out from then on. Errors are the RMS of |(k1, k2) - exact| over the RMS curvature, on a
torus of radii 1 and .35; noise is along the normal, as a share of the mean edge.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from lutcore.analytic import Exact, torus
from lutcore.errors import CancelledError, CurvelightError
from lutcore.estimation import estimators, principal_curvatures
from lutcore.mesh import TriangleMesh

OURS = ("rusinkiewicz2004", "co-smoothing", "auto")
Pair = tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]


def vtk_curvatures(mesh: TriangleMesh) -> Callable[[], Pair]:
    """Return a call that computes VTK's minimum and maximum curvature."""
    import pyvista as pv
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkLogger, vtkObject
    from vtkmodules.vtkFiltersGeneral import vtkCurvatures

    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)  # it complains of each noisy vertex
    vtkObject.GlobalWarningDisplayOff()
    data = pv.PolyData.from_regular_faces(mesh.vertices, mesh.faces.astype(int))

    def run() -> Pair:
        found = []
        for setting in ("SetCurvatureTypeToMaximum", "SetCurvatureTypeToMinimum"):
            work = vtkCurvatures()
            work.SetInputData(data)
            getattr(work, setting)()
            work.Update()
            found.append(vtk_to_numpy(work.GetOutput().GetPointData().GetScalars()))
        return found[0], found[1]

    return run


def estimate(mesh: TriangleMesh, method: str, limit: float, **parameters: float) -> Pair:
    """Return the curvatures by one of our estimators, or stop it when its time is over."""
    end = time.monotonic() + limit
    found = principal_curvatures(
        mesh, method, progress=lambda share, step: time.monotonic() < end, **parameters
    )
    return found.k1, found.k2


def contestants() -> dict[str, tuple[str, dict[str, float]]]:
    """Return every estimator, by the name of its row: its own name and its parameters."""
    rows: dict[str, tuple[str, dict[str, float]]] = {name: (name, {}) for name in estimators()}
    rows["auto steadiness 300"] = ("auto", {"steadiness": 300.0})
    rows["libigl radius 2"] = ("libigl", {"radius": 2})
    rows["ball-jet degree 2"] = ("ball-jet", {"degree": 2})
    return rows


def relative_error(found: Pair, exact: Exact) -> float:
    """Return the RMS error over the RMS curvature."""
    k1, k2 = exact.truth.k1, exact.truth.k2
    size = float(np.sqrt(np.mean(k1**2 + k2**2)))
    return float(np.sqrt(np.mean((found[0] - k1) ** 2 + (found[1] - k2) ** 2))) / size


def times(size: int, repeats: int) -> dict[str, dict[str, float]]:
    """Return seconds of ours and VTK's on one regular mesh, the least of some repeats."""
    mesh = torus(size).noisy(0.02)
    calls = {name: partial(estimate, mesh, name, np.inf) for name in OURS}
    calls["VTK min/max"] = vtk_curvatures(mesh)
    for call in calls.values():
        call()
    seconds = dict.fromkeys(calls, np.inf)
    for _ in range(repeats):  # in turns, so that a busy moment hits all alike
        for name, call in calls.items():
            before = time.perf_counter()
            call()
            seconds[name] = min(seconds[name], time.perf_counter() - before)
    reference = seconds["VTK min/max"]
    return {
        name: {"seconds": round(value, 3), "of_vtk": round(value / reference, 3)}
        for name, value in seconds.items()
    }


def every(size: int, limit: float, only: str | None) -> dict[str, dict[str, Any]]:
    """Return the time of every estimator, and its error on two triangulations and three noises."""
    wanted = contestants()
    if only is not None:
        wanted = {name: wanted[name] for name in only.split(",")}
    table: dict[str, dict[str, Any]] = {name: {} for name in wanted}
    for irregular in (False, True):
        exact = torus(size, irregular)
        for share in (0.0, 0.02, 0.1):
            column = f"{'irregular' if irregular else 'regular'} {share:g}"
            mesh = exact.noisy(share) if share else exact.mesh
            for name, (method, parameters) in wanted.items():
                row = table[name]
                if "stopped" in row:
                    continue
                try:
                    before = time.perf_counter()
                    found = estimate(mesh, method, limit, **parameters)
                    # The last column's is of a call that had its compiled code already.
                    row["seconds"] = round(time.perf_counter() - before, 3)
                    row[column] = round(relative_error(found, exact), 5)
                except CancelledError:
                    row["stopped"] = f"{column}: more than {limit:g} s"
                except CurvelightError as error:
                    row["stopped"] = str(error)
    return table


def peak_memory(size: int, method: str) -> float:
    """Return the bytes a vertex that a method needs beyond mesh and interpreter, at its peak."""
    command = [sys.executable, "-m", "tests.bench.curvature", "--memory", method]
    # Freed arrays must go back to the system, or the mesh maker's would be used again unseen.
    environment = {**os.environ, "MALLOC_MMAP_THRESHOLD_": "65536", "MALLOC_TOP_PAD_": "0"}
    out = subprocess.run(
        [*command, "--size", str(size)], capture_output=True, check=True, env=environment
    )
    return float(out.stdout)


def memory_of(size: int, method: str) -> float:
    """Return the same for this process, which must have done nothing else."""
    principal_curvatures(torus(40_000).mesh, method)  # compiled code loaded, threads started
    mesh = torus(size).mesh
    before = memory("VmRSS")
    Path("/proc/self/clear_refs").write_text("5")  # the peak starts again from here
    found = principal_curvatures(mesh, method)
    return (memory("VmHWM") - before) / len(found.k1)


def memory(field: str) -> float:
    """Return the bytes that the system counts for this process (Linux)."""
    line = re.search(rf"{field}:\s+(\d+) kB", Path("/proc/self/status").read_text())
    assert line
    return 1024.0 * float(line[1])


def main() -> None:
    """Run the comparison and print it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=1_000_000)
    parser.add_argument("--accuracy", type=int, default=160_000)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--limit", type=float, default=20.0, help="seconds for one call")
    parser.add_argument("--only", metavar="A,B", help="estimators to judge for accuracy")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--memory", metavar="METHOD", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.memory:
        print(memory_of(options.size, options.memory))
        return
    report = {
        "vertices": options.size,
        "times": times(options.size, options.repeats),
        "bytes_per_vertex": {name: round(peak_memory(options.size, name)) for name in OURS},
        "accuracy": every(options.accuracy, options.limit, options.only),
    }
    if options.json:
        print(json.dumps(report))
        return
    print(f"{options.size} vertices, seconds and share of VTK's")
    for name, row in report["times"].items():
        print(f"  {name:18} {row['seconds']:8.3f} {row['of_vtk']:8.3f}")
    print("bytes per vertex beyond the mesh, at the peak")
    for name, value in report["bytes_per_vertex"].items():
        print(f"  {name:18} {value:8}")
    print(f"seconds and relative errors, {options.accuracy} vertices")
    for name, row in report["accuracy"].items():
        print(f"  {name:22}", "  ".join(f"{column} {value}" for column, value in row.items()))


if __name__ == "__main__":
    main()
