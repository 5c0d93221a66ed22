"""Whether time and memory a vertex stay the same from small meshes to large ones.

    python -m tests.bench.growth [--sizes 100000,300000,1000000] [--largest] [--repeats 3] [--json]

A regular torus with 2 % noise. Times a vertex are the least of some calls on a mesh in memory, as
shares of the first size's in the same run. Memory is what a call needs beyond the mesh and the
interpreter, at its peak, in a process of its own, for the torus without noise. The last line is of
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


def report(sizes: list[int], random_size: int, repeats: int) -> dict[str, dict[str, list[float]]]:
    """Return, by method, time a vertex over the first size's, bytes a vertex, and random order."""
    meshes = {str(size): torus(size).noisy(NOISE) for size in sizes}
    ordered = meshes.get(str(random_size)) or torus(random_size).noisy(NOISE)
    meshes |= {"ordered": ordered, "shuffled": shuffled(ordered)}
    seconds = times_per_vertex(meshes, repeats)
    table = {}
    for method, row in seconds.items():
        first = row[str(sizes[0])]
        table[method] = {
            "nanoseconds_per_vertex": [1e9 * row[str(size)] for size in sizes],
            "time_of_first": [row[str(size)] / first for size in sizes],
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
        print(f"{method}: vertices, ns a vertex, over that of the first, bytes a vertex")
        columns = (row["nanoseconds_per_vertex"], row["time_of_first"], row["bytes_per_vertex"])
        for size, nanoseconds, ratio, memory in zip(sizes, *columns, strict=True):
            print(f"  {size:10,} {nanoseconds:8.0f} {ratio:6.2f} {memory:6.0f}")
        ratio = row["shuffled_of_ordered"][0]
        print(f"  in random order, {options.shuffled:,} vertices, over the good order: {ratio:.2f}")


if __name__ == "__main__":
    main()
