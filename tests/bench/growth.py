"""Whether time and memory a vertex stay the same from small meshes to large ones.

    python -m tests.bench.growth [--sizes 100000,300000,1000000] [--largest] [--repeats 3] [--json]

A regular torus with 2 % noise. Times a vertex are the least of some calls on a mesh in memory, as
shares of the first size's in the same run. Memory is what a call needs beyond the mesh and the
interpreter, at its peak, in a process of its own, for the torus without noise. The last line is of
one mesh, ``--shuffled`` gives its size, with its vertices and faces in random order. ``--largest``
adds 3 and 10 million vertices.

Memory that a process gets from the system has to be found and cleared first. The allocator keeps
what small arrays were in and gives back that of large ones, so that only large meshes pay for it
with each array: little where the system has free pages, several times as much on a virtual machine
that hands free pages back to its host. Times are therefore taken twice, as they come and in a
process that keeps its memory (glibc), which shows what the computation itself takes. The last line
is what the first touch of a page costs here: of one just given back, and of one free for some time.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from functools import partial

import numpy as np

from lutcore.analytic import torus
from lutcore.mesh import TriangleMesh
from tests.bench.curvature import estimate, peak_memory

METHODS = ("rusinkiewicz2004", "auto")
LARGEST = (3_000_000, 10_000_000)
NOISE = 0.02
# A call on a small mesh is short: it gets more of them, so that one that nothing disturbs is there.
MOST_CALLS = 5
COLUMNS = (
    "nanoseconds_per_vertex",
    "time_of_first",
    "nanoseconds_keeping_memory",
    "time_of_first_keeping_memory",
    "bytes_per_vertex",
)
# With these glibc gives no memory back, whatever its size.
KEEPING = {"MALLOC_MMAP_MAX_": "0", "MALLOC_TRIM_THRESHOLD_": str(1 << 40)}
# Bytes whose pages are touched, and seconds after which a host may have taken free ones back.
TOUCHED, LATER = 1 << 30, 5.0


def shuffled(mesh: TriangleMesh) -> TriangleMesh:
    """Return the mesh with its vertices and faces in random order."""
    generator = np.random.default_rng(0)
    order = generator.permutation(len(mesh.vertices))
    faces = generator.permutation(np.argsort(order)[mesh.faces])
    return TriangleMesh(mesh.vertices[order], faces)


def times_per_vertex(meshes: dict[str, TriangleMesh], repeats: int) -> dict[str, dict[str, float]]:
    """Return seconds a vertex by method and mesh, the least of some calls."""
    largest = max(len(mesh.vertices) for mesh in meshes.values())
    found = {method: dict.fromkeys(meshes, np.inf) for method in METHODS}
    small = torus(1000).mesh
    for method in METHODS:
        estimate(small, method, np.inf)
    for _ in range(repeats):  # in turns, so that a busy moment hits all alike
        for name, mesh in meshes.items():
            count = len(mesh.vertices)
            for method in METHODS:
                call = partial(estimate, mesh, method, np.inf)
                for _ in range(min(MOST_CALLS, largest // count)):
                    before = time.perf_counter()
                    call()
                    taken = (time.perf_counter() - before) / count
                    found[method][name] = min(found[method][name], taken)
    return found


def times(sizes: list[int], random_size: int, repeats: int) -> dict[str, dict[str, float]]:
    """Return seconds a vertex by method and size, and of one size in either order."""
    meshes = {str(size): torus(size).noisy(NOISE) for size in sizes}
    ordered = meshes.get(str(random_size)) or torus(random_size).noisy(NOISE)
    meshes |= {"ordered": ordered, "shuffled": shuffled(ordered)}
    return times_per_vertex(meshes, repeats)


def times_keeping_memory(
    sizes: list[int], random_size: int, repeats: int
) -> dict[str, dict[str, float]]:
    """Return the same of a process that gives no memory back."""
    asked = ["--sizes", ",".join(map(str, sizes)), "--shuffled", str(random_size)]
    out = subprocess.run(
        [sys.executable, "-m", "tests.bench.growth", "--times", "--repeats", str(repeats), *asked],
        capture_output=True,
        check=True,
        env={**os.environ, **KEEPING},
    )
    found: dict[str, dict[str, float]] = json.loads(out.stdout)
    return found


def first_touch() -> list[float]:
    """Return nanoseconds a byte of new pages: of memory just given back, and some time after."""

    def touch() -> float:
        pages = np.empty(TOUCHED, np.uint8)
        before = time.perf_counter()
        pages[::4096] = 1
        return 1e9 * (time.perf_counter() - before) / TOUCHED

    touch()
    soon = touch()
    time.sleep(LATER)
    return [soon, touch()]


def report(sizes: list[int], random_size: int, repeats: int) -> dict[str, dict[str, list[float]]]:
    """Return, by method, time a vertex over the first size's, bytes a vertex, and random order."""
    seconds = times(sizes, random_size, repeats)
    keeping = times_keeping_memory(sizes, random_size, repeats)
    table = {}
    for method, row in seconds.items():
        first, kept = row[str(sizes[0])], keeping[method]
        table[method] = {
            "nanoseconds_per_vertex": [1e9 * row[str(size)] for size in sizes],
            "time_of_first": [row[str(size)] / first for size in sizes],
            "nanoseconds_keeping_memory": [1e9 * kept[str(size)] for size in sizes],
            "time_of_first_keeping_memory": [kept[str(s)] / kept[str(sizes[0])] for s in sizes],
            "bytes_per_vertex": [peak_memory(size, method) for size in sizes],
            "shuffled_of_ordered": [row["shuffled"] / row["ordered"]],
        }
    return table


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", default="100000,300000,1000000", metavar="N,N")
    parser.add_argument("--largest", action="store_true", help="3 and 10 million vertices, too")
    parser.add_argument("--shuffled", type=int, default=1_000_000, metavar="N")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--times", action="store_true", help="of this process alone, as JSON")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    sizes = [int(size) for size in options.sizes.split(",")]
    if options.largest:
        sizes += [size for size in LARGEST if size > max(sizes)]
    if options.times:
        print(json.dumps(times(sizes, options.shuffled, options.repeats)))
        return
    found = report(sizes, options.shuffled, options.repeats)
    touch = first_touch()
    if options.json:
        given = {"sizes": sizes, "shuffled": options.shuffled, "first_touch": touch}
        print(json.dumps({**given, **found}))
        return
    for method, row in found.items():
        print(f"{method}: ns a vertex and over the first, as they come and keeping memory; bytes")
        for size, a, b, c, d, memory in zip(sizes, *(row[key] for key in COLUMNS), strict=True):
            print(f"  {size:10,} {a:8.0f} {b:6.2f} {c:8.0f} {d:6.2f} {memory:6.0f}")
        ratio = row["shuffled_of_ordered"][0]
        print(f"  in random order, {options.shuffled:,} vertices, over the good order: {ratio:.2f}")
    print(f"first touch of a page: {touch[0]:.2f} ns a byte, {touch[1]:.2f} after {LATER:g} s")


if __name__ == "__main__":
    main()
