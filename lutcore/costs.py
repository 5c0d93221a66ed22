"""What a shading model costs on this machine: measured once, by name and settings."""

import time
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import NamedTuple

import numpy as np

from lutcore.color_bound import color_bound
from lutcore.errors import ParameterError
from lutcore.exitance import exitance
from lutcore.parameters import Parameters
from lutcore.prediction import Knowledge, Scene
from lutcore.progress import Progress, silent, tell
from lutcore.shading import (
    ShadingInputs,
    ShadingModel,
    model_registry,
    shading_inputs,
    shading_models,
)

# Vertices by growth: each run takes some milliseconds.
_VERTICES = {"n": 16_384, "n log n": 8_192, "n^2": 2_048}
_RUNS, _FEW = 5, 2
# Such facets as a scan has: .5 mm, below the mean free path.
_MAJOR, _MINOR = 12.0, 5.0
_LIGHTS = ((1.0, 0.3, 0.5), (-0.5, 0.2, 0.7))


PREDICTION = "prediction"
"""The label of what predicting a model's error costs."""
COLORS = "colours"
"""The label of what it costs to say how different such errors look, for each vertex."""


class Candidate(NamedTuple):
    """A model with its settings.

    Parameters
    ----------
    name : str
        One of `shading_models`.
    model : ShadingModel
        The model.
    """

    name: str
    model: ShadingModel

    @property
    def label(self) -> str:
        """The name, with the parameters that are not at their default."""
        values = ", ".join(f"{key} {value}" for key, value in self.parameters.items())
        return f"{self.name} ({values})" if values else self.name

    @property
    def parameters(self) -> dict[str, float | str]:
        """The parameters that are not at their default."""
        return changed(self.model)


class Cost(NamedTuple):
    """Time of a model, once its tables are baked.

    Parameters
    ----------
    nanoseconds : float
        For each unit of work.
    growth : str
        The unit: ``n``, a vertex and light; ``n log n`` and ``n^2``, that of n vertices, base 2,
        however many lights.
    """

    nanoseconds: float
    growth: str

    def per_vertex(self, vertices: int, lights: int) -> float:
        """Return the time for each vertex of a mesh, ns.

        Parameters
        ----------
        vertices : int
            Of the mesh.
        lights : int
            Of the scene.

        Returns
        -------
        float
            Nanoseconds, all lights together.
        """
        work = {"n": lights, "n log n": np.log2(max(vertices, 2)), "n^2": vertices}
        return float(self.nanoseconds * work[self.growth])


def changed(plugin: Parameters) -> dict[str, float | str]:
    """Return the parameters of a plug-in that are not at their default.

    Parameters
    ----------
    plugin : Parameters
        Any.

    Returns
    -------
    dict
        Values by name.
    """
    fields = type(plugin).__dataclass_fields__
    values = {name: getattr(plugin, name) for name in fields}
    return {name: value for name, value in values.items() if value != fields[name].default}


def candidates() -> list[Candidate]:
    """Return all models that can be run, with the settings worth choosing among.

    Returns
    -------
    list of Candidate
        In the order of `shading_models`; a plug-in that cannot be imported is left out.
    """
    found = []
    for name in shading_models():
        try:
            plugin = model_registry.get(name)
        except ParameterError:
            continue
        found += [Candidate(name, model) for model in plugin.rungs()]
    return found


def measure(models: Iterable[Candidate], progress: Progress = silent) -> dict[str, Cost]:
    """Measure what models cost on this machine, with as many threads as shading uses.

    Parameters
    ----------
    models : iterable of Candidate
        The models.
    progress : callable
        Told where the work stands.

    Returns
    -------
    dict of str to Cost
        By label; the best of several runs on a torus of skin1 under two lights.

    Raises
    ------
    CancelledError
        If the progress asked to stop.
    """
    from lutcore.analytic import torus
    from lutcore.lights import DirectionalLight

    lights = [DirectionalLight(direction) for direction in _LIGHTS]
    inputs = {}
    for growth, size in _VERTICES.items():
        body = torus(size, major=_MAJOR, minor=_MINOR)
        inputs[growth] = shading_inputs(body.mesh, body.truth, "skin1", lights)
    chosen, of = list(models), inputs["n"]
    tell(progress, 0.0, "measuring the prediction")
    seconds = _best(partial(_predict, of), _RUNS)
    found = {PREDICTION: Cost(1e9 * seconds / (len(of.points) * len(lights)), "n")}
    seconds = _best(partial(_compare, of), _RUNS)
    found[COLORS] = Cost(1e9 * seconds / len(of.points), "n")
    for done, one in enumerate(chosen):
        tell(progress, (done + 1) / (len(chosen) + 1), f"measuring {one.label}")
        of = inputs[one.model.growth]
        unit = Cost(1.0, one.model.growth).per_vertex(len(of.points), len(lights))
        runs = _RUNS if one.model.local else _FEW
        seconds = _best(partial(exitance, one.model, of), runs)
        found[one.label] = Cost(1e9 * seconds / (len(of.points) * unit), one.model.growth)
    return found


def _predict(inputs: ShadingInputs) -> None:
    assert inputs.curvatures is not None
    scene = Scene.of(inputs, inputs.curvatures)
    scene.error_of(Knowledge(scene.entering, bend="none"))


def _compare(inputs: ShadingInputs) -> None:
    some = inputs.points - inputs.points.min()  # any numbers do: no way through is shorter
    color_bound(some, 0.01 * some, inputs.table.total, 1.0 / float(some.max()))


def _best(call: Callable[[], object], runs: int) -> float:
    call()
    seconds = []
    for _ in range(runs):
        start = time.perf_counter()
        call()
        seconds.append(time.perf_counter() - start)
    return min(seconds)


_KNOWN: dict[str, Cost] = {}


def remember(found: Mapping[str, Cost]) -> None:
    """Take costs as known, so that they are not measured in this process.

    Parameters
    ----------
    found : mapping of str to Cost
        By label.
    """
    _KNOWN.update(found)


def forget() -> None:
    """Take no costs as known, so that all are measured again."""
    _KNOWN.clear()


def costs(progress: Progress = silent) -> dict[str, Cost]:
    """Return the costs of all candidates, and measure those that are not known.

    Parameters
    ----------
    progress : callable
        Told where the work stands.

    Returns
    -------
    dict of str to Cost
        By label.

    Raises
    ------
    CancelledError
        If the progress asked to stop.
    """
    missing = [one for one in candidates() if one.label not in _KNOWN]
    if missing or not _KNOWN.keys() >= {PREDICTION, COLORS}:
        remember(measure(missing, progress))
    return dict(_KNOWN)
