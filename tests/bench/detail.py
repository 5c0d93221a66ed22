"""Detail below the scattering range: python -m tests.bench.detail [--quick] [--json].

`curvature-lut` on noisy and bumpy surfaces, against the dipole gathered on those same surfaces with
all their detail (`jensen2002`), by what it is given:

- raw: normals of the stars and curvature of the one-ring (`rusinkiewicz2004`);
- one scale: both at the glow of the channel that it carries farthest, or three spacings;
- best scale: both at the scale of the eight tried that has the least error, for all channels;
- glows: both at the glow of each channel, or half a spacing;
- normals, curvature: the one filtered by the profile, the other at one scale;
- detail: both filtered by the profile, channel by channel (`lutcore.detail`), the default.

Relative L2 of all channels, per cent, and CIEDE2000 of the exposed sRGB, mean and 99th percentile.
Two directional lights, as in the paper's Figure 1. Of the scan, which ends at a rim, only what is
farther from it than four glows counts. No shadows.
"""

import argparse
import json
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from app.session import FIGURE_LIGHTS
from lutcore import analytic
from lutcore.analytic import Exact
from lutcore.baking import bake
from lutcore.color import auto_exposure, srgb_bytes
from lutcore.cosmoothing import surface
from lutcore.curvature import PrincipalCurvatures
from lutcore.detail import Detail, detail_seen
from lutcore.estimation import principal_curvatures
from lutcore.exitance import shade
from lutcore.geometry import typical_spacing
from lutcore.lights import DirectionalLight
from lutcore.mesh import TriangleMesh
from lutcore.metrics import ciede2000
from lutcore.scale import shading_scale
from lutcore.shading import shading_inputs
from lutcore.weld import weld
from tests.bumps import bare, bumpy

FloatArray = NDArray[np.float64]
Row = dict[str, float]
LIGHTS = [DirectionalLight(light.direction, light.irradiance) for light in FIGURE_LIGHTS]
MATERIALS = ("skin1", "marble")
SPACINGS = 2.0 ** (0.5 * np.arange(-1.0, 7.0))
NOISE = 0.1


def ball(count: int) -> Exact:
    """Return a sphere."""
    return analytic.sphere(count, irregular=True, radius=20.0)


def ring(count: int) -> Exact:
    """Return a torus."""
    return analytic.torus(count, irregular=True, major=20.0, minor=8.0)


def scan() -> TriangleMesh:
    """Return the marble face, as Figure 1 has it."""
    from app.loading import load_mesh
    from app.samples import sample

    found = weld(load_mesh(sample("marble-face").path).mesh).mesh
    assert found is not None
    return found


SCENES: dict[str, tuple[Callable[[int], TriangleMesh], tuple[float, ...]]] = {
    "sphere, 10 % noise": (lambda count: ball(count).noisy(NOISE), (0.5, 1.0, 2.0)),
    "torus, 10 % noise": (lambda count: ring(count).noisy(NOISE), (0.5, 1.0, 2.0)),
    "bumps": (bumpy, (0.5, 1.5, 5.0)),
    "marble face": (lambda _: scan(), (0.5, 1.0, 4.0)),
}
# Noise that is none of the surface: the truth is the light of what was there before it.
WITHOUT = "torus, 10 % noise, against the torus without it"
QUICK = {"bumps": (bumpy, (1.5,))}


def same_for_all(mesh: TriangleMesh, found: list[PrincipalCurvatures], size: float) -> Detail:
    """Return what channels see whose normals and curvature were estimated at a scale of each."""
    inputs = [shading_inputs(mesh, one, "skin1", LIGHTS, size) for one in found]
    normals = inputs[0].normals
    return Detail(
        normals=np.array([one.normals for one in inputs]),
        shape=np.array([one.shape for one in inputs]),
        variance=np.zeros((3, len(normals))),
        bare=normals,
        widths=np.zeros(3),
        scale=0.0,
        smooth=normals,
    )


def ways(mesh: TriangleMesh, material: str, size: float) -> dict[str, list[Detail]]:
    """Return what a local model may be given; of several the best counts."""
    table, spacing = bake(material), typical_spacing(mesh)

    def at(lengths: list[float]) -> Detail:
        found = [principal_curvatures(mesh, scale=length) for length in lengths]
        return same_for_all(mesh, found * (3 // len(found)), size)

    raw = principal_curvatures(mesh, "rusinkiewicz2004")
    raw = replace(raw, normals=bare(mesh).normals)
    one, seen = at([shading_scale(mesh, table.glow / size)]), detail_seen(mesh, material, size)
    glows = np.maximum(table.mean_free_path * table.psi[:, 0] / size, 0.5 * spacing)
    return {
        "raw": [same_for_all(mesh, [raw] * 3, size)],
        "one scale": [one],
        "best scale": [at([scale * spacing]) for scale in SPACINGS],
        "glows": [at(glows.tolist())],
        "normals": [replace(seen, shape=one.shape)],
        "curvature": [replace(seen, normals=one.normals)],
        "detail": [seen],
    }


def compared(mesh: TriangleMesh, true: TriangleMesh, material: str, size: float) -> dict[str, Row]:
    """Return the errors of each way against what is gathered on the true mesh."""
    known = bare(mesh)
    truth = shade(true, bare(true), material, LIGHTS, "jensen2002", size)
    rim = surface(mesh).operator.rim
    inner = np.ones(len(truth), np.bool_)
    if rim.any():
        from scipy.spatial import cKDTree

        far = cKDTree(mesh.vertices[rim]).query(mesh.vertices)[0]
        inner = far > 4.0 * bake(material).glow / size
    truth = truth[inner]
    exposure = auto_exposure(truth)

    def errors(seen: Detail) -> Row:
        found = shade(mesh, known, material, LIGHTS, mm_per_unit=size, detail=seen)[inner]
        color = ciede2000(srgb_bytes(truth, exposure), srgb_bytes(found, exposure))
        return {
            "l2_percent": 100.0 * float(np.linalg.norm(found - truth) / np.linalg.norm(truth)),
            "mean": float(color.mean()),
            "p99": float(np.percentile(color, 99.0)),
        }

    return {
        name: min(map(errors, several), key=lambda row: row["l2_percent"])
        for name, several in ways(mesh, material, size).items()
    }


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=12_000, help="vertices of what is no scan")
    parser.add_argument("--quick", action="store_true", help="one scene")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    result: dict[str, dict[str, Row]] = {}

    def show(name: str, mesh: TriangleMesh, true: TriangleMesh, material: str, size: float) -> None:
        spacings = bake(material).glow / size / typical_spacing(mesh)
        title = f"{name}, {material}, {size:g} mm per unit, glow {spacings:.2g} spacings"
        result[title] = compared(mesh, true, material, size)
        if not options.json:
            print(title)
            for way, row in result[title].items():
                print(
                    f"  {way:11} {row['l2_percent']:6.2f} % L2, CIEDE2000 mean {row['mean']:5.2f}, "
                    f"p99 {row['p99']:5.2f}",
                    flush=True,
                )

    for name, (make, sizes) in (QUICK if options.quick else SCENES).items():
        mesh = make(options.count)
        for material in MATERIALS:
            for size in sizes:
                show(name, mesh, mesh, material, size)
    pairs = [(row["detail"], row["one scale"]) for row in result.values()]
    shares = {
        key: float(np.exp(np.mean([np.log(a[key] / b[key]) for a, b in pairs])))
        for key in ("l2_percent", "mean", "p99")
    }
    if not options.quick:
        exact = ring(options.count)
        for size in (0.5, 2.0):
            show(WITHOUT, exact.noisy(NOISE), exact.mesh, MATERIALS[0], size)
    if options.json:
        print(json.dumps({"errors": result, "detail_over_one_scale": shares}))
        return
    print(
        "detail over one scale, geometric means without the last two: "
        + ", ".join(f"{key} {share:.2f}" for key, share in shares.items())
    )


if __name__ == "__main__":
    main()
