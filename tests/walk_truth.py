"""Truth by random walk, kept as small data: python -m tests.walk_truth makes it again.

tests/data/walk.json holds radiant exitance per unit normal irradiance, means over cells of the
surface, and standard errors, of bodies in directional light. tests/data/flat_albedo.json holds
the share of the light that entered a flat surface that leaves it. Eight minutes of one core; the
same seed gives the same files.
"""

import json
import sys
from dataclasses import asdict, dataclass
from functools import lru_cache
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lutcore.diffusion import Optics, optics
from lutcore.fresnel import transmittance
from lutcore.materials import material
from lutcore.walk.bodies import Body, half_space
from lutcore.walk.exitance import walk

FloatArray = NDArray[np.float64]
FOLDER = Path(__file__).parent / "data"
SEED = 20071201
RATIOS = (1, 2, 5, 10, 20, 50)
# Axes in units of the size, light, rows and columns.
SHAPES: dict[str, tuple[tuple[float, float, float], tuple[float, float, float], int, int]] = {
    "sphere": ((1.0, 1.0, 1.0), (0.0, 0.0, 1.0), 40, 1),
    "cylinder": ((1.0, 1.0, np.inf), (1.0, 0.0, 0.0), 40, 1),
    "oblique cylinder": ((1.0, 1.0, np.inf), (1.0, 0.0, 1.0), 40, 1),
    "ellipsoid": ((1.5, 1.0, 0.7), (1.0, 2.0, 2.0), 16, 8),
}


@dataclass(frozen=True)
class Case:
    """One body of one substance: what `walk` is asked for; `ratio` is its size in l_d."""

    shape: str
    material: str
    channel: int
    ratio: int
    photons: int

    @property
    def optics(self) -> Optics:
        return optics(material(self.material))[self.channel]

    @property
    def body(self) -> Body:
        """The body, its lengths in l_u."""
        size = self.ratio / self.optics.beta
        x, y, z = SHAPES[self.shape][0]
        return Body((size * x, size * y, size * z))

    @property
    def cells(self) -> tuple[tuple[float, float, float], int, int]:
        """Direction to the light, rows and columns."""
        return SHAPES[self.shape][1:]


CASES = tuple(
    Case("sphere", name, channel, ratio, photons)
    for name, channel, photons in (
        ("skin1", 0, 12_000_000),
        ("skin1", 1, 6_000_000),
        ("skin1", 2, 6_000_000),
        ("marble", 0, 2_000_000),
        ("marble", 1, 2_000_000),
        ("marble", 2, 2_000_000),
    )
    for ratio in RATIOS
) + tuple(
    Case(shape, "skin1", 0, ratio, 6_000_000)
    for shape in ("cylinder", "oblique cylinder", "ellipsoid")
    for ratio in (2, 5, 10, 20)
)
ALBEDOS, ETAS, COSINES = (0.5, 0.9, 0.99, 0.999), (1.0, 1.3, 1.5, 2.0), (0.1, 0.5, 1.0)
FLAT_PHOTONS = 400_000


def exitance(case: Case) -> tuple[FloatArray, FloatArray]:
    """Return the walk's means and standard errors of one case; shape (rows, columns)."""
    light, rows, columns = case.cells
    run = walk(case.body, light, case.optics, case.photons, rows, columns, SEED)
    return run.exitance, run.error


def flat(albedo: float, eta: float, cosine: float, photons: int) -> tuple[float, float]:
    """Return the walk's flat albedo, of the light that entered, and its standard error."""
    light = (np.sqrt(1.0 - cosine**2), 0.0, cosine)
    run = walk(half_space(), light, Optics(albedo, eta), photons, seed=SEED)
    entered = transmittance(cosine, eta)
    return run.shares[0] / entered, run.share_errors[0] / entered


def _short(values: FloatArray, error: FloatArray) -> dict[str, list[float]]:
    return {
        "exitance": [float(f"{value:.6g}") for value in values.ravel()],
        "error": [float(f"{value:.2g}") for value in error.ravel()],
    }


@lru_cache(maxsize=1)
def _stored() -> dict[Case, tuple[FloatArray, FloatArray]]:
    entries = json.loads((FOLDER / "walk.json").read_text(encoding="utf-8"))["cases"]
    return {
        Case(**entry["case"]): (np.array(entry["exitance"]), np.array(entry["error"]))
        for entry in entries
    }


def stored(case: Case) -> tuple[FloatArray, FloatArray]:
    """Return means and standard errors of one case from the file; shape (rows * columns,)."""
    return _stored()[case]


def stored_flat() -> list[tuple[float, float, float, float, float]]:
    """Return rows of albedo, index, cosine, flat albedo and its standard error from the file."""
    text = (FOLDER / "flat_albedo.json").read_text(encoding="utf-8")
    return [tuple(row) for row in json.loads(text)["rows"]]


def _write(name: str, head: dict[str, Any], key: str, rows: list[str]) -> None:
    opening = json.dumps(head)[:-1]
    body = ",\n".join(rows)
    (FOLDER / name).write_text(f'{opening}, "{key}": [\n{body}\n]}}\n', encoding="utf-8")


def make() -> None:
    """Make both files."""
    FOLDER.mkdir(exist_ok=True)
    entries = []
    for number, case in enumerate(CASES):
        print(f"{number + 1}/{len(CASES)} {case}", file=sys.stderr, flush=True)
        entries.append(json.dumps({"case": asdict(case), **_short(*exitance(case))}))
    _write("walk.json", {"seed": SEED}, "cases", entries)
    columns = ["albedo", "eta", "cosine", "flat albedo", "standard error"]
    rows = []
    for values in product(ALBEDOS, ETAS, COSINES):
        found = (round(value, 6) for value in flat(*values, FLAT_PHOTONS))
        rows.append(json.dumps([*values, *found]))
    head = {"seed": SEED, "photons": FLAT_PHOTONS, "columns": columns}
    _write("flat_albedo.json", head, "rows", rows)


if __name__ == "__main__":
    make()
