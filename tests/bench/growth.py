"""Whether time and memory a vertex stay the same from small meshes to large ones.

    python -m tests.bench.growth [--sizes 100000,300000,1000000] [--largest] [--repeats 3] [--json]

A regular torus with 2 % noise. Times a vertex are the least of some calls on a mesh in memory, as
shares of the first size's in the same run. Memory is what a call needs beyond the mesh and the
interpreter, at its peak, in a process of its own, for the torus without noise. A call on a large
mesh gets that memory anew from the kernel, which a small one finds in its process: the column of
pages is what one thread waits for as much, beyond writing to it once more. The last line is of
one mesh, ``--shuffled`` gives its size, with its vertices and faces in random order. ``--largest``
adds 3 and 10 million vertices.
"""

import argparse
import json
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


def pages(count: int, each: float) -> float:
    """Return ns a vertex that supplying memory takes, for so many bytes each."""
    fresh = np.empty(int(count * each), np.uint8)
    taken = []
    for _ in range(2):
        before = time.perf_counter()
        fresh.fill(1)
        taken.append(time.perf_counter() - before)
    return 1e9 * (taken[0] - taken[1]) / count


def report(sizes: list[int], random_size: int, repeats: int) -> dict[str, dict[str, list[float]]]:
    """Return, by method, time a vertex over the first size's, bytes a vertex, and random order."""
    meshes = {str(size): torus(size).noisy(NOISE) for size in sizes}
    ordered = meshes.get(str(random_size)) or torus(random_size).noisy(NOISE)
    meshes |= {"ordered": ordered, "shuffled": shuffled(ordered)}
    seconds = times_per_vertex(meshes, repeats)
    table = {}
    for method, row in seconds.items():
        first = row[str(sizes[0])]
        memory = [peak_memory(size, method) for size in sizes]
        table[method] = {
            "nanoseconds_per_vertex": [1e9 * row[str(size)] for size in sizes],
            "time_of_first": [row[str(size)] / first for size in sizes],
            "bytes_per_vertex": memory,
            "pages_ns": [pages(*one) for one in zip(sizes, memory, strict=True)],
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
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    sizes = [int(size) for size in options.sizes.split(",")]
    if options.largest:
        sizes += [size for size in LARGEST if size > max(sizes)]
    found = report(sizes, options.shuffled, options.repeats)
    if options.json:
        print(json.dumps({"sizes": sizes, "shuffled": options.shuffled, **found}))
        return
    for method, row in found.items():
        print(
            f"{method}: vertices, ns a vertex, over that of the first, bytes a vertex, ns of pages"
        )
        names = ("nanoseconds_per_vertex", "time_of_first", "bytes_per_vertex", "pages_ns")
        for size, *figures in zip(sizes, *(row[name] for name in names), strict=True):
            print(f"  {size:10,}", "{:8.0f} {:6.2f} {:6.0f} {:6.0f}".format(*figures))
        ratio = row["shuffled_of_ordered"][0]
        print(f"  in random order, {options.shuffled:,} vertices, over the good order: {ratio:.2f}")


if __name__ == "__main__":
    main()
