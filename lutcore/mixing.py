"""Which cheaper model to blend in, and up to which error."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.blend import Blend, blending
from lutcore.costs import COLORS, PREDICTION
from lutcore.exitance import exitance
from lutcore.judging import Judge, Rung
from lutcore.table_size import with_samples
from lutcore.tolerance import color_distances

# A blend must save this share of the cost to be worth two models.
_WORTH = 0.1
# Limits that are tried for a mean, over it: predicted errors may be 4 times what they bound, and
# errors at some vertices beyond their mean.
_ROOM = 2.0 ** (0.5 * np.arange(13))


class Mixed(NamedTuple):
    """A blend, if one pays.

    Parameters
    ----------
    blend : Blend or None
        The blend.
    cheaper : Rung or None
        The model that it takes where that suffices.
    share : float
        Share of the vertices where it is taken, alone or in part.
    milliseconds : float
        What is spent; on the better model alone where there is no blend.
    """

    blend: Blend | None
    cheaper: Rung | None
    share: float
    milliseconds: float


def mixed(judge: Judge, chosen: Rung, known: list[Rung]) -> Mixed:
    """Return the blend that saves most and suffices.

    Parameters
    ----------
    judge : Judge
        Of the scene.
    chosen : Rung
        The better model.
    known : list of Rung
        Among them the cheaper one.

    Returns
    -------
    Mixed
        With the cheaper model, or without one.
    """
    whole = chosen.milliseconds
    if not (chosen.candidate.model.local and chosen.adequate) or not judge.lights:
        return Mixed(None, None, 0.0, whole)
    enough, found = (1.0 - _WORTH) * whole, []
    for rung in known:
        least = _least(judge, rung)  # where the better one is needed nowhere
        if not rung.candidate.model.local or rung.milliseconds >= whole or least >= enough:
            continue
        blend, weights = _blend(judge, rung, chosen)
        spent = least + float(np.mean(weights > 0.0)) * whole
        if blend.exposure is None:  # its colour tells nothing, where it is not seen
            spent -= float(np.mean(weights == 1.0)) * rung.milliseconds
        if spent < enough:
            found.append(Mixed(blend, rung, float(np.mean(weights < 1.0)), spent))
    for one in sorted(found, key=lambda one: one.milliseconds):
        assert one.blend is not None
        if judge.suffices(one.blend):
            return one
    return Mixed(None, None, 0.0, whole)


def _least(judge: Judge, rung: Rung) -> float:
    """Return what a blend costs that takes the cheaper model everywhere, ms."""
    each = judge.costs[PREDICTION].per_vertex(judge.count, judge.lights)
    if judge.tolerance.metric != "relative":
        each += judge.costs[COLORS].per_vertex(judge.count, 1)
    return 1e-6 * each * judge.count + rung.milliseconds


def _blend(judge: Judge, rung: Rung, chosen: Rung) -> tuple[Blend, FloatArray]:
    """Return a blend, and the weights of the better model at the sample."""
    cheap, good = (with_samples(one.candidate.model, judge.samples) for one in (rung, chosen))
    metric, value = judge.tolerance.metric, judge.tolerance.value
    if metric == "relative":
        blend = Blend(cheap, good, value)
        return blend, blend.weights(judge.scene)
    blend = Blend(cheap, good, value, judge.exposure)
    given = exitance(cheap, judge.some)
    errors = blend.errors(judge.scene, given)
    if metric == "mean-de2000":
        apart = color_distances(given, exitance(good, judge.some), judge.exposure)
        spared = value - (chosen.score if chosen.checked is None else chosen.checked.high)
        blend = replace(blend, limit=_limit(errors, apart, spared, value))
    return blend, blending(errors, blend.limit)


def _limit(errors: FloatArray, apart: FloatArray, spared: float, mean: float) -> float:
    """Return the error up to which a model may be taken so that a mean is met.

    A mean within the tolerance lets some vertices err by more, as others err by less. What the
    better model spares of it the cheaper one may use: as the blend is off by at most the error of
    the better one and what is blended in of the distance between the two, the largest limit is
    taken by which that distance has a mean that is spared. Where none has, the mean itself.

    Parameters
    ----------
    errors, apart : ndarray, shape=(n,)
        Predicted errors of the cheaper model, and how far it is from the better one.
    spared, mean : float
        What the better model leaves of the mean, and the mean.

    Returns
    -------
    float
        At least the mean.
    """
    fit = (
        limit
        for limit in mean * _ROOM[::-1]
        if np.mean((1.0 - blending(errors, limit)) * apart) <= spared
    )
    return float(next(fit, mean))
