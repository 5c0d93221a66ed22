"""Models against the random walk: python -m tests.bench.shading_truth [--all] [--again] [--json].

Relative L2 error over the whole surface, dark side included, per cent, by the body's size in l_d.
The truth is the walk's, from tests/data; both are means over its cells, and the walk's own
scatter is taken out. The size of a sphere or cylinder is its radius; an ellipsoid has half axes of
1.5, 1 and .7 of it. Every local model is measured with its defaults; the last rows are

- the dipole with F_t inside, integrated over the true sphere;
- `curvature-lut-physical` without oblique entry: c F_t rho (1 + c_H H), curvature of first order.
"""

import argparse
import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lutcore.baking import bake
from lutcore.diffusion import Optics
from lutcore.exitance import shade
from lutcore.fresnel import hinges
from lutcore.halfspace import flat_albedo
from lutcore.shading import model_registry, shading_models
from tests import walk_truth
from tests.bodies import Shaded
from tests.numpy_shading import even_form
from tests.quadrature import sphere_exitance
from tests.walk_truth import CASES, Case, stored

FloatArray = NDArray[np.float64]
VARIANTS: dict[str, tuple[str, dict[str, Any]]] = {
    "lambert, F_t(N.w)": ("lambert", {"fresnel": "directional"}),
    "curvature-lut-physical, 8 hinges": ("curvature-lut-physical", {"hinges": 8}),
    "curvature-lut-physical, deon2012": ("curvature-lut-physical", {"profile": "deon2012"}),
}
DIPOLE, STRAIGHT = "dipole on the true sphere", "physical, straight entry"
USUAL = (("skin1", 0), ("marble", 1))
COLORS = ("red", "green", "blue")


def models() -> dict[str, tuple[str, dict[str, Any]]]:
    """Return every local model with its defaults, and the variants."""
    local = [name for name in shading_models() if model_registry.get(name).local]
    return {**{name: (name, {}) for name in local}, **VARIANTS}


def straight(case: Case, cosines: FloatArray) -> FloatArray:
    """Return what leaves a sphere where rho (1 + c_H H) stands for R_d, light entering straight."""
    table, fit = bake(case.material), hinges(case.optics.eta, 4)
    beta, k = case.optics.beta, 1.0 / case.body.axes[0]
    lit = np.maximum(cosines, 0.0)
    inner = np.sqrt(1.0 - (1.0 - lit**2) / case.optics.eta**2)
    extrapolated = 0.5 * (case.optics.depth - 1.0)  # 2A/3
    gain = inner / (1.0 + beta * inner) + extrapolated / (1.0 + beta * extrapolated)
    b = k * np.sqrt(1.0 - cosines**2)
    glow = sum(
        weight * even_form(cosines - corner, b, table, case.channel)
        for corner, weight in zip(fit.corners, fit.weights, strict=True)
    )
    area = 1.0 + 0.5 * k * k * table.mean_square[case.channel]
    return np.asarray(glow * flat_albedo(lit, case.optics) * (1.0 + gain * k) / area)


def errors(case: Case, chosen: dict[str, tuple[str, dict[str, Any]]]) -> dict[str, float]:
    """Return the error of each model in one case, per cent."""
    body, (truth, error) = Shaded(case), stored(case)
    found = {}
    for label, (model, parameters) in chosen.items():
        shaded = shade(*body.surface, case.material, body.lights, model, **parameters)
        found[label] = body.l2(body.means(shaded[:, case.channel]), truth, error)
    if case.shape == "sphere":
        cosines, back = np.unique(body.surface[1].normals[:, 2].round(12), return_inverse=True)
        found[STRAIGHT] = body.l2(body.means(straight(case, cosines)[back]), truth, error)
        alone = Optics(case.optics.albedo, case.optics.eta)
        exact = sphere_exitance(cosines, case.body.axes[0], alone, nodes=12)
        found[DIPOLE] = body.l2(body.means(exact[back]), truth, error)
    return found


def tables(everything: bool) -> dict[str, dict[int, dict[str, float]]]:
    """Return errors by substance and shape, then by size in l_d, then by model."""
    found: dict[str, dict[int, dict[str, float]]] = {}
    for case in CASES:
        if everything or (case.material, case.channel) in USUAL:
            title = f"{case.shape}, {case.material} {COLORS[case.channel]}"
            found.setdefault(title, {})[case.ratio] = errors(case, models())
    return found


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--all", action="store_true", help="all channels of skin1 and marble")
    parser.add_argument("--again", action="store_true", help="first make the walk's data again")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    if options.again:
        walk_truth.make()
    found = tables(options.all)
    if options.json:
        print(json.dumps(found))
        return
    for title, rows in found.items():
        print(f"{title:34}" + "".join(f"{ratio:>8}" for ratio in rows))
        for label in next(iter(rows.values())):
            print(f"  {label:32}" + "".join(f"{row[label]:8.2f}" for row in rows.values()))


if __name__ == "__main__":
    main()
