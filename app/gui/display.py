"""Colours of the window's own controls. Knows no Qt.

`lutcore.color` does the same in compiled code, which must not be called on the window's thread:
while the worker has something compiled, or loaded, whoever calls compiled code waits for it.
"""

import numpy as np

from lutcore.arrays import FloatArray


def encoded(linear: FloatArray) -> FloatArray:
    """Return sRGB-encoded values of linear light; see `lutcore.color.srgb_encode`.

    Parameters
    ----------
    linear : ndarray
        Linear values, any shape; clipped to 0 and 1.

    Returns
    -------
    ndarray
        Encoded values, 0 to 1.

    References
    ----------
    IEC 61966-2-1:1999, sRGB.
    """
    inside = np.clip(linear, 0.0, 1.0)
    power = 1.055 * inside ** (1.0 / 2.4) - 0.055
    return np.where(inside <= 0.0031308, 12.92 * inside, power)
