"""Error, speed and memory of the gathered reference: python -m tests.bench.gather [--json].

The error of `jensen2002` is taken against brute force at some vertices, its time over that of
`curvature-lut` in the same run, both through `shade`, as the best of several calls. The scan is the
sample with all of its noise, in which light varies within the triangles. Memory is the
growth of the resident size over the call in a child process, less the output. POSIX.
"""

import argparse
import json
import resource
import subprocess
import sys
from dataclasses import replace
from functools import partial

import numpy as np
import psutil  # type: ignore[import-untyped]

from lutcore import analytic
from lutcore.analytic import Exact
from lutcore.curvature import PrincipalCurvatures
from lutcore.diffusion import diffusion_profile
from lutcore.exitance import shade
from lutcore.gather.exitance import exact
from lutcore.geometry import area_normals, vertex_corners
from lutcore.lights import pack
from lutcore.materials import material
from lutcore.mesh import TriangleMesh
from lutcore.shading import ShadingInputs
from tests.bench.shading_speed import LIGHTS, best
from tests.bumps import bare

MATERIALS = ("skin1", "marble", "wholemilk")
POINTS = 200
NOISE = 0.1


def torus(count: int) -> Exact:
    """Return the torus of the growth and the memory, in millimetres."""
    return analytic.torus(count, major=20.0, minor=8.0)


def meshes(count: int) -> dict[str, tuple[TriangleMesh, PrincipalCurvatures]]:
    """Return the meshes of the errors, with the curvatures that `shade` wants."""
    ring = torus(count)
    noisy = ring.noisy(NOISE)
    ball = analytic.sphere(count, radius=38.0)
    rough = replace(ring.truth, normals=area_normals(noisy, vertex_corners(noisy)))
    return {
        "sphere": (ball.mesh, ball.truth),
        "torus": (ring.mesh, ring.truth),
        "noisy torus": (noisy, rough),
        "scan": scan(),
    }


def scan() -> tuple[TriangleMesh, PrincipalCurvatures]:
    """Return the sample scan, about 86 000 vertices, with the normals of its triangles."""
    from app.loading import load_mesh
    from app.samples import sample

    mesh = load_mesh(sample("marble-face-raw").path).mesh
    return mesh, bare(mesh)


def errors(count: int) -> dict[str, dict[str, float]]:
    """Return relative L2 and the largest error over the largest value, %, of the worst channel."""
    found = {}
    for name, (mesh, curvatures) in meshes(count).items():
        for substance in MATERIALS:
            inputs = ShadingInputs(
                points=mesh.vertices,
                normals=curvatures.normals,
                shape=np.zeros((len(mesh.vertices), 6)),
                lights=pack(LIGHTS),
                material=material(substance),
                profile=diffusion_profile("jensen2001"),
                faces=mesh.faces,
                mm_per_unit=1.0,
            )
            seen = np.flatnonzero(np.any(curvatures.normals != 0.0, axis=1))
            some = seen[np.linspace(0, len(seen) - 1, POINTS).astype(int)]
            truth = exact(inputs, mesh.vertices[some])
            shaded = shade(mesh, curvatures, substance, LIGHTS, "jensen2002")[some]
            off = shaded - truth
            norms = np.linalg.norm(off, axis=0) / np.linalg.norm(truth, axis=0)
            largest = np.abs(off).max(axis=0) / truth.max(axis=0)
            found[f"{name}, {substance}"] = {
                "l2_percent": 100.0 * float(norms.max()),
                "largest_percent": 100.0 * float(largest.max()),
            }
    return found


def growth(sizes: list[int], substance: str) -> list[dict[str, float]]:
    """Return time a vertex, over n log n, and over `curvature-lut`, at each size."""
    return [cost((ring.mesh, ring.truth), substance) for ring in map(torus, sizes)]


def cost(body: tuple[TriangleMesh, PrincipalCurvatures], substance: str) -> dict[str, float]:
    """Return the same of one mesh."""
    arguments, count = (*body, substance, LIGHTS), len(body[0].vertices)
    call = partial(shade, *arguments, "jensen2002")
    call()
    slow = best(call, 3)
    fast = best(partial(shade, *arguments, "curvature-lut"), 15)
    return {
        "vertices": count,
        "us_per_vertex": 1e6 * slow / count,
        "ns_per_n_log2_n": 1e9 * slow / (count * np.log2(count)),
        "ratio_to_curvature_lut": slow / fast,
    }


def bytes_per_vertex(size: int) -> float:
    """Return what a call needs beyond its input and output, from a process of its own."""
    code = f"from tests.bench.gather import own_memory; print(own_memory({size}))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return float(done.stdout)


def own_memory(size: int) -> float:
    """Measure it in this process."""
    body, small = torus(size), torus(300)
    shade(small.mesh, small.truth, "skin1", LIGHTS, "jensen2002")
    before = psutil.Process().memory_info().rss
    shaded = shade(body.mesh, body.truth, "skin1", LIGHTS, "jensen2002")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    return float(max(peak - before - shaded.nbytes, 0)) / len(shaded)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=20_000, help="vertices of the errors' meshes")
    parser.add_argument("--sizes", default="10000,86000,1000000", metavar="N,N")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    sizes = [int(size) for size in options.sizes.split(",")]
    found = errors(options.count)
    grown = {substance: growth(sizes, substance) for substance in MATERIALS[:2]}
    scanned = {substance: cost(scan(), substance) for substance in MATERIALS[:2]}
    memory = bytes_per_vertex(sizes[-1])
    if options.json:
        measured = {"errors": found, "growth": grown, "scan": scanned, "bytes_per_vertex": memory}
        print(json.dumps(measured))
        return
    print(
        f"jensen2002 against brute force at {POINTS} of {options.count:,} vertices (or the scan's),"
        " %: L2, largest"
    )
    for name, row in found.items():
        print(f"  {name:24} {row['l2_percent']:6.3f} {row['largest_percent']:6.3f}")
    for substance, rows in grown.items():
        print(
            f"{substance}, 3 lights: vertices, us a vertex, ns/(n log2 n), over curvature-lut; "
            "last the scan"
        )
        for row in [*rows, scanned[substance]]:
            print(
                f"  {row['vertices']:9,.0f} {row['us_per_vertex']:7.2f} "
                f"{row['ns_per_n_log2_n']:7.1f} {row['ratio_to_curvature_lut']:6.1f}"
            )
    print(f"memory beyond input and output: {memory:.0f} bytes a vertex")


if __name__ == "__main__":
    main()
