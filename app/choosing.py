"""What a session needs to be shaded well enough: model, table, shadows, scale of curvature."""

from dataclasses import dataclass

import numpy as np

from app.costs import measured
from app.lighting import world_lights
from app.pipeline import Pipeline
from app.session import Session
from lutcore.arrays import FloatArray
from lutcore.choice import Choice, choose
from lutcore.shading import ShadingInputs
from lutcore.tolerance import Tolerance
from lutcore.visibility import ShadowForecast


@dataclass(frozen=True)
class Needs:
    """What a scene needs.

    Parameters
    ----------
    choice : Choice
        The model, with the ladder and the size of its table.
    shadows : ShadowForecast or None
        What cast shadows would change, by which `auto` casts them: the same for all models and
        tolerances, so that what is compared has the same; None without lights. What leaving them
        out does to the model is in `choice`.
    scale : float or None
        Length that curvature is averaged over, mesh units; None where the estimator chooses.
    glow : float
        How far light carries the edge of a shadow, mesh units: no finer scale is needed.
    tight : dict of str to float
        Share of the vertices with a radius of curvature below 10 and 5 diffusion lengths of the
        channel that is worst.
    """

    choice: Choice
    shadows: ShadowForecast | None
    scale: float | None
    glow: float
    tight: dict[str, float]

    @property
    def lacks_shadows(self) -> bool:
        """Whether cast shadows change much, and the session has none."""
        return self.shadows is not None and self.shadows.needed and not self.choice.shadowed


def needs(
    session: Session,
    pipeline: Pipeline,
    axes: FloatArray,
    tolerance: Tolerance,
    again: bool = False,
    checked: bool = True,
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
    checked : bool
        Whether to check what is predicted at a sample of the vertices.

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
    inputs = pipeline.shadowed(session, axes)
    choice = choose(inputs, tolerance, costs, checked=checked)
    lights = world_lights(session, axes)
    shadows = pipeline.forecast(session, lights) if lights else None
    return Needs(
        choice=choice,
        shadows=shadows,
        scale=pipeline.scale(session),
        glow=pipeline.glow(session),
        tight=tight(inputs),
    )


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
