"""Colour maps for scalars: the paper's green to red, and every one that matplotlib has."""

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.errors import ParameterError

ENTRIES = 256
# Kolchin 2007, Figure 1: green is small curvature, red is big. Yellow lies between, and lightness
# falls towards red, so that the order survives a grey print.
_GREEN_RED = np.array(
    [
        (0.00, 0.05, 0.42, 0.16),
        (0.25, 0.36, 0.70, 0.20),
        (0.50, 0.95, 0.88, 0.25),
        (0.75, 0.93, 0.50, 0.13),
        (1.00, 0.76, 0.06, 0.08),
    ]
)
PAPER = "green-red"


def table(name: str) -> FloatArray:
    """Return the colours of a map from its low end to its high end.

    Parameters
    ----------
    name : str
        ``green-red``, or any name that matplotlib knows.

    Returns
    -------
    ndarray, shape=(ENTRIES, 3)
        sRGB-encoded colours, 0 to 1.

    Raises
    ------
    ParameterError
        If there is no such map.
    """
    position = np.linspace(0.0, 1.0, ENTRIES)
    if name == PAPER:
        stops = _GREEN_RED[:, 0]
        return np.stack([np.interp(position, stops, c) for c in _GREEN_RED[:, 1:].T], axis=1)
    import matplotlib

    if name not in matplotlib.colormaps:
        raise ParameterError.unknown("colormap", name, [PAPER, *matplotlib.colormaps])
    return np.asarray(matplotlib.colormaps[name](position), dtype=np.float64)[:, :3].copy()
