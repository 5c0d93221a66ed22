"""How often the truth lies within the error bars of `auto`, on surfaces known exactly.

    python -m tests.bench.error_bars [--tuned] [--size-factor 1] [--only torus,saddle] [--json]

The surfaces are other ones than those that the constants of `auto` were found on, which `--tuned`
measures: other shapes, numbers of vertices, triangulations and noise. Noise is along the exact
normal: white, of 2 % and 10 % of the mean edge, and correlated: white noise smoothed over 1.5 mean
edges, then of 5 %. Errors are the RMS of |(k1, k2) - exact| over the surface's RMS curvature; the
other columns are the shares of k1 and of k2 whose truth is within one and two sigma. Vertices
within two median scales of a rim are a table of their own. In the totals each surface counts as
much as any other.
"""

import argparse
import json
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial

import numpy as np

from lutcore.analytic import Exact, cylinder, ellipsoid, monkey_saddle, saddle, sphere, torus
from lutcore.arrays import BoolArray
from lutcore.cosmoothing import surface
from lutcore.curvature import PrincipalCurvatures
from lutcore.diagnostics import diagnose, vertex_scales
from lutcore.estimation import principal_curvatures
from lutcore.lowpass import low_pass
from lutcore.mesh import TriangleMesh
from lutcore.recurrence import FIELDS
from lutcore.weld import weld

Make = Callable[..., Exact]
Shapes = tuple[tuple[str, Make, int], ...]


def _ellipsoids(axes: Iterable[tuple[float, float, float]], sizes: Iterable[int]) -> Shapes:
    return tuple(
        (f"ellipsoid {a:g}:{b:g}:{c:g}", partial(ellipsoid, axes=(a, b, c)), size)
        for a, b, c in axes
        for size in sizes
    )


TUNED: Shapes = (
    ("torus", torus, 20_000),
    *_ellipsoids(((1.0, 0.7, 0.5), (1.0, 1.0, 0.4), (1.0, 0.4, 0.3)), (4_000, 20_000)),
    ("sphere", sphere, 20_000),
    ("cylinder", cylinder, 20_000),
    ("saddle", saddle, 20_000),
    ("monkey saddle", monkey_saddle, 20_000),
)
HELD_OUT: Shapes = (
    ("torus .2", partial(torus, minor=0.2), 30_000),
    ("torus .5", partial(torus, minor=0.5), 8_000),
    *_ellipsoids(((1.0, 0.8, 0.6), (1.0, 0.9, 0.35), (1.0, 0.5, 0.45)), (7_000, 40_000)),
    ("sphere", sphere, 9_000),
    ("cylinder", cylinder, 12_000),
    ("saddle", saddle, 30_000),
    ("monkey saddle .8", partial(monkey_saddle, bend=0.8), 12_000),
)
SEEDS = {TUNED: 0, HELD_OUT: 11}
CORRELATED, LENGTH = 0.05, 1.5  # of the mean edge
# What is asked for: the truth within one sigma, and within two, for these shares of the vertices.
ONE, TWO = (0.6, 0.75), (0.92, 0.98)
RIM_SCALES = 2.0
Row = dict[str, float]


def correlated(exact: Exact, seed: int) -> TriangleMesh:
    """Return the mesh with noise along the exact normals that neighbours have in common."""
    mesh = exact.mesh
    edges = mesh.vertices[mesh.faces] - mesh.vertices[np.roll(mesh.faces, 1, axis=1)]
    edge = float(np.sqrt(np.square(edges).sum(axis=2)).mean())
    welded = weld(mesh)
    assert welded.mesh is not None
    on = surface(welded.mesh)
    white = np.random.default_rng(seed).standard_normal((len(on.fields), FIELDS))
    change = low_pass(on.operator, white, [LENGTH * edge]).reshape(white.shape)  # of one scale
    wave = white[:, 0] + change[:, 0]
    offsets = CORRELATED * edge * welded.spread(wave / wave.std(), 0.0)
    return TriangleMesh(mesh.vertices + offsets[:, None] * exact.truth.normals, mesh.faces)


NOISES: dict[str, Callable[[Exact, int], TriangleMesh]] = {
    "white 2 %": lambda exact, seed: exact.noisy(0.02, seed),
    "white 10 %": lambda exact, seed: exact.noisy(0.1, seed),
    "correlated 5 %": correlated,
}


def near_rim(mesh: TriangleMesh, found: PrincipalCurvatures) -> BoolArray:
    """Mark vertices within two median scales of a border."""
    reach = RIM_SCALES * float(np.median(vertex_scales(found)))
    return diagnose(mesh, replace(found, scale=reach)).border


def judged(exact: Exact, found: PrincipalCurvatures, group: BoolArray) -> Row:
    """Return how wrong an estimate is on a group of vertices, and how often within its bars."""
    truth, bars = exact.truth, (found.error1[group], found.error2[group])
    off = [np.abs(found.k1 - truth.k1)[group], np.abs(found.k2 - truth.k2)[group]]
    size = float(np.sqrt(np.mean(truth.k1**2 + truth.k2**2)))
    return {
        "vertices": float(np.count_nonzero(group)),
        "error": float(np.sqrt(np.mean(off[0] ** 2 + off[1] ** 2))) / size,
        **{
            f"k{1 + which} within {sigmas}": float(np.mean(off[which] <= sigmas * bars[which]))
            for sigmas in (1, 2)
            for which in (0, 1)
        },
    }


def measured(
    shapes: Shapes, only: tuple[str, ...], factor: float
) -> tuple[dict[str, Row], dict[str, Row], int]:
    """Return the rows of the interior and of the border, and how many values are not finite."""
    interior: dict[str, Row] = {}
    border: dict[str, Row] = {}
    lost, seed = 0, SEEDS[shapes]
    for name, make, size in shapes:
        if not name.startswith(only):
            continue
        for irregular in (False, True):
            exact = make(round(factor * size), irregular, seed=seed)
            for noise, disturbed in NOISES.items():
                tiling = "irregular" if irregular else "regular"
                row = f"{name}, {len(exact.mesh.vertices)} {tiling}, {noise}"
                mesh = disturbed(exact, seed)
                found = principal_curvatures(mesh, "auto")
                lost += int(np.count_nonzero(~np.isfinite([found.k1, found.k2, found.error])))
                rim = near_rim(mesh, found)
                if not rim.all():
                    interior[row] = judged(exact, found, ~rim)
                if rim.any():
                    border[row] = judged(exact, found, rim)
    return interior, border, lost


def totals(rows: dict[str, Row]) -> dict[str, Row]:
    """Return the means over rows, for each noise and for all, and how many rows are as asked."""
    groups = {
        noise: [row for name, row in rows.items() if name.endswith(noise)] for noise in NOISES
    }
    groups["all"] = list(rows.values())
    return {
        name: {
            **{
                column: float(np.mean([row[column] for row in group]))
                for column in group[0]
                if column != "vertices"
            },
            "as asked": float(np.mean([as_asked(row) for row in group])),
        }
        for name, group in groups.items()
        if group
    }


def as_asked(row: Row) -> bool:
    """Tell whether k1 and k2 together are within their bars as often as is asked."""
    one, two = (0.5 * (row[f"k1 within {n}"] + row[f"k2 within {n}"]) for n in (1, 2))
    return ONE[0] <= one <= ONE[1] and TWO[0] <= two <= TWO[1]


def show(title: str, rows: dict[str, Row]) -> None:
    """Print one table."""
    columns = [column for column in next(iter(rows.values())) if column != "vertices"]
    print(f"{title:52}", *(f"{column:>11}" for column in columns))
    for name, row in rows.items():
        print(f"  {name:50}", *(f"{row[column]:11.4f}" for column in columns))


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size-factor", type=float, default=1.0, help="on all vertex counts")
    parser.add_argument("--only", metavar="A,B", help="surfaces whose names begin so")
    parser.add_argument("--tuned", action="store_true", help="the surfaces of the constants")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    only = tuple((options.only or "").split(","))
    shapes = TUNED if options.tuned else HELD_OUT
    interior, border, lost = measured(shapes, only, options.size_factor)
    if not interior:
        names = ", ".join(dict.fromkeys(name for name, _, _ in shapes))
        parser.error(f"--only {options.only} names no surface; choose of {names}")
    tables = {
        "interior": interior,
        "border": border,
        "interior, all surfaces": totals(interior),
        "border, all surfaces": totals(border),
    }
    if options.json:
        print(json.dumps({**tables, "not_finite": lost}))
        return
    for title, rows in tables.items():
        if rows:
            show(title, rows)
    print(f"values or error bars that are not finite: {lost}")


if __name__ == "__main__":
    main()
