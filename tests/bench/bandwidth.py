"""How close each stage of `auto` is to the speed of the memory.

    python -m tests.bench.bandwidth [--size 1000000] [--repeats 3] [--json]

On a regular torus with 2 % noise. The memory's speed is that of a triad a = b + 3 c on arrays that
no cache holds, in the same run: four times eight bytes an element, for each line of `a` is read
before it is written. Of each stage: its share of the time of `auto`, and the bytes that it moves at
least over its time, as a share of the triad. The bytes are those of its compiled loops, each array
given or returned counted once, and twice if it is both read and written. Lines that are read before
they are written do not count, so that not even a plain copy reaches 1. The arrangement is of the
same mesh in random order, for a good order is left alone.
"""

import argparse
import importlib
import json
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass, field, fields, is_dataclass
from typing import Any
from unittest.mock import patch

import numpy as np
from numba import prange

from lutcore.analytic import torus
from lutcore.arrangement import arranged
from lutcore.arrays import AnyArray, FloatArray
from lutcore.compiled import compiled
from lutcore.estimation import principal_curvatures
from lutcore.mesh import TriangleMesh
from lutcore.weld import weld
from tests.bench.growth import NOISE, shuffled

Counter = Callable[[tuple[Any, ...], Any], float]
# Where each stage is called from, in the order of the calls.
STAGES = {
    "weld": "lutcore.estimation.weld",
    "vertex_corners": "lutcore.cosmoothing.vertex_corners",
    "stars": "lutcore.cosmoothing.stars",
    "median area": "lutcore.cosmoothing.median_vertex_area",
    "laplacian": "lutcore.cosmoothing.laplacian",
    "rungs": "plugins.curvature.auto.rungs",
    "low_pass": "lutcore.cosmoothing.low_pass",
    "_tensors": "lutcore.cosmoothing.shape_operators",
    "bands": "lutcore.selection.bands",
    "_mix": "lutcore.selection._mix",
    "borrow": "lutcore.selection.borrow",
    "refined": "lutcore.selection.refined",
    "_principal": "lutcore.selection._principal",
}
# A part of two stages: the products with the Laplacian that `low_pass` and `refined` make.
PRODUCTS = ("lutcore.lowpass.step", "lutcore.lowpass.add_step")
# The scales are tried on small patches by the same functions: those calls are not the mesh's.
TRIAL = "rungs"
TRIAD = 20_000_000  # elements; 480 MB


def arrays(value: Any) -> Iterator[AnyArray]:
    """Yield all arrays in a value."""
    if isinstance(value, np.ndarray):
        yield value
    elif isinstance(value, tuple):
        for each in value:
            yield from arrays(each)
    elif isinstance(value, TriangleMesh):
        yield from (value.vertices, value.faces)
    elif is_dataclass(value):
        for one in fields(value):
            yield from arrays(getattr(value, one.name))


def size(*values: Any) -> int:
    """Return the bytes of all arrays in values, each memory once."""
    # One number that stands for a whole array takes its own bytes only.
    found = {
        (array.ctypes.data, array.nbytes): array.itemsize if 0 in array.strides else array.nbytes
        for array in arrays(values)
    }
    return sum(found.values())


def rewriting(*places: int) -> Counter:
    """Return what counts a loop's bytes; the arguments at these places are read and written."""
    return lambda given, found: float(size(given, found) + size(*(given[at] for at in places)))


def adding_bytes(given: tuple[Any, ...], found: object) -> float:
    """Return the bytes of a product that adds to the scales: only to those that take part."""
    start, neighbour, rate, now, before, change, weight, after = given
    used = np.count_nonzero((weight != 0.0) | (after != 0.0)) / len(weight)
    return size(start, neighbour, rate, now, weight, after) + 2.0 * (
        size(before) + used * size(change)
    )


LOOPS: dict[str, Counter] = {
    # No loop but several and NumPy's between: what comes in and what goes out.
    "lutcore.estimation.weld": rewriting(),
    "lutcore.geometry._vertex_corners": rewriting(),
    "lutcore.stars._stars": rewriting(),
    "lutcore.cosmoothing.median_vertex_area": rewriting(),
    "lutcore.rings._rings": rewriting(),
    "lutcore.rings._joined": rewriting(),
    "lutcore.laplacian._rates": rewriting(),
    "lutcore.laplacian._relative_to_largest": rewriting(1),
    "lutcore.lowpass.apply": rewriting(),
    "lutcore.lowpass.begin": rewriting(),
    "lutcore.lowpass.step": rewriting(4),
    "lutcore.lowpass.add_step": adding_bytes,
    "lutcore.cosmoothing.fit_shape_operators": rewriting(),
    "lutcore.bands._energies": rewriting(),
    "lutcore.bands._average": rewriting(),
    "lutcore.selection._mix": rewriting(),
    "lutcore.selection._principal": rewriting(),
    "lutcore.refinement._in_space": rewriting(),
    "lutcore.refinement._apply": rewriting(1, 5, 6),
}


@dataclass
class Tally:
    """Time and bytes of a stage."""

    seconds: float = 0.0
    moved: float = 0.0
    calls: int = 0


@dataclass
class Watch:
    """What was seen of one call: each stage by name, and those that run now."""

    seen: dict[str, Tally] = field(default_factory=dict)
    running: list[str] = field(default_factory=list)

    def stage(self, name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return the function, noting how long it takes."""

        def call(*given: Any) -> Any:
            if TRIAL in self.running:
                return function(*given)
            tally = self.seen.setdefault(name, Tally())
            self.running.append(name)
            before = time.perf_counter()
            found = function(*given)
            tally.seconds += time.perf_counter() - before
            self.running.pop()
            tally.calls += 1
            return found

        return call

    def loop(self, counter: Counter, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return the function, noting the bytes that it moves for every stage that runs."""

        def call(*given: Any) -> Any:
            found = function(*given)
            if TRIAL not in self.running:
                for name in self.running:
                    self.seen[name].moved += counter(given, found)
            return found

        return call


def watched(mesh: TriangleMesh) -> tuple[dict[str, Tally], float]:
    """Return the stages of one call of `auto` and its seconds."""
    watch = Watch()
    names = dict.fromkeys(PRODUCTS, "a product") | {place: name for name, place in STAGES.items()}
    with ExitStack() as stack:
        for place in {**LOOPS, **names}:
            module, _, attribute = place.rpartition(".")
            owner = importlib.import_module(module)
            function = getattr(owner, attribute)  # an error tells of a renamed one
            if place in LOOPS:
                function = watch.loop(LOOPS[place], function)
            if place in names:
                function = watch.stage(names[place], function)
            stack.enter_context(patch.object(owner, attribute, function))
        before = time.perf_counter()
        principal_curvatures(mesh, "auto")
        return watch.seen, time.perf_counter() - before


@compiled(parallel=True)
def _triad(a: FloatArray, b: FloatArray, c: FloatArray) -> None:
    for i in prange(len(a)):
        a[i] = b[i] + 3.0 * c[i]


def triad(count: int, repeats: int = 10) -> float:
    """Return the speed of the memory, bytes/s."""
    a, b, c = np.zeros(count), np.ones(count), np.ones(count)
    seconds = np.inf
    for _ in range(repeats + 1):  # the first compiles
        before = time.perf_counter()
        _triad(a, b, c)
        seconds = min(seconds, time.perf_counter() - before)
    return 32.0 * count / seconds


def arrangement(mesh: TriangleMesh) -> Tally:
    """Return what it takes to bring a mesh in random order into a good one."""
    welded = weld(shuffled(mesh))
    before = time.perf_counter()
    found = arranged(welded)
    return Tally(time.perf_counter() - before, size(welded, found), 1)


def report(count: int, repeats: int, elements: int = TRIAD) -> dict[str, Any]:
    """Return the table: for each stage the least time of some calls."""
    mesh = torus(count).noisy(NOISE)
    principal_curvatures(mesh, "auto")  # compiled code loaded
    arrangement(mesh)
    best: dict[str, Tally] = {}
    total, speed = np.inf, 0.0
    for _ in range(repeats):  # in turns, so that a busy moment hits all alike
        speed = max(speed, triad(elements))
        seen, seconds = watched(mesh)
        total = min(total, seconds)
        for name, tally in {**seen, "arrangement": arrangement(mesh)}.items():
            if name not in best or tally.seconds < best[name].seconds:
                best[name] = tally
    return {
        "vertices": len(mesh.vertices),
        "triad_gb_per_s": 1e-9 * speed,
        "seconds": total,
        "share_of_time_seen": sum(best[name].seconds for name in STAGES) / total,
        "stages": {
            name: {
                "share_of_time": tally.seconds / total,
                "calls": tally.calls,
                "bytes_per_vertex_and_call": tally.moved / tally.calls / len(mesh.vertices),
                "share_of_triad": tally.moved / tally.seconds / speed if tally.moved else None,
            }
            for name, tally in best.items()
        },
    }


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=1_000_000)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    found = report(options.size, options.repeats)
    if options.json:
        print(json.dumps(found))
        return
    print(
        f"{found['vertices']} vertices, auto {found['seconds']:.2f} s, "
        f"triad {found['triad_gb_per_s']:.1f} GB/s; the stages are "
        f"{found['share_of_time_seen']:.2f} of the time"
    )
    print(
        f"{'stage':16} {'of the time':>12} {'calls':>6} {'bytes a vertex':>15} {'of the triad':>13}"
    )
    for name, row in found["stages"].items():
        share = "-" if row["share_of_triad"] is None else f"{row['share_of_triad']:.2f}"
        print(
            f"{name:16} {row['share_of_time']:12.3f} {row['calls']:6d} "
            f"{row['bytes_per_vertex_and_call']:15.0f} {share:>13}"
        )


if __name__ == "__main__":
    main()
