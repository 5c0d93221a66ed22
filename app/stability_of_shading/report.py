"""Every local shading model on all balls, and through all checks."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lutcore.diffusion import diffusion_profile
from lutcore.progress import Progress, part, silent
from lutcore.shading import model_registry
from lutcore.stability_of_shading.checks import Check, checks
from lutcore.stability_of_shading.maps import (
    BETAS,
    CURVATURES,
    Field,
    Ground,
    Region,
    field,
    ground,
    regions,
)

TOLERANCE = 0.05
ETA = 1.3


@dataclass(frozen=True, eq=False)
class Outcome:
    """What became of one model.

    Parameters
    ----------
    name : str
        The model's.
    field : Field
        What it does on the balls.
    regions : list of Region
        Where it fails there.
    checks : list of Check
        What else was tried.
    """

    name: str
    field: Field
    regions: list[Region]
    checks: list[Check]

    @property
    def failing(self) -> float:
        """Share of the balls on which it fails in some way."""
        masks = [region.mask for region in self.regions]
        return float(np.mean(np.any(masks, axis=0))) if masks else 0.0

    @property
    def failed(self) -> list[Check]:
        """Checks that it did not pass."""
        return [check for check in self.checks if not check.passed and np.isfinite(check.limit)]


@dataclass(frozen=True, eq=False)
class Report:
    """All outcomes of a run.

    Parameters
    ----------
    profile : str
        How light spreads.
    tolerance : float
        Relative L2 error that is accepted.
    ground : Ground
        The balls.
    outcomes : tuple of Outcome
        One for each model; those that fail least come first.
    """

    profile: str
    tolerance: float
    ground: Ground
    outcomes: tuple[Outcome, ...]


def examine(
    names: Sequence[str],
    profile: str = "jensen2001",
    tolerance: float = TOLERANCE,
    eta: float = ETA,
    progress: Progress = silent,
) -> Report:
    """Try local shading models.

    Parameters
    ----------
    names : sequence of str
        Models.
    profile : str
        How light spreads.
    tolerance : float
        Relative L2 error over a ball that is accepted.
    eta : float
        Refractive index of the balls.
    progress : callable
        Told where the work stands; see `lutcore.progress`.

    Returns
    -------
    Report
        What was found.

    Raises
    ------
    ParameterError
        If a name is unknown.
    CancelledError
        If `progress` asked to stop.
    """
    chosen = diffusion_profile(profile)
    of = ground(eta, chosen, part(progress, 0.0, 0.1))
    outcomes = []
    for at, name in enumerate(names):
        model = model_registry.get(name)()
        low, high = (0.1 + 0.9 * step / len(names) for step in (at, at + 1))
        found = field(model, of, chosen, _named(part(progress, low, high), name))
        tried = checks(model, chosen)
        outcomes.append(Outcome(name, found, regions(of, found, tolerance), tried))
    outcomes.sort(key=lambda one: (one.failing, len(one.failed)))
    return Report(profile, tolerance, of, tuple(outcomes))


def _named(progress: Progress, name: str) -> Progress:
    return lambda share, step: progress(share, f"{name}: {step}")


def cells(report: Report) -> list[dict[str, object]]:
    """Return all cells of all maps as flat records.

    Parameters
    ----------
    report : Report
        A run.

    Returns
    -------
    list of dict
        Model, beta, k l_u, error, energy, fall, least exitance, and the names of the regions that
        the ball is in.
    """
    rows: list[dict[str, object]] = []
    for one in report.outcomes:
        for row, beta in enumerate(BETAS):
            for column, k in enumerate(CURVATURES):
                at = row, column
                rows.append(
                    {
                        "model": one.name,
                        "beta": _short(beta),
                        "k_l_u": _short(k),
                        "error": _short(one.field.error[at]),
                        "energy": _short(one.field.energy[at]),
                        "fall": _short(one.field.fall[at]),
                        "least": _short(one.field.least[at]),
                        "regions": "; ".join(r.name for r in one.regions if r.mask[at]),
                    }
                )
    return rows


def _short(value: float) -> float:
    """Six digits are more than a judgement has."""
    return float(f"{value:.6g}")
