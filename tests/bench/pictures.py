"""Mesh file to PNG: ours, with curvature and shading, beside PyVista showing it plain.

``python -m tests.bench.pictures [--json]`` runs each in fresh processes in turn, so that all
start-up counts: wall time and peak memory of the fastest of several runs, as ratios.
"""

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from app.samples import sample
from sample_meshes.ply import write_ply

_RUNS = 3
_PYVISTA = """
import sys, pyvista
mesh = pyvista.read(sys.argv[1])
plotter = pyvista.Plotter(off_screen=True, window_size=(1000, 1000))
plotter.add_mesh(mesh, smooth_shading=True)
plotter.screenshot(sys.argv[2])
"""
_OURS = "import sys; from app.cli.main import main; sys.exit(main(sys.argv[1:]))"


def million_triangles(path: Path) -> None:
    """Write a wavy sheet of a million triangles, 1 mm apart."""
    side = 708
    x, y = np.meshgrid(np.arange(side, dtype=float), np.arange(side, dtype=float))
    z = 20.0 * np.sin(x / 60.0) * np.cos(y / 45.0)
    corner = np.arange(side * side).reshape(side, side)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]
    faces = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)]).reshape(-1, 3)
    write_ply(path, np.stack([x, y, z], -1).reshape(-1, 3), faces)


def without_camera(source: Path, path: Path) -> None:
    """Write the scan without its camera element, at which VTK's reader ends the process."""
    from app.loading import load_mesh

    mesh = load_mesh(source).mesh
    write_ply(path, mesh.vertices, mesh.faces)


def measure(arguments: list[str]) -> tuple[float, float]:
    """Return wall time in s and peak memory in MiB of a Python process, the best of some runs."""
    times, peaks = [], []
    for _ in range(_RUNS):
        probe = (
            "import resource, runpy, sys; code = sys.argv.pop(1)\n"
            "try:\n    exec(code)\n"
            "finally:\n"
            "    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, file=sys.stderr)"
        )
        start = time.perf_counter()
        done = subprocess.run(
            [sys.executable, "-c", probe, *arguments], capture_output=True, text=True, check=True
        )
        times.append(time.perf_counter() - start)
        peaks.append(int(done.stderr.split()[-1]) / 1024.0)
    return min(times), min(peaks)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        scan, sheet, out = (Path(folder) / name for name in ("face.ply", "sheet.ply", "out.png"))
        raw = sample("marble-face-raw").path
        without_camera(raw, scan)
        million_triangles(sheet)
        for label, ours, peer in (
            ("face000.ply, 166 259 triangles", raw, scan),
            ("sheet, 999 698 triangles", sheet, sheet),
        ):
            command = ["shade", str(ours), "-o", str(out), "--quiet"]
            subprocess.run([sys.executable, "-c", _OURS, *command], check=True)  # compile once
            our_time, our_peak = measure([_OURS, *command])
            peer_time, peer_peak = measure([_PYVISTA, str(peer), str(out)])
            rows.append(
                {
                    "mesh": label,
                    "curvelight_s": our_time,
                    "pyvista_s": peer_time,
                    "time_ratio": our_time / peer_time,
                    "curvelight_mib": our_peak,
                    "pyvista_mib": peer_peak,
                    "memory_ratio": our_peak / peer_peak,
                }
            )
    if arguments.json:
        print(json.dumps(rows, indent=2))
        return
    for row in rows:
        print(
            f"{row['mesh']}: Curvelight {row['curvelight_s']:.2f} s, {row['curvelight_mib']:.0f} "
            f"MiB; PyVista plain {row['pyvista_s']:.2f} s, {row['pyvista_mib']:.0f} MiB; ratios "
            f"{row['time_ratio']:.2f} and {row['memory_ratio']:.2f}"
        )


if __name__ == "__main__":
    main()
