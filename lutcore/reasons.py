"""Why a model was chosen, in a sentence."""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from lutcore.choice import Choice
    from lutcore.judging import Rung

_MEASURES = {
    "relative": "99 % of vertices within {value} R_d",
    "mean-de2000": "mean CIEDE2000 within {value}",
    "p99-de2000": "99 % of vertices within a CIEDE2000 of {value}",
}


def reason(choice: "Choice") -> str:
    """Say why a model was chosen.

    Parameters
    ----------
    choice : Choice
        Its ladder climbed to the end.

    Returns
    -------
    str
        A sentence without its full stop.
    """
    said = _chosen(choice)
    if not choice.overruled:
        return said
    label = choice.by_prediction.candidate.label
    if choice.by_prediction.predicted:
        return f"{said}; the check overruled the prediction, which would have taken {label}"
    return f"{said}; the check overruled the prediction, by which nothing suffices"


def _chosen(choice: "Choice") -> str:
    chosen, tolerance = choice.chosen, choice.tolerance
    label = chosen.candidate.label
    measure = _MEASURES[tolerance.metric].format(value=f"{tolerance.value:g}")
    known = [rung for rung in choice.rungs if not np.isnan(rung.score)]
    local = [rung for rung in known if rung.candidate.model.local]
    if choice.blend is not None and choice.cheaper is not None:
        saved = choice.milliseconds / chosen.milliseconds
        return (
            f"{choice.cheaper.candidate.label} is predicted to suffice on "
            f"{_percent(choice.cheaper_share)} of the vertices ({measure}), {label} is blended in "
            f"on the rest, for {saved:.2g} times the cost of {label} alone"
        )
    if chosen.adequate and (chosen.candidate.model.local or any(one.adequate for one in local)):
        cheaper = [rung for rung in local if rung.milliseconds < chosen.milliseconds]
        words = f"{label} is the cheapest that suffices ({measure}: {_scored(chosen)})"
        if not cheaper:
            return words + "; nothing is cheaper"
        best = max(cheaper, key=lambda rung: rung.best_share)
        return (
            f"{words}; {best.candidate.label} suffices on {_percent(best.best_share)} of the "
            "vertices, and no cheaper one on more"
        )
    if not local:
        return f"{label} is all there is to choose"
    best = max(local, key=lambda rung: rung.best_share)
    no_local = (
        f"no local model suffices ({measure}): the widest, {best.candidate.label}, does on "
        f"{_percent(best.best_share)} of the vertices"
    )
    if chosen.adequate:
        return (
            f"{no_local}; {label} suffices, gathering the light of the whole mesh{_larger(choice)}"
        )
    return (
        f"nothing suffices, {label} comes closest ({_scored(chosen)}); {no_local}{_larger(choice)}"
    )


def _larger(choice: "Choice") -> str:
    if choice.enough is not None:
        times = f"{choice.enough:.2g} times"
        return f"; by prediction a body {times} as large would do with a local one"
    foreseen = choice.by_prediction
    if foreseen.predicted and foreseen.candidate.model.local:
        return ""
    return "; by prediction no larger body would do with a local one"


def _scored(rung: "Rung") -> str:
    if rung.checked is None:
        return f"{rung.score:.2g} predicted"
    return f"{rung.checked.score:.2g} found, {rung.score:.2g} predicted"


def _percent(share: float) -> str:
    # No share is rounded to all or nothing.
    percent = 100.0 * share
    digits = 0 if 0.95 <= percent <= 99.0 or percent in (0.0, 100.0) else 1
    return f"{percent:.{digits}f} %"
