"""How large a table of psi a scene needs."""

from dataclasses import fields, replace
from typing import Any

import numpy as np

from lutcore.shading import ShadingInputs, ShadingModel
from lutcore.tolerance import Tolerance

SIZES = (8, 16, 32, 64, 128)
"""Samples of psi that are tried."""
_FINE = 256
# Of the tolerance: the table must not matter beside the model.
_SHARE = 0.1


def samples_needed(inputs: ShadingInputs, tolerance: Tolerance) -> int:
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
        The least of `SIZES` whose table is off by less than a tenth of it.
    """
    allowed = _SHARE * tolerance.light
    bends = np.sqrt(np.square(inputs.shape[:, :3]).sum(axis=1))
    kappa = max(float(np.percentile(bends, 99.0)) if len(bends) else 0.0, 1e-9)
    a = np.linspace(-1.0, 1.0, 2001)
    fine = inputs.baked(_FINE)
    for count in SIZES[:-1]:
        coarse = inputs.baked(count)
        off = np.abs(coarse.evaluate(a, kappa) - fine.evaluate(a, kappa)) / fine.total
        if off.max() < allowed:
            return count
    return SIZES[-1]


def with_samples(model: ShadingModel, samples: int) -> ShadingModel:
    """Return a model with a table of another size, if it has one.

    Parameters
    ----------
    model : ShadingModel
        Any.
    samples : int
        Of psi.

    Returns
    -------
    ShadingModel
        The model itself where it looks nothing up in the table of psi.
    """
    tabulated = any(field.name == "samples" for field in fields(model))
    changes: dict[str, Any] = {"samples": samples} if tabulated else {}
    return replace(model, **changes)
