"""Mesh file to PNG: ours, with curvature and shading, beside f3d and PyVista showing it plain.

``python -m tests.bench.pictures [--json]`` runs each in fresh processes in turn, so that all
start-up counts: the least wall time and peak memory of several runs, and ours as ratios to each.
"""

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from app.samples import sample
from sample_meshes.ply import write_ply
from tests.bench.installed import variables

_RUNS = 3
_PYVISTA = """
import sys, pyvista
mesh = pyvista.read(sys.argv[1])
plotter = pyvista.Plotter(off_screen=True, window_size=(1000, 1000))
plotter.add_mesh(mesh, smooth_shading=True)
plotter.screenshot(sys.argv[2])
"""
_F3D = """
import sys, f3d
engine = f3d.Engine.create_egl()
engine.window.size = (1000, 1000)
engine.scene.add(sys.argv[1])
engine.window.render_to_image().save(sys.argv[2])
"""
_PEERS = {"f3d": _F3D, "PyVista": _PYVISTA}
_OURS = "import sys; from app.cli.program import program; sys.exit(program())"


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


def run_once(arguments: list[str]) -> tuple[float, float]:
    """Return wall time in s and peak memory in MiB of a fresh Python process."""
    probe = (
        "import resource, sys; code = sys.argv.pop(1)\n"
        "try:\n    exec(code)\n"
        "finally:\n"
        "    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, file=sys.stderr)"
    )
    start = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-c", probe, *arguments],
        capture_output=True,
        text=True,
        check=True,
        env=variables(),
    )
    return time.perf_counter() - start, int(done.stderr.split()[-1]) / 1024.0


def measure(ours: Path, theirs: Path, out: Path) -> dict[str, tuple[float, float]]:
    """Return the least time and memory of ours and of each peer, their runs taking turns."""
    commands = {"Curvelight": [_OURS, "shade", str(ours), "-o", str(out), "--quiet"]}
    commands |= {name: [code, str(theirs), str(out)] for name, code in _PEERS.items()}
    for command in commands.values():
        run_once(command)  # compile once
    runs: dict[str, list[tuple[float, float]]] = {name: [] for name in commands}
    for _ in range(_RUNS):
        for name, command in commands.items():
            out.unlink(missing_ok=True)
            runs[name].append(run_once(command))
            if not out.exists():
                raise SystemExit(f"{name} wrote no picture of {theirs.name}")
    return {name: (min(s for s, _ in one), min(m for _, m in one)) for name, one in runs.items()}


def compared(label: str, found: dict[str, tuple[float, float]]) -> dict[str, object]:
    """Return a row: the figures of each, and the ratios of ours to those of each peer."""
    own = found["Curvelight"]
    return {
        "mesh": label,
        "seconds": {name: time for name, (time, _) in found.items()},
        "mib": {name: peak for name, (_, peak) in found.items()},
        "time_ratio": {name: own[0] / found[name][0] for name in _PEERS},
        "memory_ratio": {name: own[1] / found[name][1] for name in _PEERS},
    }


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with tempfile.TemporaryDirectory() as folder:
        scan, sheet, out = (Path(folder) / name for name in ("face.ply", "sheet.ply", "out.png"))
        raw, bunny = sample("marble-face-raw").path, sample("bunny").path
        without_camera(raw, scan)
        million_triangles(sheet)
        rows = [
            compared(label, measure(ours, theirs, out))
            for label, ours, theirs in (
                ("bunny.obj, 56 172 triangles", bunny, bunny),
                ("face000.ply, 166 259 triangles", raw, scan),
                ("sheet, 999 698 triangles", sheet, sheet),
            )
        ]
    if arguments.json:
        print(json.dumps(rows, indent=2))
        return
    print("| mesh | with curvature and shading | plain | time | memory |\n|-|-|-|-|-|")
    for row in rows:
        for name in _PEERS:
            print(line(row, name))


def line(row: dict[str, Any], peer: str) -> str:
    """Return the table's line for one mesh and one peer."""
    own, other = (
        f"{row['seconds'][name]:.2f} s, {row['mib'][name]:.0f} MiB" for name in ("Curvelight", peer)
    )
    return (
        f"| {row['mesh']} | {own} | {peer} {other} | {row['time_ratio'][peer]:.2f} "
        f"| {row['memory_ratio'][peer]:.2f} |"
    )


if __name__ == "__main__":
    main()
