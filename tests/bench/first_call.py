"""What the first call costs: with nothing compiled, and with the compiled code kept.

    python -m tests.bench.first_call [--size 20000] [--method auto] [--repeats 3] [--json]

Each line is a fresh process that imports, then calls `principal_curvatures` on a torus with 2 %
noise; its second call is the best of five. The first process starts with an empty
``CURVELIGHT_CACHE_DIR``, so it compiles; the others find the code that it left. The third imports
beforehand what the first call of the second still had to import. The cached start is what a first
call costs beyond a second one; beyond imports it is to be less than .3 s. All lines but the first
are the best of some processes.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from lutcore.analytic import torus

Row = dict[str, float]
LIMIT = 0.3
NOISE = 0.02
_CHILD = """
import importlib, json, sys, time
method, file, *late = sys.argv[1:]
clock = [time.perf_counter()]
import numpy
from lutcore.estimation import estimator_registry, principal_curvatures
from lutcore.mesh import TriangleMesh
estimator_registry.get(method)
for name in late:
    importlib.import_module(name)
clock.append(time.perf_counter())
with numpy.load(file) as arrays:
    mesh = TriangleMesh(arrays["vertices"], arrays["faces"])
known = set(sys.modules)
seconds = [clock[1] - clock[0]]
new = []
for _ in range(6):
    before = time.perf_counter()
    principal_curvatures(mesh, method)
    seconds.append(time.perf_counter() - before)
    new = new or [name for name in sys.modules if name not in known]
print(json.dumps([seconds, new]))
"""


def run(cache: Path, method: str, late: list[str], repeats: int = 1) -> tuple[Row, list[str]]:
    """Return the seconds of fresh processes, and the modules that their first call imported."""
    seconds = []
    for _ in range(repeats):
        done = subprocess.run(
            [sys.executable, "-c", _CHILD, method, str(cache / "mesh.npz"), *late],
            capture_output=True,
            check=True,
            env={**os.environ, "CURVELIGHT_CACHE_DIR": str(cache)},
        )
        (imports, first, *others), new = json.loads(done.stdout)
        seconds.append((imports, first, min(others)))
    imports, first, second = (min(column) for column in zip(*seconds, strict=True))
    row = {"imports": imports, "first_call": first, "second_call": second, "start": first - second}
    return row, new


def report(size: int, method: str, repeats: int) -> dict[str, Any]:
    """Return the seconds with nothing compiled, with compiled code, and with all imported too."""
    with tempfile.TemporaryDirectory() as folder:
        cache = Path(folder)
        mesh = torus(size).noisy(NOISE)
        np.savez(cache / "mesh.npz", vertices=mesh.vertices, faces=mesh.faces)
        compiling, _ = run(cache, method, [])
        cached, late = run(cache, method, [], repeats)
        # Packages with a public name bring their private modules along.
        packages = [name for name in late if name.count(".") <= 1 and "._" not in f".{name}"]
        imported, _ = run(cache, method, packages, repeats)
    return {
        "vertices": len(mesh.vertices),
        "nothing compiled": compiling,
        "compiled before": cached,
        "and all imported before": imported,
        "late_imports": packages,
        "cached_start_s": cached["start"],
        "cached_start_beyond_imports_s": imported["start"],
        "limit_s": LIMIT,
    }


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=20_000)
    parser.add_argument("--method", default="auto")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    found = report(options.size, options.method, options.repeats)
    if options.json:
        print(json.dumps(found))
        return
    rows = {name: row for name, row in found.items() if isinstance(row, dict)}
    columns = list(next(iter(rows.values())))
    print(f"{options.method}, {found['vertices']} vertices, s", *(f"{one:>12}" for one in columns))
    for name, row in rows.items():
        print(f"  {name:30}", *(f"{row[column]:12.3f}" for column in columns))
    late = sorted({name.partition(".")[0] for name in found["late_imports"]})
    print("the first call still imports parts of:", ", ".join(late) or "nothing")
    print(
        f"cached start {found['cached_start_s']:.3f} s, beyond imports "
        f"{found['cached_start_beyond_imports_s']:.3f} s (limit {LIMIT} s)"
    )


if __name__ == "__main__":
    main()
