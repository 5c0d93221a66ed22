"""The shading models as contestants: each as it is, and with other values of its parameters."""

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import isclose, nan

import numpy as np

from app.chart.points import Missing
from app.chart.race import Contestant, reason_of
from app.pipeline import Pipeline
from app.session import Session
from lutcore import analytic
from lutcore.arrays import FloatArray, IndexArray
from lutcore.exitance import bared, exitance
from lutcore.lights import Light
from lutcore.parameters import Choice, Number, create, declared
from lutcore.progress import Progress, silent, tell
from lutcore.shading import ShadingInputs, ShadingModel, model_registry, shading_inputs

_WARM_UP = 400
_STEPS = 4
Way = tuple[str, dict[str, float | str], float]
"""A parameter, the values that are not at their default, and their place along a line."""


@dataclass(frozen=True, eq=False)
class Scene:
    """What models are charted on, prepared once for all.

    Parameters
    ----------
    gathering : ShadingInputs
        For models that are not local, and for the reference: the mesh and the light that reaches
        each vertex as they are.
    local : ShadingInputs
        For local models: with that light, and the surface, as light that spreads sees them.
    """

    gathering: ShadingInputs
    local: ShadingInputs

    def shaded(self, model: ShadingModel, progress: Progress) -> FloatArray:
        """Run a model.

        Parameters
        ----------
        model : ShadingModel
            Any.
        progress : callable
            Told where long work stands; see `lutcore.progress`.

        Returns
        -------
        ndarray, shape=(n, 3)
            See `lutcore.exitance.exitance`.
        """
        inputs = self.local if model.local else self.gathering
        return exitance(model, replace(inputs, progress=progress))


@dataclass(frozen=True, eq=False)
class Trial:
    """A scene, and where on it models are judged.

    Parameters
    ----------
    scene : Scene
        What is shaded.
    vertices : ndarray, shape=(m,)
        Where.
    truth : ndarray, shape=(m, 3)
        The reference there.
    """

    scene: Scene
    vertices: IndexArray
    truth: FloatArray


Shading = Contestant[Trial, FloatArray]


def scene_of(session: Session, pipeline: Pipeline, axes: FloatArray) -> Scene:
    """Return the scene of a session.

    Parameters
    ----------
    session : Session
        Everything but its model is used.
    pipeline : Pipeline
        Where arrays come from.
    axes : ndarray, shape=(3, 3)
        The camera's axes, for lights that move with it.

    Returns
    -------
    Scene
        With cast shadows where the session has them.
    """
    inputs = pipeline.shadowed(session, axes)
    return Scene(gathering=bared(inputs), local=inputs)


def warm_up(session: Session, pipeline: Pipeline, lights: Sequence[Light]) -> Trial:
    """Return a small mesh of the same substance under the same lights, for first calls.

    Parameters
    ----------
    session : Session
        Its material and profile are used.
    pipeline : Pipeline
        Where they come from.
    lights : sequence of DirectionalLight, PointLight or ConeLight
        The session's.

    Returns
    -------
    Trial
        Without a truth.
    """
    small = analytic.torus(_WARM_UP)
    made = shading_inputs(
        small.mesh,
        small.truth,
        pipeline.material(session),
        lights,
        profile=pipeline.profile(session),
    )
    return Trial(Scene(made, made), np.zeros(0, dtype=np.int32), np.zeros((0, 3)))


def contestants(
    names: Sequence[str], small: Trial, progress: Progress = silent
) -> tuple[list[Shading], list[Missing], dict[str, float]]:
    """Return who takes part, after a first call of each.

    A model takes part as it is, and with one parameter at a time at other values: each option of a
    choice, a few steps through the range of a number.

    Parameters
    ----------
    names : sequence of str
        Models.
    small : Trial
        A small scene for the first calls.
    progress : callable
        Told where the work stands; see `lutcore.progress`.

    Returns
    -------
    contestants : list of Contestant
        Who takes part.
    missing : list of Missing
        Those that refused already, with the reason.
    first : dict of str to float
        Seconds that the first call of each model took in this process, its tables included.

    Raises
    ------
    CancelledError
        If `progress` asked to stop.
    """
    taking: list[Shading] = []
    missing: list[Missing] = []
    first: dict[str, float] = {}
    for at, name in enumerate(names):
        tell(progress, at / len(names), f"{name}, first call")
        begin = time.perf_counter()
        try:
            small.scene.shaded(model_registry.get(name)(), silent)
            first[name] = time.perf_counter() - begin
            taking += [_contestant(name, way) for way in ways(model_registry.get(name))]
        except Exception as error:  # whatever another's plug-in may raise, the others go on
            missing.append(Missing(name, "", reason_of(error)))
    return taking, missing, first


def ways(plugin: type[ShadingModel]) -> Iterator[Way]:
    """Yield the settings of a model that are tried: its defaults, then the others.

    Parameters
    ----------
    plugin : type
        The model's class.

    Yields
    ------
    tuple
        The parameter that is set, the values that differ from the defaults, and the place of that
        value among the others; the defaults stand in the line of the first number.
    """
    specs = declared(plugin)
    usual = plugin()
    numbers = [name for name, spec in specs.items() if not isinstance(spec, Choice)]
    first = numbers[0] if numbers else ""
    yield first, {}, float(getattr(usual, first)) if first else 0.0
    for name, spec in specs.items():
        default = getattr(usual, name)
        if isinstance(spec, Choice):
            for other in spec.options:
                if other != default:
                    yield name, {name: other}, 0.0
        else:
            for value in _ladder(spec):
                if not isclose(value, default):
                    yield name, {name: value}, value


def _ladder(spec: Number) -> list[float]:
    """Return steps through a range: doubled or tenfold where it is wide, else even."""
    low, high = spec.low, spec.high
    wide = low > 0.0 and high / low >= 10.0
    if not wide:
        steps = [low + (high - low) * at / _STEPS for at in range(_STEPS + 1)]
        return list(dict.fromkeys(map(round, steps))) if spec.integer else steps
    factor = 2.0 if high / low <= 64.0 else 10.0
    count = int(np.floor(np.log(high / low) / np.log(factor) + 1e-9))
    steps = [low * factor**at for at in range(count + 1)]
    return list(map(round, steps)) if spec.integer else steps


def _contestant(name: str, way: Way) -> Shading:
    series, values, order = way
    setting = ", ".join(
        f"{key} {value:g}" if isinstance(value, int | float) else f"{key} {value}"
        for key, value in values.items()
    )
    model = create(model_registry.get(name), f"shading model {name!r}", values)
    # What another value costs is not known beforehand.
    return Shading(name, setting, series, partial(_run, model), nan, order)


def _run(model: ShadingModel, trial: Trial, progress: Progress) -> FloatArray:
    return trial.scene.shaded(model, progress)
