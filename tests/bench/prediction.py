"""Predicted errors against true ones, and choices against both: python -m tests.bench.prediction.

1. On held-out shapes, under random materials, sizes and lights: share of the values (vertex and
   channel) whose true error is below the predicted one, and the median of predicted over true
   where either is above 1e-4 R_d: below that both are right, and the reference, brute force over
   all triangles, resolves no more. `noisy` is a torus with noise along its normals, shaded with
   what was estimated from it, for each channel or at one scale, against the light gathered over
   the noisy mesh itself; `scan`, `other scan` and `bunny` are sample scans, away from their
   borders, and lit from the front where they are open. No constant was chosen by the bunny.
2. Seeded scenes: how often the chosen model meets the tolerance, and how often a local model that
   is adequate as well would have cost less by more than a fifth. Both are judged over vertices by
   brute force, by other vertices than those `choose` checks at: --judged of them, and all where the
   score is within a quarter of the tolerance. --predicted-only leaves the check of `choose` out.
   --metric asks for tolerances of colour, in the same scenes; --shadows takes tori under low light,
   which shadow themselves, with cast shadows on both sides.

--seed N changes all that is random. --tune prints what the weights of `lutcore.prediction` come
from (`tests.bench.tuning`): random shapes of the same families as those of the table, other draws;
the cylinder, the noisy torus and the scans differ in size, material, light and noise alone.
"""

import argparse
import json
import sys
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lutcore import analytic
from lutcore.baking import BETA_FLOOR
from lutcore.blend import at
from lutcore.choice import choose
from lutcore.color import auto_exposure
from lutcore.costs import Candidate, candidates, costs
from lutcore.curvature import PrincipalCurvatures
from lutcore.detail import detail_seen
from lutcore.estimation import principal_curvatures
from lutcore.exitance import exitance
from lutcore.gather.exitance import exact, hierarchy
from lutcore.lights import DirectionalLight
from lutcore.materials import Material, material
from lutcore.mesh import TriangleMesh
from lutcore.open_mesh import light_lost
from lutcore.prediction import Scene
from lutcore.progress import silent
from lutcore.scale import shading_scale
from lutcore.shading import ShadingInputs, shading_inputs
from lutcore.tolerance import METRICS, Tolerance, color_distances, relative
from lutcore.visibility import softened, visibility
from tests.bumps import bare

FloatArray = NDArray[np.float64]
MATERIALS = ("skin1", "skin2", "marble", "ketchup", "apple", "cream", "potato", "wholemilk")
# Smallest radius of curvature in diffusion lengths of the middle channel.
SIZES = (2.0, 60.0)
# Sizes of the sample scans over those that they are said to have.
SCAN_SIZES = (1.0, 10.0)
# The gathered light of meshes that are measured errs by less than a thousandth of this R_d.
REFERENCE = 3e-4
TOLERANCES = {
    "relative": (0.004, 0.1),
    "mean-de2000": (0.1, 2.0),
    "p99-de2000": (0.3, 6.0),
}
COVERED, WIDE, SEEN = 0.95, 5.0, 1e-4
# Of the area, what the normals' sum is of a surface that encloses nothing.
OPEN = 0.1
NEAR = 0.25  # of the logarithm of score over tolerance
COUNTED = (
    "met",
    "beaten_by_a_model_that_turned_out_adequate",
    "overruled",
    "unchecked",
    "blended",
    "gathered",
    "left_out_shadows_would_do",
)


@dataclass(frozen=True)
class Case:
    """A scene with its truth at some vertices."""

    inputs: ShadingInputs
    truth: FloatArray
    chosen: NDArray[np.int64]
    scene: Scene


Shape = tuple[TriangleMesh, PrincipalCurvatures, FloatArray]


def smooth(found: analytic.Exact, inner: FloatArray | None = None) -> Shape:
    """Return a shape with the weights of its vertices."""
    everywhere = np.ones(len(found.mesh.vertices))
    return found.mesh, found.truth, everywhere if inner is None else everywhere * inner


def held_out(name: str, count: int) -> Shape:
    """Return a shape of the table."""
    if name == "cylinder":
        found = analytic.cylinder(count, radius=1.0, length=10.0)
        return smooth(found, np.abs(found.mesh.vertices[:, 2] - 5.0) < 1.0)
    if name == "torus":
        return smooth(analytic.torus(count, major=2.6, minor=1.0))
    axes = {"2:1 long": (2, 1, 1), "4:1 long": (4, 1, 1), "4:1 flat": (4, 4, 1), "4:2:1": (4, 2, 1)}
    return smooth(analytic.ellipsoid(count, axes=axes[name]))


# Noisy tori: whether what each channel's light sees is shaded, as by default, or one scale.
NOISY = {"noisy, 1 scale": False, "noisy": True}
SCANS = {"scan": "marble-face-raw", "other scan": "marble-face", "bunny": "bunny"}
HELD_OUT = ("2:1 long", "4:1 long", "4:1 flat", "4:2:1", "cylinder", "torus")


def any_shape(generator: np.random.Generator, count: int) -> Shape:
    """Return a random shape."""
    kind = generator.choice(["ellipsoid", "torus", "cylinder"], p=[0.6, 0.3, 0.1])
    if kind == "torus":
        return smooth(analytic.torus(count, major=1.0 / generator.uniform(0.2, 0.6), minor=1.0))
    if kind == "cylinder":
        return held_out("cylinder", count)
    longest = 4.0 ** generator.random()
    return smooth(analytic.ellipsoid(count, axes=(longest, longest ** generator.random(), 1.0)))


def self_shadowing(generator: np.random.Generator, count: int) -> Shape:
    """Return a ring that is thin enough to shadow itself under most lights."""
    return smooth(analytic.torus(count, major=1.0 / generator.uniform(0.3, 0.7), minor=1.0))


def light(generator: np.random.Generator) -> DirectionalLight:
    direction = generator.standard_normal(3)
    return DirectionalLight(direction, float(generator.uniform(0.3, 1.0)))


def before(mesh: TriangleMesh, lit: DirectionalLight) -> DirectionalLight:
    """Return a light on the side that an open surface shows: there is no body that it crosses."""
    corners = mesh.vertices[mesh.faces]
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    whole = areas.sum(axis=0)
    open_ = np.linalg.norm(whole) > OPEN * np.linalg.norm(areas, axis=1).sum()
    if open_ and whole @ np.asarray(lit.direction) < 0.0:
        return replace(lit, direction=-np.asarray(lit.direction))
    return lit


def size_in_mm(shape: PrincipalCurvatures, of: Material, generator: np.random.Generator) -> float:
    """Return millimetres in one unit."""
    lengths = of.mean_free_path / np.maximum(of.beta, BETA_FLOOR)
    largest = float(np.maximum(np.abs(shape.k1), np.abs(shape.k2)).max())
    low, high = np.log(SIZES)
    return float(np.median(lengths) * largest * np.exp(generator.uniform(low, high)))


def scene(shape: Shape, generator: np.random.Generator, lights: int) -> ShadingInputs:
    """Return a scene under random light."""
    mesh, curvatures, _ = shape
    of = material(str(generator.choice(MATERIALS)))
    size = size_in_mm(curvatures, of, generator)
    lit = [light(generator) for _ in range(lights)]
    return shading_inputs(mesh, curvatures, of, lit, size)


def case(shape: Shape, generator: np.random.Generator, points: int) -> Case:
    """Return a scene under random light with its truth."""
    mesh, curvatures, weight = shape
    inputs = scene(shape, generator, 1)
    areas = Scene.of(inputs, curvatures).facet * weight
    chosen = generator.choice(len(areas), points, replace=False, p=areas / areas.sum())
    truth = exact(inputs, mesh.vertices[chosen])
    return Case(inputs, truth, chosen, Scene.of(inputs, curvatures).at(chosen))


def noisy(generator: np.random.Generator, points: int, count: int, by_channel: bool) -> Case:
    """Return a noisy scan: what is known of it is estimated, the truth is gathered from it."""
    body = analytic.torus(count, irregular=True, major=2.4, minor=1.0)
    mesh = body.noisy(0.1, int(generator.integers(1 << 30)))
    of = material(str(generator.choice(MATERIALS)))
    return measured(mesh, of, size_in_mm(body.truth, of, generator), generator, points, by_channel)


def scanned(name: str, generator: np.random.Generator, points: int) -> Case:
    """Return a sample scan as `shade` has it, where its borders take no light."""
    from app.loading import load_mesh
    from app.samples import sample

    known = sample(name)
    mesh = load_mesh(known.path).mesh
    of = material(str(generator.choice(MATERIALS)))
    size = known.mm_per_unit * float(np.exp(generator.uniform(*np.log(SCAN_SIZES))))
    return measured(mesh, of, size, generator, points, True)


def measured(
    mesh: TriangleMesh,
    of: Material,
    size: float,
    generator: np.random.Generator,
    points: int,
    by_channel: bool,
) -> Case:
    """Return a scene whose curvature is estimated, for all channels at one scale or for each."""
    own = shading_inputs(mesh, bare(mesh), of, [before(mesh, light(generator))], size)
    found = principal_curvatures(mesh, "auto", shading_scale(mesh, own.table.glow / size))
    detail = detail_seen(mesh, of, size) if by_channel else None
    given = shading_inputs(mesh, found, of, [], size, detail=detail)
    inputs = replace(given, lights=own.lights)
    held = np.any(inputs.normals != 0.0, axis=1) & (light_lost(inputs) < SEEN)
    where = np.flatnonzero(held)
    chosen = generator.choice(where, min(points, len(where)), replace=False)
    truth = hierarchy(own, REFERENCE, silent).at(own.points[chosen], silent)
    return Case(inputs, truth, chosen, Scene.of(inputs, found).at(chosen))


def true_and_predicted(one: Candidate, of: Case) -> tuple[FloatArray, FloatArray]:
    """Return both errors of a local model at the chosen vertices, in R_d."""
    predicted = one.model.predicted_error(of.scene)
    assert predicted is not None
    given = exitance(one.model, at(of.inputs, of.chosen))
    return np.abs(given - of.truth) / of.inputs.table.total, predicted


def predictable() -> list[Candidate]:
    """Return the local models that predict their error."""
    generator = np.random.default_rng(0)
    scene = case(held_out("2:1 long", 500), generator, 5).scene
    return [c for c in candidates() if c.model.local and c.model.predicted_error(scene) is not None]


def coverage(seed: int, draws: int, points: int, count: int) -> dict[str, dict[str, list[float]]]:
    """Return share covered and median ratio by shape and model."""
    found: dict[str, dict[str, list[float]]] = {}
    models = predictable()
    for row, name in enumerate((*HELD_OUT, *NOISY, *SCANS)):
        generator = np.random.default_rng((seed, row))
        if name in NOISY:
            cases = [noisy(generator, points, count, NOISY[name]) for _ in range(draws)]
        elif name in SCANS:
            cases = [scanned(SCANS[name], generator, points) for _ in range(draws)]
        else:
            shape = held_out(name, count)
            cases = [case(shape, generator, points) for _ in range(draws)]
        found[name] = {}
        print(name, file=sys.stderr)
        for one in models:
            pairs = [true_and_predicted(one, of) for of in cases]
            true = np.concatenate([pair[0].ravel() for pair in pairs])
            predicted = np.concatenate([pair[1].ravel() for pair in pairs])
            seen = np.maximum(true, predicted) > SEEN
            ratio = np.median(predicted[seen] / np.maximum(true[seen], 1e-12))
            found[name][one.label] = [float(np.mean(true <= predicted)), float(ratio)]
    return found


class Judgement:
    """The true error of what models give in a scene, over vertices that `choose` did not draw.

    At `points` random vertices, and where their 99th percentile is near the tolerance, at all: one
    in a hundred of some thousand is told to a tenth, and errors crowd there.
    """

    def __init__(
        self, shape: Shape, inputs: ShadingInputs, tolerance: Tolerance, seed: int
    ) -> None:
        self.inputs, self.tolerance = inputs, tolerance
        assert inputs.curvatures is not None
        self.irradiance = Scene.of(inputs, inputs.curvatures).irradiance
        self.exposure = 0.0
        self.inner = np.flatnonzero(shape[2] > 0.0)
        self.order = np.random.default_rng(seed).permutation(self.inner)
        self.truth = np.zeros((0, 3))

    def score(self, given: FloatArray, points: int) -> float:
        """Return the score of what a model gave at all vertices."""
        found = self._over(given, points)
        near = abs(np.log(max(found, 1e-9) / self.tolerance.value)) < NEAR
        return self._over(given, len(self.order)) if near else found

    def _over(self, given: FloatArray, points: int) -> float:
        some = self.order[:points]
        missing = some[len(self.truth) :]
        if len(missing):
            self.truth = np.concatenate(
                [self.truth, exact(self.inputs, self.inputs.points[missing])]
            )
            self.exposure = self.exposure or auto_exposure(self.truth)
        truth = self.truth[: len(some)]
        if self.tolerance.metric != "relative":
            return self.tolerance.score(color_distances(given[some], truth, self.exposure))
        off = np.abs(given[some] - truth) / self.inputs.table.total
        return self.tolerance.score(relative(off, self.irradiance))


def shadowed(inputs: ShadingInputs) -> ShadingInputs:
    """Return a scene with the shadows that its surface casts, as pictures have them."""
    mesh = TriangleMesh(inputs.points, inputs.faces)
    table = inputs.table
    seen = visibility(mesh, inputs.lights)
    glow = table.mean_free_path * table.psi[:, 0] / inputs.mm_per_unit
    return replace(inputs, visibility=seen, softened=softened(seen, mesh, glow))


def scenes(
    seed: int, numbers: range, points: int, count: int, checked: bool, metric: str, cast: bool
) -> dict[str, object]:
    """Return how the choices in seeded scenes turned out.

    Cost is that of each picture; what the check takes is paid once, and is told apart.
    """
    known, models = costs(), candidates()
    found: dict[str, int] = dict.fromkeys(COUNTED, 0)
    worst, spent, saved, hidden = 0.0, [], [], []
    losers: list[str] = []
    for number in numbers:
        generator = np.random.default_rng((seed, 100, number))
        shape = self_shadowing(generator, count) if cast else any_shape(generator, count)
        inputs = scene(shape, generator, int(generator.integers(1, 3)))
        if cast:
            inputs = shadowed(inputs)
            hidden.append(1.0 - inputs.visibility.mean())
        low, high = np.log(TOLERANCES[metric])
        tolerance = Tolerance(float(np.exp(generator.uniform(low, high))), metric)
        choice = choose(inputs, tolerance, known, models, checked=checked)
        judge = Judgement(shape, inputs, tolerance, number + 1)
        got = judge.score(exitance(choice.model, inputs), points)
        met = got <= tolerance.value
        worst = max(worst, got / tolerance.value)
        cheaper = [rung for rung in choice.rungs if choice.milliseconds > 1.2 * rung.milliseconds]
        better = {
            rung.candidate.label: value / tolerance.value
            for rung in cheaper
            if rung.candidate.model.local and not np.isnan(rung.score)
            if (value := judge.score(exitance(rung.candidate.model, inputs), points))
            <= tolerance.value
        }
        if better or not met:
            label = choice.chosen.candidate.label
            losers.append(f"{number}: {label} at {got / tolerance.value:.3f}, others {better}")
        found["met"] += met
        found["beaten_by_a_model_that_turned_out_adequate"] += bool(better)
        found["overruled"] += choice.overruled
        found["unchecked"] += bool(choice.coverage.reason)
        found["blended"] += choice.blend is not None
        found["gathered"] += not choice.model.local
        found["left_out_shadows_would_do"] += (
            choice.unshadowed is not None and choice.unshadowed.high <= tolerance.value
        )
        spent.append(choice.check_milliseconds)
        if choice.blend is not None:
            saved.append(choice.milliseconds / choice.chosen.milliseconds)
        print(f"scene {number}: {found}", file=sys.stderr)
    return {
        "scenes": len(numbers),
        **found,
        "worst_over_tolerance": worst,
        "check_milliseconds_median": float(np.median(spent)),
        "cost_of_blends_over_that_of_the_better_model": saved,
        "pairs_of_light_and_vertex_in_shadow": float(np.mean(hidden)) if cast else 0.0,
        "score_over_tolerance_where_not_as_wanted": losers,
    }


def show(table: dict[str, dict[str, list[float]]]) -> None:
    """Print the first part."""
    print("true error below the predicted, %, and median of predicted over true")
    print(f"{'':28}" + "".join(f"{name:>15}" for name in table))
    for label in next(iter(table.values())):
        cells = (row[label] for row in table.values())
        print(f"{label:28}" + "".join(f"{100 * share:8.1f} {ratio:6.2f}" for share, ratio in cells))
    every = [cell for row in table.values() for cell in row.values()]
    low, wide = min(cell[0] for cell in every), max(cell[1] for cell in every)
    good = sum(share >= COVERED and ratio <= WIDE for share, ratio in every)
    print(f"least covered {100 * low:.1f} %, widest {wide:.2f}; {good} of {len(every)} cells meet")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--draws", type=int, default=12, help="scenes for each shape; 0: none")
    parser.add_argument("--scenes", type=int, default=100)
    parser.add_argument("--first", type=int, default=0, help="number of the first scene")
    parser.add_argument("--points", type=int, default=200, help="vertices with a truth")
    parser.add_argument("--judged", type=int, default=2000, help="vertices that judge a choice")
    parser.add_argument("--predicted-only", action="store_true", help="choose without the check")
    parser.add_argument("--count", type=int, default=12_000, help="vertices of a mesh")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--tune", type=int, metavar="SCENES", help="print weights, and stop")
    parser.add_argument("--metric", choices=METRICS, default=METRICS[0])
    parser.add_argument("--shadows", action="store_true", help="rings, with cast shadows")
    options = parser.parse_args()
    if options.tune:
        from tests.bench.tuning import tune

        tune(options.seed, options.tune, options.points, options.count)
        return
    table: dict[str, dict[str, list[float]]] = {}
    if options.draws:
        table = coverage(options.seed, options.draws, options.points, options.count)
    checked = not options.predicted_only
    choices: dict[str, object] = {}
    if options.scenes:
        numbers = range(options.first, options.first + options.scenes)
        wanted = (checked, options.metric, options.shadows)
        choices = scenes(options.seed, numbers, options.judged, options.count, *wanted)
    if options.json:
        print(json.dumps({"prediction": table, "choice": choices}))
        return
    if table:
        show(table)
    for key, value in choices.items():
        print(f"{key}: {value:.3g}" if isinstance(value, int | float) else f"{key}: {value}")


if __name__ == "__main__":
    main()
