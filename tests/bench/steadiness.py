"""How much curvature changes when a scan's vertices move a little, and what that takes.

    python -m tests.bench.steadiness [--limit 120] [--repeats 15] [--json]

On the laser scan sample:marble-face-raw. Every vertex moves along its normal by white noise of 1 %
of the mean edge there. The change of a vertex is the RMS of those of its k1 and k2; it is told over
the median of |k1| and |k2| together, of the vertices that faces use: its RMS, its median, and its
RMS over the 99 % of the vertices that change least. Heavy smoothing buys small changes: read them
beside the accuracy that `tests.bench.curvature` prints.

Times are of calls in turns with VTK's: a shared machine's speed changes from second to second, and
the least of each may be of different moments.
"""

import argparse
import json
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from app.chart.perturbation import perturbation
from app.loading import load_mesh
from app.samples import sample
from lutcore.errors import CancelledError, CurvelightError
from lutcore.geometry import typical_spacing
from lutcore.mesh import TriangleMesh
from lutcore.weld import weld
from tests.bench.curvature import Pair, estimate, vtk_curvatures

SAMPLE = "sample:marble-face-raw"
SHARE = 0.01  # of the mean edge
CALM = 99.0
Row = dict[str, Any]


def contestants(mesh: TriangleMesh) -> dict[str, tuple[str, dict[str, float]]]:
    """Return the estimators by the names of their rows: their own names and parameters."""
    joined = weld(mesh).mesh
    assert joined is not None
    return {
        "auto": ("auto", {}),
        "auto, steadiness 300": ("auto", {"steadiness": 300.0}),
        "co-smoothing, 4 spacings": ("co-smoothing", {"scale": 4.0 * typical_spacing(joined)}),
        "rusinkiewicz2004": ("rusinkiewicz2004", {}),
        "vtk": ("vtk", {}),
        "libigl radius 5": ("libigl", {"radius": 5}),
    }


def change(before: Pair, after: Pair, used: np.ndarray[Any, Any]) -> dict[str, float]:
    """Return how far curvatures differ, over the median curvature."""
    still, moved = np.stack(before)[:, used], np.stack(after)[:, used]
    size = float(np.median(np.abs(still)))
    each = np.sqrt(np.mean(np.square(moved - still), axis=0)) / size
    calm = each[each <= np.percentile(each, CALM)]
    return {
        "rms": float(np.sqrt(np.mean(each**2))),
        "median": float(np.median(each)),
        "rms of calmest 99 %": float(np.sqrt(np.mean(calm**2))),
    }


def changes(mesh: TriangleMesh, limit: float, seed: int) -> dict[str, Row]:
    """Return for each estimator how many values it gives and how much they change."""
    moved = perturbation(mesh, SHARE)(seed)
    used = np.zeros(len(mesh.vertices), bool)
    used[mesh.faces] = True
    table: dict[str, Row] = {}
    for name, (method, parameters) in contestants(mesh).items():
        try:
            still = estimate(mesh, method, limit, **parameters)
            after = estimate(moved, method, limit, **parameters)
        except CancelledError:
            table[name] = {"stopped": f"more than {limit:g} s"}
        except CurvelightError as error:
            table[name] = {"stopped": str(error)}
        else:
            lost = sum(int(np.count_nonzero(~np.isfinite(k))) for k in (*still, *after))
            table[name] = {
                "values": len(still[0]),
                "not finite": lost,
                **change(still, after, used),
            }
    return table


def time_over_vtk(mesh: TriangleMesh, repeats: int) -> dict[str, float]:
    """Return the time of `auto` over that of VTK's minimum and maximum: medians, and the least."""
    calls: list[Callable[[], Pair]] = [
        partial(estimate, mesh, "auto", np.inf),
        vtk_curvatures(mesh),
    ]
    seconds = np.empty((repeats + 1, 2))
    for turn in seconds:  # the first loads what is compiled
        for which, call in enumerate(calls):
            before = time.perf_counter()
            call()
            turn[which] = time.perf_counter() - before
    middle, least = np.median(seconds[1:], axis=0), np.min(seconds[1:], axis=0)
    return {"median": float(middle[0] / middle[1]), "least": float(least[0] / least[1])}


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--limit", type=float, default=120.0, help="seconds for one call")
    parser.add_argument("--repeats", type=int, default=15, help="of the calls that are timed")
    parser.add_argument("--seed", type=int, default=0, help="of the noise")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    mesh = load_mesh(sample(SAMPLE).path).mesh
    table = changes(mesh, options.limit, options.seed)
    ratio = time_over_vtk(mesh, options.repeats)
    if options.json:
        print(json.dumps({"vertices": len(mesh.vertices), "rows": table, "auto_over_vtk": ratio}))
        return
    print(f"{SAMPLE}, {len(mesh.vertices)} vertices, moved by {100 * SHARE:g} % of their edges")
    columns = list(table["auto"])
    print(f"  {'':26}", *(f"{column:>20}" for column in columns))
    for name, row in table.items():
        cells = (f"{row[column]:20.5g}" for column in columns if column in row)
        print(f"  {name:26}", row["stopped"] if "stopped" in row else " ".join(cells))
    print(
        f"time of auto over VTK's minimum and maximum: {ratio['median']:.2f} in the median, "
        f"{ratio['least']:.2f} of the least"
    )


if __name__ == "__main__":
    main()
