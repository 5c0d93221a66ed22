"""The curvature estimators as contestants: each at its own choice, at lengths, and in its ways."""

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product

import numpy as np

from app.chart.points import Missing
from app.chart.race import Contestant, reason_of
from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import estimator_registry, principal_curvatures
from lutcore.geometry import typical_spacing
from lutcore.mesh import TriangleMesh
from lutcore.parameters import Choice, declared
from lutcore.progress import Progress, silent, tell
from lutcore.weld import weld

SPACINGS = (2.0, 3.0, 4.0, 6.0, 8.0)
"""Lengths to average over, in spacings of the mesh, where none are asked for."""

# A whole-numbered parameter with more values than this is a length in disguise: rings.
_FEW = 4
# In spacings; small enough for any mesh.
_PROBE = 2.0
Values = dict[str, str | int]


@dataclass(frozen=True, eq=False)
class Subject:
    """A mesh to measure, and what is known of it.

    Parameters
    ----------
    mesh : TriangleMesh
        The mesh.
    spacing : float
        Square root of its median vertex area, mesh units.
    truth : PrincipalCurvatures or None
        Exact curvatures, where they are known.
    """

    mesh: TriangleMesh
    spacing: float
    truth: PrincipalCurvatures | None = None


Estimating = Contestant[Subject, PrincipalCurvatures]


def spacing_of(mesh: TriangleMesh) -> float:
    """Return the spacing of a mesh, coincident vertices counted as one.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.

    Returns
    -------
    float
        Square root of the median vertex area, mesh units; 0 if no face has an area.
    """
    joined = weld(mesh).mesh
    return 0.0 if joined is None else typical_spacing(joined)


def contestants(
    names: Sequence[str], spacings: Sequence[float], warm_up: Subject, progress: Progress = silent
) -> tuple[list[Estimating], list[Missing], dict[str, float]]:
    """Return who takes part, after a first call of each.

    An estimator takes part at the length it chooses itself, at each length asked for if it heeds
    any, and with each value of its parameters that have a few values only.

    Parameters
    ----------
    names : sequence of str
        Estimators.
    spacings : sequence of float
        Lengths in spacings of the mesh.
    warm_up : Subject
        A small mesh for the first calls.
    progress : callable
        Told where the work stands; see `lutcore.progress`.

    Returns
    -------
    contestants : list of Contestant
        Who takes part.
    missing : list of Missing
        Those that refused already, with the reason.
    first : dict of str to float
        Seconds that the first call of each estimator took in this process, compiling, importing
        and starting included.

    Raises
    ------
    CancelledError
        If `progress` asked to stop.
    """
    taking: list[Estimating] = []
    missing: list[Missing] = []
    first: dict[str, float] = {}
    for at, name in enumerate(names):
        tell(progress, at / len(names), f"{name}, first call")
        begin = time.perf_counter()
        try:
            principal_curvatures(warm_up.mesh, name)
            first[name] = time.perf_counter() - begin
            # A method of the one-ring tells a scale of 0 whatever it is asked for.
            asked = principal_curvatures(warm_up.mesh, name, _PROBE * warm_up.spacing)
            heeded = sorted(spacings) if np.any(asked.scale) else []
            for values in _ways(name):
                taking += [_contestant(name, values, times) for times in (None, *heeded)]
        except Exception as error:  # whatever another's plug-in may raise, the others go on
            missing.append(Missing(name, "", reason_of(error)))
    return taking, missing, first


def _ways(name: str) -> Iterator[Values]:
    """Yield the parameter values to try: none for the defaults, then those that differ."""
    plugin = estimator_registry.get(name)
    options: dict[str, list[str | int]] = {}
    for parameter, spec in declared(plugin).items():
        if isinstance(spec, Choice):
            options[parameter] = list(spec.options)
        elif spec.integer and spec.high - spec.low < _FEW:
            options[parameter] = list(range(int(spec.low), int(spec.high) + 1))
    defaults = {key: plugin.__dataclass_fields__[key].default for key in options}
    yield {}
    for combined in product(*options.values()):
        values = dict(zip(options, combined, strict=True))
        if values != defaults:
            yield values


def _contestant(name: str, values: Values, times: float | None) -> Estimating:
    series = ", ".join(f"{key} {value}" for key, value in values.items())
    length = "" if times is None else f"{times:g} h"
    setting = ", ".join(part for part in (series, length) if part)
    # What it chooses itself may be more work or less than any length.
    effort = float("nan") if times is None else times
    return Contestant(name, setting, series, partial(_estimate, name, values, times), effort)


def _estimate(
    name: str, values: Values, times: float | None, subject: Subject, progress: Progress
) -> PrincipalCurvatures:
    scale = None if times is None else times * subject.spacing
    return principal_curvatures(subject.mesh, name, scale, progress=progress, **values)
