"""Accuracy of tables and models: python -m tests.bench.shading_accuracy [--json].

1. psi tables of all materials: largest error in units of R_d against adaptive quadrature of the
   paper's double integral, at the place where the table is worst; and the time of an RGB bake.
2. Every local model on a sphere, skin1 red: relative L2 error over the whole sphere (by area, dark
   side included) against the dipole integrated over the true sphere with F_t inside, per cent.
   `curvature-lut-physical` is made for another truth, the random walk: see shading_truth.
3. The light that leaves that sphere, over what would leave it if every place were flat.
"""

import argparse
import json
import time
from typing import Any

import numpy as np

from lutcore.baking import BETA_FLOOR, bake, bake_plane
from lutcore.diffusion import Optics, optics
from lutcore.exitance import shade
from lutcore.lights import DirectionalLight
from lutcore.lut import PsiTable, even_form
from lutcore.materials import material, materials
from lutcore.shading import model_registry, shading_models
from tests.quadrature import FloatArray, paper_psi, sphere_exitance
from tests.surfaces import sphere

SAMPLES = (16, 32, 64, 128)
RATIOS = (2, 5, 10, 20, 50)
ENERGY_RATIOS = (1, 2, 5, 10, 20)
MODELS: dict[str, tuple[str, dict[str, Any]]] = {
    "lambert, <F_t>": ("lambert", {"fresnel": "mean"}),
    "lambert, F_t(N.w)": ("lambert", {"fresnel": "directional"}),
    "first order, F_t inside": ("curvature-lut", {"hinges": 16, "area": "flat"}),
    **{
        name: (name, {})
        for name in shading_models()
        if name != "lambert" and model_registry.get(name).local
    },
}


def psi_at(u: FloatArray, table: PsiTable, channel: int) -> FloatArray:
    """Return the table's psi, read as shading reads it."""
    rows, step = table.rows, table.inverse_step
    return np.array([even_form(-x, 1.0, rows, step, channel) for x in u])


def shaped(name: str, channel: int) -> Optics:
    """Return the constants that the glow is computed for, after the floor."""
    exact = optics(material(name))[channel]
    return Optics(min(exact.albedo, 1.0 - BETA_FLOOR**2 / 3.0), exact.eta)


def psi_error(name: str, samples: int) -> float:
    """Return the error of a table where it is largest, against the double integral."""
    table, fine = bake(name, samples), bake(name, 2048)
    errors = []
    for channel in range(3):
        u = np.sinh(np.linspace(0.0, table.reach[channel], 8 * samples))
        difference = psi_at(u, table, channel) - psi_at(u, fine, channel)
        worst = u[np.argmax(np.abs(difference))]
        constants = shaped(name, channel)
        beta, B = constants.beta, constants.depth
        total = 0.5 * constants.albedo * (np.exp(-beta) + np.exp(-B * beta))
        truth = paper_psi(float(worst), constants, float(total))
        errors.append(abs(psi_at(np.array([worst]), table, channel)[0] - truth))
    return float(max(errors))


def on_sphere(
    radius_ratio: float, nodes: int, name: str, channel: int
) -> tuple[FloatArray, FloatArray, dict[str, FloatArray]]:
    """Return shares of the area, the truth there, and what each model gives."""
    constants = optics(material(name))[channel]
    radius = radius_ratio / constants.beta
    x, weights = np.polynomial.legendre.leggauss(nodes)
    # Equal steps of the cosine are equal areas; the exitance bends at the terminator.
    cosines = np.concatenate((0.5 * (x - 1.0), 0.5 * (x + 1.0)))
    shares = 0.25 * np.concatenate((weights, weights))
    truth = sphere_exitance(cosines, radius, constants)
    surface = sphere(cosines, radius * float(material(name).mean_free_path[channel]))
    light = DirectionalLight((0.0, 0.0, 1.0))
    shaded = {
        label: shade(*surface, name, [light], model, **parameters)[:, channel]
        for label, (model, parameters) in MODELS.items()
    }
    return shares, truth, shaded


def model_errors(
    radius_ratio: float, nodes: int = 64, name: str = "skin1", channel: int = 0
) -> dict[str, float]:
    """Return each model's relative L2 error on a sphere of `radius_ratio` l_d, per cent."""
    shares, truth, shaded = on_sphere(radius_ratio, nodes, name, channel)
    scale = np.sum(shares * truth**2)
    return {
        label: 100.0 * float(np.sqrt(np.sum(shares * (value - truth) ** 2) / scale))
        for label, value in shaded.items()
    }


def model_energies(
    radius_ratio: float, nodes: int = 64, name: str = "skin1", channel: int = 0
) -> dict[str, float]:
    """Return what leaves a sphere of `radius_ratio` l_d by each model, over R_d <F_t> of the light.

    The last entry is the dipole's own.
    """
    shares, truth, shaded = on_sphere(radius_ratio, nodes, name, channel)
    table = bake(name)
    entering = 0.25 * table.total[channel] * table.entering[channel]  # mean of max(N.w, 0)
    shaded["dipole on the sphere"] = truth
    return {label: float(np.sum(shares * value) / entering) for label, value in shaded.items()}


def bake_milliseconds(name: str) -> float:
    """Return the time of an RGB bake of 64 samples that is in no cache, best of 5."""
    bake(name, 96)
    seconds = []
    for attempt in range(5):
        # A factor next to one makes it another material to the cache.
        fresh = material(name).scaled(1.0 + 1e-12 * (attempt + 1 + time.perf_counter()))
        start = time.perf_counter()
        bake(fresh)
        seconds.append(time.perf_counter() - start)
    return 1e3 * min(seconds)


def plane_error(name: str, size: int) -> float:
    """Return the largest error of the bilinear (a, b) table in units of R_d."""
    plane, table = bake_plane(name, size), bake(name, 256)
    generator = np.random.default_rng(0)
    a = generator.uniform(-1.0, 1.0, 200_000)
    kappa = generator.uniform(0.0, plane.limit / plane.mean_free_path.max(), 200_000)
    return float(np.abs((plane.evaluate(a, kappa) - table.evaluate(a, kappa)) / table.total).max())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    tables = {name: {n: psi_error(name, n) for n in SAMPLES} for name in materials()}
    times = {name: bake_milliseconds(name) for name in materials()}
    models = {ratio: model_errors(ratio) for ratio in RATIOS}
    energies = {ratio: model_energies(ratio) for ratio in ENERGY_RATIOS}
    plane = plane_error("skin1", 512)
    if options.json:
        found = {"psi": tables, "bake_ms": times, "models": models, "energy": energies}
        print(json.dumps({**found, "plane": plane}))
        return
    print("error of psi / R_d by samples, and RGB bake of 64")
    print(f"{'':12}" + "".join(f"{n:>10}" for n in SAMPLES) + f"{'ms':>8}")
    for name, row in tables.items():
        print(f"{name:12}" + "".join(f"{row[n]:10.1e}" for n in SAMPLES) + f"{times[name]:8.2f}")
    print(f"(a, b) table, 512 x 512, bilinear, skin1: {plane:.1e}")
    print("relative L2 error on the sphere, %, by radius / l_d (skin1, red)")
    show(models, 3)
    print("light that leaves the sphere / R_d <F_t>, by radius / l_d (skin1, red)")
    show(energies, 4)


def show(columns: dict[int, dict[str, float]], digits: int) -> None:
    """Print a row for each model."""
    print(f"{'':24}" + "".join(f"{ratio:>9}" for ratio in columns))
    for label in next(iter(columns.values())):
        print(f"{label:24}" + "".join(f"{row[label]:9.{digits}f}" for row in columns.values()))


if __name__ == "__main__":
    main()
