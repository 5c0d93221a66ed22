"""Reading a million triangles: ours against trimesh, imports included and apart.

Run as ``python -m tests.bench.loading_speed``; every reading is a process of its own.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from tests.mesh_files import grid, stl_binary, text_rows

_OURS = """
import json, sys, time
began = time.perf_counter()
from app.loading import load_mesh
imported = time.perf_counter()
faces = len(load_mesh(sys.argv[1]).mesh.faces)
print(json.dumps([imported - began, time.perf_counter() - imported, faces]))
"""
_TRIMESH = _OURS.replace("from app.loading import load_mesh", "import trimesh").replace(
    "load_mesh(sys.argv[1]).mesh.faces", "trimesh.load(sys.argv[1], process=False).faces"
)
_PLY = """ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y
property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n"""


def write_files(folder: Path, size: int) -> None:
    """Write one sheet in four formats."""
    vertices, faces = grid(size)
    count = len(vertices), len(faces)
    rows = np.empty(len(faces), [("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, faces
    body = vertices.astype("<f4").tobytes() + rows.tobytes()
    (folder / "binary.ply").write_bytes(_PLY.format("binary_little_endian", *count).encode() + body)
    points = text_rows(vertices)
    counted = text_rows(np.column_stack((np.full(len(faces), 3), faces)))
    (folder / "text.ply").write_text(_PLY.format("ascii", *count) + points + counted)
    lines = ["v " + row for row in points.splitlines()]
    lines += ["f " + row for row in text_rows(faces + 1).splitlines()]
    (folder / "text.obj").write_text("\n".join(lines) + "\n")
    (folder / "binary.stl").write_bytes(stl_binary(vertices, faces))


def best(code: str, path: Path, repeats: int) -> tuple[float, float, int]:
    """Return the best import and reading times of several processes, and the faces read."""
    runs = []
    for _ in range(repeats):
        done = subprocess.run(
            [sys.executable, "-W", "ignore", "-c", code, str(path)], capture_output=True, check=True
        )
        runs.append(json.loads(done.stdout))
    return min(run[0] for run in runs), min(run[1] for run in runs), runs[0][2]


def main() -> None:
    """Print the times and their ratios."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=708, help="vertices along a side of the sheet")
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        write_files(Path(folder), options.size)
        for path in sorted(Path(folder).iterdir()):
            ours = best(_OURS, path, options.repeats)
            peer = best(_TRIMESH, path, options.repeats)
            assert ours[2] == peer[2]
            print(
                f"{path.name:12} {ours[2]:,} faces: ours {ours[0]:.2f} + {ours[1]:.2f} s, trimesh "
                f"{peer[0]:.2f} + {peer[1]:.2f} s (import + read), trimesh/ours "
                f"{sum(peer[:2]) / sum(ours[:2]):.2f}"
            )


if __name__ == "__main__":
    main()
