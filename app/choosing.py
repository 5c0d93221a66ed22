"""What a session needs to be shaded well enough: model, table, shadows, scale of curvature."""

from dataclasses import dataclass

import numpy as np

from app.costs import measured
from app.pipeline import Pipeline
from app.session import Session
from lutcore.arrays import FloatArray
from lutcore.choice import Choice, choose
from lutcore.shading import ShadingInputs
from lutcore.tolerance import Tolerance
from lutcore.visibility import ShadowForecast, forecast

_TABLES = (8, 16, 32, 64, 128)
_FINE = 256
# Of the tolerance: the table must not matter beside the model.
_TABLE_SHARE = 0.1


@dataclass(frozen=True)
class Needs:
    """What a scene needs.

    Parameters
    ----------
    choice : Choice
        The model, with the ladder.
    samples : int
        Samples of psi that keep a table's error below a tenth of the tolerance; `relative` is
        taken as .01 where the tolerance is one of colour.
    shadows : ShadowForecast or None
        What cast shadows would change; None without lights.
    scale : float or None
        Length that curvature is averaged over, mesh units; None where the estimator chooses.
    glow : float
        How far light carries the edge of a shadow, mesh units: no finer scale is needed.
    tight : dict of str to float
        Share of the vertices with a radius of curvature below 10 and 5 diffusion lengths of the
        channel that is worst.
    """

    choice: Choice
    samples: int
    shadows: ShadowForecast | None
    scale: float | None
    glow: float
    tight: dict[str, float]


def needs(
    session: Session,
    pipeline: Pipeline,
    axes: FloatArray,
    tolerance: Tolerance,
    again: bool = False,
) -> Needs:
    """Find out what a session needs.

    Parameters
    ----------
    session : Session
        All but its model is used.
    pipeline : Pipeline
        Where arrays come from.
    axes : ndarray, shape=(3, 3)
        The camera's axes, for lights that move with it.
    tolerance : Tolerance
        How wrong the picture may be.
    again : bool
        Whether to measure the costs of the models again.

    Returns
    -------
    Needs
        The answer.

    Raises
    ------
    MeshError, ParameterError
        As the pipeline.
    CancelledError
        If its progress asked to stop.
    """
    costs = measured(pipeline.progress, again)
    inputs = pipeline.inputs(session, axes)
    choice = choose(inputs, tolerance, costs)
    mesh = pipeline.subject(session).mesh
    shadows = None
    if len(inputs.lights):
        shadows = forecast(mesh, inputs.normals, inputs.lights)
    return Needs(
        choice=choice,
        samples=samples(inputs, tolerance),
        shadows=shadows,
        scale=pipeline.scale(session),
        glow=pipeline.glow(session),
        tight=tight(inputs),
    )


def samples(inputs: ShadingInputs, tolerance: Tolerance) -> int:
    """Return how many samples of psi a scene needs.

    Parameters
    ----------
    inputs : ShadingInputs
        The scene.
    tolerance : Tolerance
        How wrong it may be.

    Returns
    -------
    int
        The least of 8, 16, 32, 64 and 128 whose table is off by less than a tenth of it.
    """
    from lutcore.baking import bake

    allowed = _TABLE_SHARE * (tolerance.value if tolerance.metric == "relative" else 0.01)
    bends = np.sqrt(np.square(inputs.shape[:, :3]).sum(axis=1))
    kappa = max(float(np.percentile(bends, 99.0)) if len(bends) else 0.0, 1e-9)
    a = np.linspace(-1.0, 1.0, 2001)
    fine = bake(inputs.material, _FINE, inputs.profile)
    for count in _TABLES[:-1]:
        coarse = bake(inputs.material, count, inputs.profile)
        off = np.abs(coarse.evaluate(a, kappa) - fine.evaluate(a, kappa)) / fine.total
        if off.max() < allowed:
            return count
    return _TABLES[-1]


def tight(inputs: ShadingInputs) -> dict[str, float]:
    """Return where curvature is strong beside the diffusion length.

    Parameters
    ----------
    inputs : ShadingInputs
        The scene.

    Returns
    -------
    dict of str to float
        ``below_10_l_d`` and ``below_5_l_d``: shares of the vertices.
    """
    from lutcore.baking import BETA_FLOOR

    table = inputs.table
    longest = float((table.mean_free_path / np.maximum(inputs.material.beta, BETA_FLOOR)).max())
    assert inputs.curvatures is not None
    largest = np.maximum(np.abs(inputs.curvatures.k1), np.abs(inputs.curvatures.k2))
    ratio = longest * largest / inputs.mm_per_unit
    return {f"below_{limit}_l_d": float(np.mean(ratio > 1.0 / limit)) for limit in (10, 5)}
