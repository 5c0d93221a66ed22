"""Colours and words that the picture and the page of a stability report share."""

from typing import Literal

import numpy as np

from app.stability_of_shading.report import Outcome
from lutcore.arrays import FloatArray
from lutcore.stability_of_shading.maps import (
    FALLING,
    NEGATIVE,
    OFF_BENT,
    OFF_FLAT,
    TOO_BRIGHT,
)

# Okabe and Ito's, which the colour-blind can tell apart; each with a line of its own.
OUTLINES: dict[str, tuple[str, Literal["solid", "dashed"]]] = {
    OFF_BENT: ("#0072b2", "solid"),
    OFF_FLAT: ("#009e73", "dashed"),
    TOO_BRIGHT: ("#d55e00", "solid"),
    FALLING: ("#cc79a7", "dashed"),
    NEGATIVE: ("#000000", "solid"),
}
"""Colour and line of each region."""

LEAST, MOST = 1e-3, 1.0
"""Errors where the scale of colours begins and ends."""


def shade(error: FloatArray) -> FloatArray:
    """Return how dark an error is drawn.

    Parameters
    ----------
    error : ndarray
        Relative errors.

    Returns
    -------
    ndarray
        0 to 1, the logarithm between `LEAST` and `MOST`.
    """
    clipped = np.clip(error, LEAST, MOST)
    return np.asarray(np.log(clipped / LEAST) / np.log(MOST / LEAST))


def summary(one: Outcome) -> str:
    """Return in one line where a model fails.

    Parameters
    ----------
    one : Outcome
        A model.

    Returns
    -------
    str
        Regions with their shares of the balls, and the checks that it did not pass.
    """
    words = [f"{region.name} {100.0 * region.mask.mean():.0f} %" for region in one.regions]
    words += [f"{check.name} {check.value:.3g}" for check in one.failed]
    return "; ".join(words) or "nowhere"
