"""Where the weights of `lutcore.prediction` come from: python -m tests.bench.prediction --tune 80.

The weights of regression to the 95th percentile of all models' errors together, from which a seeded
random search goes on, for errors that are covered and not wide in every four scenes of a kind: a
quantile over all would trade one kind for another. Kinds are random ellipsoids, tori and cylinders,
noisy tori at one scale and by channel, and both marble scans; in the materials, sizes and lights
that the table draws, from other seeds.
"""

import sys
from collections.abc import Sequence

import numpy as np

from lutcore.prediction import WEIGHTS, Knowledge, Scene
from tests.bench.prediction import (
    COVERED,
    SEEN,
    Case,
    FloatArray,
    any_shape,
    case,
    noisy,
    predictable,
    scanned,
    true_and_predicted,
)

# Wanted of every four scenes: a little more than of the table, whose draws are others.
_COVERED, _WIDE = 0.962, 4.5
_FOUR = 4
# What a share that is not covered costs, against a logarithm that is too wide, and against what is
# wide at all.
_PRICE, _KEEN = 25.0, 0.01
_ROWS, _STEPS = 1500, 1500
_KINDS = ("smooth", "smooth", "one scale", "smooth", "by channel", "smooth", "raw", "face")


class Apart(Scene):
    """A scene whose error is each term alone, the flat one first."""

    def error_of(self, model: Knowledge) -> FloatArray:
        flat = self.bound(model, np.zeros(len(WEIGHTS)))
        rows = np.diag(model.shares)
        return np.stack([flat, *(self.bound(model, row) - flat for row in rows)], axis=-1)


class Kind:
    """The terms and true errors of one model in the scenes of one kind.

    Parameters
    ----------
    terms : list of ndarray, each shape=(n, 1 + len(WEIGHTS))
        Of every scene.
    true : list of ndarray, each shape=(n,)
        Of every scene.
    """

    def __init__(self, terms: list[FloatArray], true: list[FloatArray]) -> None:
        self.terms, self.true = np.concatenate(terms), np.concatenate(true)
        ends = np.cumsum([0, *(len(one) for one in true)])
        starts = range(0, len(true) - _FOUR + 1, _FOUR)
        self.groups = [slice(ends[i], ends[i + _FOUR]) for i in starts]

    def cost(self, weights: FloatArray) -> float:
        """Return how far this is from what is wanted."""
        found = self.terms[:, 0] + self.terms[:, 1:] @ weights
        covered, seen = self.true <= found, np.maximum(self.true, found) > SEEN
        ratio, total = np.log(found / np.maximum(self.true, 1e-12)), 0.0
        for group in (*self.groups, slice(None)):
            wide = float(np.median(ratio[group][seen[group]])) if seen[group].any() else 0.0
            total += _PRICE * max(0.0, _COVERED - float(covered[group].mean()))
            total += max(0.0, wide - np.log(_WIDE)) + _KEEN * max(0.0, wide)
        return total / (1 + len(self.groups))


def scene_of(kind: str, generator: np.random.Generator, points: int, count: int) -> Case:
    """Return a random scene with its truth."""
    if kind == "smooth":
        return case(any_shape(generator, count), generator, points)
    if kind in ("raw", "face"):
        return scanned(f"marble-face{'-raw' * (kind == 'raw')}", generator, points)
    return noisy(generator, points, count, kind == "by channel")


def kinds(seed: int, total: int, points: int, count: int) -> list[Kind]:
    """Return all kinds of scene under all models."""
    cases: dict[str, list[Case]] = {kind: [] for kind in _KINDS}
    for number in range(total):
        kind = _KINDS[number % len(_KINDS)]
        cases[kind].append(
            scene_of(kind, np.random.default_rng((seed, 777, number)), points, count)
        )
        print(f"scene {number}: {kind}", file=sys.stderr)
    found = []
    for one in predictable():
        for some in cases.values():
            terms, true = [], []
            for of in some:
                apart = one.model.predicted_error(Apart(**vars(of.scene)))
                assert apart is not None
                terms.append(apart.reshape(-1, len(WEIGHTS) + 1))
                true.append(true_and_predicted(one, of)[0].ravel())
            if sum(len(one) for one in true):
                found.append(Kind(terms, true))
    return found


def regression(every: Sequence[Kind], generator: np.random.Generator) -> FloatArray:
    """Return the weights that bound 95 % of the errors of all models most closely."""
    from scipy.optimize import linprog
    from scipy.sparse import csr_matrix, hstack, identity

    terms = np.concatenate([one.terms for one in every])
    true = np.concatenate([one.true for one in every])
    some = generator.choice(np.flatnonzero(true > SEEN), _ROWS, replace=False)
    given = np.array(list(WEIGHTS.values()))
    scale = terms[some, 0] + terms[some, 1:] @ given
    # The dual form of quantile regression: the slack above costs .95, that below .05.
    unit = identity(_ROWS)
    equal = hstack([csr_matrix(terms[some, 1:] / scale[:, None]), unit, -unit]).tocsr()
    price = np.repeat([0.0, COVERED, 1.0 - COVERED], [len(given), _ROWS, _ROWS])
    wanted = (true[some] - terms[some, 0]) / scale
    bounds = [(1e-5, None)] * len(given) + [(0.0, None)] * (2 * _ROWS)
    found = linprog(price, A_eq=equal, b_eq=wanted, bounds=bounds, method="highs").x
    return np.asarray(found[: len(given)])


def search(every: Sequence[Kind], start: FloatArray, generator: np.random.Generator) -> FloatArray:
    """Return weights that cost less than those given."""
    best, step = start, np.full(len(start), 0.35)
    least = sum(one.cost(best) for one in every)
    fixed = list(WEIGHTS).index("least")
    free = np.flatnonzero(np.arange(len(start)) != fixed)
    for number in range(_STEPS):
        changed = generator.choice(free, generator.integers(1, 4), replace=False)
        trial = best.copy()
        trial[changed] *= np.exp(step[changed] * generator.standard_normal(len(changed)))
        cost = sum(one.cost(trial) for one in every)
        step[changed] *= 1.3 if cost < least else 0.95
        step[:] = np.clip(step, 0.03, 0.8)
        if cost < least:
            best, least = trial, cost
        if number % 100 == 0:
            print(f"step {number}: {least / len(every):.5f}", file=sys.stderr)
    return best


def tune(seed: int, total: int, points: int, count: int) -> None:
    """Print the weights of regression, and those that the search finds from there."""
    every, generator = kinds(seed, total, points, count), np.random.default_rng(seed)
    start = regression(every, generator)
    start[list(WEIGHTS).index("least")] = WEIGHTS["least"]
    for label, weights in (("regression", start), ("search", search(every, start, generator))):
        cost = sum(one.cost(weights) for one in every) / len(every)
        print(f"{label}, cost {cost:.5f}")
        for name, weight in zip(WEIGHTS, weights, strict=True):
            print(f'    "{name}": {weight:.3g},')
