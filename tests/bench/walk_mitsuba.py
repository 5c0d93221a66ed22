"""The walk against Mitsuba 3 (optional: pip install mitsuba): python -m tests.bench.walk_mitsuba.

A sphere full of the medium stands in light of radiance 1 from everywhere, seen by a camera
without perspective. By reciprocity the mean radiance over its disc is the share of directional
light that is not absorbed: left and reflected, of `walk`'s shares. Printed are both with their
standard errors.
"""

import importlib
import math

import numpy as np

from lutcore.diffusion import Optics
from lutcore.walk.bodies import sphere
from lutcore.walk.exitance import walk

CASES = ((2.0, Optics(0.5, 1.0)), (4.0, Optics(0.95855, 1.3)), (10.0, Optics(0.9984, 1.5)))
PHOTONS = 400_000
PIXELS, SAMPLES, RUNS = 32, 64, 16


def furnace(radius: float, optics: Optics) -> tuple[float, float]:
    """Return the mean radiance over the disc by Mitsuba, and its standard error."""
    mi = importlib.import_module("mitsuba")
    mi.set_variant("scalar_rgb")
    grey = {"type": "rgb", "value": [optics.albedo] * 3}
    medium = {"type": "homogeneous", "sigma_t": 1.0, "albedo": grey}
    surface = {"type": "dielectric", "int_ior": optics.eta, "ext_ior": 1.0}
    if optics.eta == 1.0:
        surface = {"type": "null"}
    film = {"type": "hdrfilm", "width": PIXELS, "height": PIXELS, "rfilter": {"type": "box"}}
    view = mi.ScalarTransform4f().look_at(origin=[0, 0, 2 * radius], target=[0] * 3, up=[0, 1, 0])
    to_world = view @ mi.ScalarTransform4f().scale([radius, radius, 1.0])
    scene = mi.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "volpath", "max_depth": -1, "rr_depth": 50},
            "sensor": {"type": "orthographic", "to_world": to_world, "film": film},
            "emitter": {"type": "constant", "radiance": 1.0},
            "body": {"type": "sphere", "radius": radius, "bsdf": surface, "interior": medium},
        }
    )
    means = [np.mean(np.array(mi.render(scene, spp=SAMPLES, seed=run))) for run in range(RUNS)]
    # The corners of the picture, beside the disc, show the light itself.
    disc = math.pi / 4.0
    values = (np.array(means) - (1.0 - disc)) / disc
    return float(values.mean()), float(values.std(ddof=1) / np.sqrt(RUNS))


def main() -> None:
    """Print the comparison."""
    print(f"{'radius':>8}{'albedo':>9}{'index':>7}{'walk':>18}{'Mitsuba':>18}{'sigma':>7}")
    for radius, optics in CASES:
        run = walk(sphere(radius), (0.0, 0.0, 1.0), optics, PHOTONS)
        ours = run.shares[0] + run.shares[2]
        theirs, error = furnace(radius, optics)
        off = (ours - theirs) / math.hypot(error, run.share_errors[0])
        print(
            f"{radius:8.1f}{optics.albedo:9.4f}{optics.eta:7.2f}{ours:11.4f}{run.share_errors[0]:7.4f}"
            f"{theirs:11.4f}{error:7.4f}{off:7.1f}"
        )


if __name__ == "__main__":
    main()
